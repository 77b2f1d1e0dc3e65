// SPDX-License-Identifier: Apache-2.0
// The stated memory of a process is compared with what its structures take, and with the resident memory of sand that
// all moves.
#include "scene/model/session_memory.hpp"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/grid/tile_hash.hpp"
#include "sand/model/grid_codec.hpp"
#include "sand/replica.hpp"
#include "sand/surface_factory.hpp"
#include "scene/model/scene.hpp"

namespace {

using scene::MemoryStage;
using scene::ProcessMemory;
using scene::SandSize;

constexpr int kSide = 2048;  // where what does not grow with the sand is small

/// Returns a scene whose heights are random numbers of the whole range, so that all of its sand moves and nothing of it
/// can be compressed by more than the three bits that heights leave free.
scene::Scene roughest(int side) {
    scene::Scene scene;
    scene.rules.columns = scene.rules.rows = side;
    scene.terrain = sand::HeightField(side, side, 1.0);
    scene.rules.tuning.threshold = scene.rules.tuning.startThreshold = sand::kUnitsPerCell / 2;
    scene.rules.tuning.sweepsPerStep = 4;
    scene.rules.tuning.tool.radius = 12 * sand::kProbePerCell;
    std::mt19937 random(7);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            scene.terrain.setHeight(x, y, static_cast<std::int32_t>(random() >> 3U) - sand::kMaxHeight);
        }
    }
    return scene;
}

std::int64_t partOf(const ProcessMemory& process, const std::string& name, MemoryStage stage) {
    for (const scene::MemoryPart& part : process.parts()) {
        if (part.name == name) {
            return part.bytes.at(static_cast<std::size_t>(stage));
        }
    }
    ADD_FAILURE() << "no part " << name;
    return 0;
}

TEST(SessionMemory, StatesThePlanesThatTheSandAllocates) {
    for (const auto& [columns, rows] : {std::pair(300, 200), {2048, 2048}, {1025, 7}, {1, 1}}) {
        const sand::FieldSize size{columns, rows, false};
        const sand::HeightField field(columns, rows, 1.0);
        const auto plane = static_cast<std::int64_t>(field.cells().bytes());
        EXPECT_EQ(scene::bytesOfPlane(size), plane) << columns << " x " << rows;
        sand::Rules rules;
        rules.columns = columns;
        rules.rows = rows;
        const ProcessMemory server = ProcessMemory::ofServer({size});
        EXPECT_EQ(partOf(server, "heights", MemoryStage::moving), plane);
        EXPECT_EQ(partOf(server, "fluxes", MemoryStage::rest), 0);
        const sand::grid::Erosion erosion(field, rules);
        EXPECT_LE(partOf(server, "fluxes", MemoryStage::moving), static_cast<std::int64_t>(erosion.bytes()));
        if (columns * rows >= kSide * kSide) {
            EXPECT_GE(partOf(server, "fluxes", MemoryStage::moving) +
                          partOf(server, "marks of blocks and hashes", MemoryStage::moving),
                      static_cast<std::int64_t>(erosion.bytes()));
        }
        EXPECT_EQ(partOf(ProcessMemory::ofServer({size, true}), "rock and walls", MemoryStage::rest), plane);
    }
}

