// SPDX-License-Identifier: Apache-2.0
// Fuzzes what comes after a state is accepted: steps and edits. What can be decoded can be applied, by two replicas
// alike, and the result can be decoded again. Every part of the input is read as plain bytes, which are compressed
// here, because a flipped bit of compressed data would never reach the code behind the decompression.
#include <array>
#include <cstdlib>

#include "sand/replica.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/plain_sand.hpp"
#include "tests/support/sand/tin_scene.hpp"

namespace {

using sand::Replica;
using sand::Step;

/// Scenes of all kinds of sand: a closed and an open rim, rock and walls, and a TIN with either rim.
const scene::Scene& sceneOf(unsigned kind) {
    static const std::array<scene::Scene, 5> kScenes = [] {
        std::array<scene::Scene, 5> scenes{samples::flatScene(24, 16), samples::flatScene(24, 16),
                                           samples::flatScene(24, 16), samples::tinScene(), samples::tinScene()};
        scenes[1].rules.rim = scenes[2].rules.rim = scenes[4].rules.rim = sand::Rim::open;
        auto ground = std::make_shared<sand::Ground>(24, 16);
        for (int x = 4; x < 20; ++x) {
            ground->setBedrock(x, 8, -3 * sand::kUnitsPerCell);
            ground->setWall(x, 3);
        }
        scenes[2].rules.ground = ground->digest();
        scenes[2].ground = std::move(ground);
        scenes[2].rules.tuning.startThreshold = scenes[4].rules.tuning.startThreshold = sand::kUnitsPerCell * 3 / 2;
        return scenes;
    }();
    return kScenes.at(kind % kScenes.size());
}

/// Bounds the work of a step, so that the fuzzer tries many. Tools beyond the field and deep below it stay possible.
void shorten(Step& step) {
    constexpr std::int32_t kFar = 64 * sand::kProbePerCell;
    for (sand::ProbePoint& point : step.path) {
        point.x %= kFar;
        point.y %= kFar;
    }
    step.path.resize(std::min<std::size_t>(step.path.size(), 4));
    step.sweeps %= 20;
    step.edit.tuning.sweepsPerStep = 1 + step.edit.tuning.sweepsPerStep % 16;
    step.edit.tuning.tool.radius %= 32 * sand::kProbePerCell;
    step.edit.tuning.tool.halfWidth = std::min(step.edit.tuning.tool.halfWidth, step.edit.tuning.tool.radius);
}

/// Replaces the plain bytes of a load by sand.
void pack(Step& step, const scene::Scene& scene) {
    if (step.edit.kind == sand::Edit::load && step.edit.sand) {
        base::ByteReader plain(*step.edit.sand);
        step.edit = sand::Edit::loaded(fuzz::packedSand(plain, scene));
    }
}

bool restores(const Step& step) {
    using Edit = sand::Edit;
    return step.edit.kind == Edit::reset || step.edit.kind == Edit::undo || step.edit.kind == Edit::load;
}

}  // namespace

SANDWALL_FUZZER(steps) {
    if (size == 0) {
        return 0;
    }
    const scene::Scene& scene = sceneOf(data[0]);
    const std::vector<fuzz::Input> pieces = fuzz::piecesOf(fuzz::Input(data, size).subspan(1));
    if (pieces.empty()) {
        return 0;
    }
    Replica one(scene), other(scene);
    bool begun = false;
    fuzz::takeOrRefuse([&] {
        one.decodeState(fuzz::packedState(pieces[0], scene));
        begun = true;
    });
    if (begun) {
        other.decodeState(one.encodeState());
    }
    for (std::size_t i = 1; i < std::min<std::size_t>(pieces.size(), 12); ++i) {
        Step step;
        bool read = false;
        fuzz::takeOrRefuse([&] {
            base::ByteReader reader(pieces[i]);
            step = base::read<sand::Step>(reader);
            shorten(step);
            pack(step, scene);
            read = true;
        });
        if (!read) {
            continue;
        }
        step.number = one.stepNumber() + 1;
        const std::int64_t before = one.volume() + one.outflow();
        one.apply(step);
        other.apply(step);
        fuzz::require(one.leftOut().find("skipped") == std::string::npos, one.leftOut().c_str());
        fuzz::require(one.stateHash() == other.stateHash(), "two replicas differ");
        fuzz::require(restores(step) || one.volume() + one.outflow() == before, "the volume of the sand has changed");
        one.audit(1 << 20);
        fuzz::require(one.stateHash() == other.stateHash(), "the hash differs after an audit");
    }
    Replica third(scene);
    third.decodeState(one.encodeState());  // throws if a state that can be reached cannot be decoded
    fuzz::require(third.stateHash() == one.stateHash(), "a decoded state differs");
    return 0;
}