TEST(SessionMemory, BoundsHeightsThatCannotBeCompressed) {
    const scene::Scene scene = roughest(kSide);
    const auto packed =
        static_cast<std::int64_t>(sand::packedCells(scene.terrain.cells(), scene.terrain.bounds())->size());
    const std::int64_t stated = scene::bytesOfPackedPlane(sand::FieldSize::of(scene.rules));
    EXPECT_GE(stated, packed);
    EXPECT_LE(stated, packed * 115 / 100) << "32 of 29 bits";
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers take memory of their own
/// Returns a field of /proc/self/status, such as "VmHWM" [byte].
std::int64_t status(const std::string& field) {
    std::ifstream stream("/proc/self/status");
    for (std::string word; stream >> word;) {
        if (std::int64_t kilobytes = 0; word == field + ":" && stream >> kilobytes) {
            return kilobytes * 1024;
        }
    }
    return 0;
}

/// Runs `act` in a child, and returns the largest resident memory of the child [byte], without what it
/// had when begins() was called.
std::int64_t peakOf(const std::function<void(const std::function<void()>& begins)>& act) {
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe(ends.data()), 0);
    const pid_t child = fork();
    if (child == 0) {
        std::int64_t before = 0;
        act([&before] {
            (void)malloc_trim(0);
            std::ofstream("/proc/self/clear_refs") << "5";  // sets VmHWM to VmRSS
            before = status("VmRSS");
        });
        const std::int64_t peak = status("VmHWM") - before;
        _exit(write(ends[1], &peak, sizeof peak) == sizeof peak && !testing::Test::HasFailure() ? 0 : 1);
    }
    close(ends[1]);
    std::int64_t peak = 0;
    EXPECT_EQ(read(ends[0], &peak, sizeof peak), static_cast<ssize_t>(sizeof peak));
    close(ends[0]);
    int ended = 0;
    EXPECT_EQ(waitpid(child, &ended, 0), child);
    EXPECT_EQ(ended, 0);
    return peak;
}

/// Lets all sand move, and then begins a stroke. All sand still moves after it.
void moveAll(sand::Replica& replica) {
    const auto step = [&replica](bool engaged) {
        sand::Step next{1, replica.stepNumber() + 1, engaged, {}};
        next.path = {{100 * sand::kProbePerCell, 100 * sand::kProbePerCell, 0}};
        next.sweeps = replica.wholeSweeps(next);
        replica.apply(next);
        ASSERT_EQ(replica.leftOut(), "");
        (void)replica.takeChange();
    };
    step(false);  // all sand moves from here on
    step(true);
    step(true);
}

std::int64_t sumOf(const ProcessMemory& process, const std::vector<std::string>& names, MemoryStage stage) {
    std::int64_t sum = 0;
    for (const std::string& name : names) {
        sum += partOf(process, name, stage);
    }
    return sum;
}

void expectStated(std::int64_t stated, std::int64_t taken) {
    EXPECT_GE(stated, taken) << "more than stated";
    EXPECT_LE(stated, taken * 12 / 10) << "a fifth more than needed";
}

const std::vector<std::string> kReplica{"heights", "fluxes", "heights of the start, compressed", "sand for an undo",
                                        "marks of blocks and hashes"};

TEST(SessionMemory, HoldsForAReplicaWhoseSandAllMoves) {
    const std::int64_t taken = peakOf([](const auto& begins) {
        const scene::Scene scene = roughest(kSide);
        begins();
        sand::Replica replica(scene);
        moveAll(replica);
    });
    expectStated(sumOf(ProcessMemory::ofServer({{kSide, kSide, false}}), kReplica, MemoryStage::moving), taken);
}

/// Takes bytes as a file does.
struct NoFile : base::ByteSink {
    void write(std::span<const std::uint8_t> /*bytes*/) override {}
    void overwrite(std::uint64_t /*place*/, std::span<const std::uint8_t> /*bytes*/) override {}
};

TEST(SessionMemory, HoldsWhileACheckpointIsWritten) {
    const std::int64_t taken = peakOf([](const auto& begins) {
        const scene::Scene scene = roughest(kSide);
        begins();
        sand::Replica replica(scene);
        moveAll(replica);
        const sand::StateCopy copy = replica.beginCopy();
        while (!copy.complete() && replica.continueCopy(1 << 20)) {
        }
        NoFile file;
        base::ByteWriter writer(file);
        copy.encodeInto(writer);
        writer.flush();
    });
    std::vector<std::string> parts = kReplica;
    parts.emplace_back("copy for a checkpoint");
    expectStated(sumOf(ProcessMemory::ofMaster({{kSide, kSide, false}}), parts, MemoryStage::moving), taken);
    EXPECT_EQ(sumOf(ProcessMemory::ofMaster({{kSide, kSide, false}}, false), kReplica, MemoryStage::moving),
              ProcessMemory::ofMaster({{kSide, kSide, false}}, false).bytes(MemoryStage::moving) -
                  partOf(ProcessMemory::ofMaster({}), "program and libraries", MemoryStage::moving))
        << "without checkpoints";
}

/// Lets the sand of a scene settle as scene::loadScene() does.
void settle(scene::Scene& scene) {
    sand::Replica replica(scene);
    replica.apply({.epoch = 1, .number = 1, .edit = sand::Edit::settle});
    sand::startFrom(replica.surface(), scene);
}

TEST(SessionMemory, HoldsWhileTheSandOfASceneSettles) {
    SandSize size{{kSide / 2, kSide / 2, false}};
    EXPECT_EQ(ProcessMemory::ofServer(size).bytes(MemoryStage::settled),
              ProcessMemory::ofServer(size).bytes(MemoryStage::read))
        << "a scene that does not settle";
    size.settles = true;
    const std::int64_t taken = peakOf([](const auto& begins) {
        scene::Scene scene = roughest(kSide / 2);
        begins();
        settle(scene);
    });
    for (const ProcessMemory& process : {ProcessMemory::ofServer(size), ProcessMemory::ofMaster(size)}) {
        expectStated(partOf(process, "settling of the scene", MemoryStage::settled), taken);
        EXPECT_GE(process.figures().peak, process.bytes(MemoryStage::settled));
    }
    EXPECT_EQ(ProcessMemory::ofRank(size, 0).bytes(MemoryStage::settled),
              partOf(ProcessMemory::ofRank(size, 0), "program and libraries", MemoryStage::settled))
        << "a rank gets sand that has settled";
}
#endif

TEST(SessionMemory, OfVerticesIsBoundedByThePixels) {
    constexpr std::int64_t kFrames = 12 * 1280 * 720;
    const SandSize large{{8192, 8192, false}}, larger{{16384, 16384, false}}, small{{64, 64, false}};
    for (const MemoryStage stage : {MemoryStage::rest, MemoryStage::moving}) {
        EXPECT_EQ(partOf(ProcessMemory::ofRank(large, kFrames), "vertices", stage),
                  partOf(ProcessMemory::ofRank(larger, kFrames), "vertices", stage));
        EXPECT_EQ(partOf(ProcessMemory::ofRank(small, kFrames), "vertices", stage), 17 * 64 * 64);
    }
}

TEST(SessionMemory, GrowsWithTheCells) {
    const std::vector<std::function<ProcessMemory(const SandSize&)>> kinds{
        &ProcessMemory::ofServer, [](const SandSize& sand) { return ProcessMemory::ofMaster(sand); },
        [](const SandSize& sand) { return ProcessMemory::ofRank(sand, 0); }};
    for (const auto& of : kinds) {
        const scene::MemoryFigures small = of({{512, 512, false}}).figures(),
                                   large = of({{1024, 1024, false}}).figures();
        EXPECT_LT(small.rest, large.rest);
        EXPECT_LT(small.peak, large.peak);
        EXPECT_LT(small.moving, large.moving);
        EXPECT_EQ(large.most(), std::max({large.rest, large.peak, large.moving}));
    }
}

TEST(SessionMemory, OfATinIsThatOfItsVertices) {
    scene::Scene scene;
    scene.rules.columns = scene.rules.rows = 512;
    sand::tin::TinStart start;
    start.places.resize(1000000);
    scene.tin = std::make_shared<const sand::tin::TinStart>(std::move(start));
    scene.rules.tin = 1;
    const SandSize tin = SandSize::of(scene);
    EXPECT_EQ(partOf(ProcessMemory::ofRank(tin, 0), "triangles", scene::MemoryStage::rest),
              std::int64_t{320} * 1000000);
    EXPECT_EQ(partOf(ProcessMemory::ofRank(tin, 0), "drawn heights", scene::MemoryStage::rest), 4 * 512 * 512);
}

}  // namespace
