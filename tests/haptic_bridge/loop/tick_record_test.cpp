// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>

#include "base/input_error.hpp"
#include "haptic_bridge/devices/mapped_device.hpp"
#include "haptic_bridge/link/connection.hpp"
#include "haptic_bridge/loop/felt_sand.hpp"
#include "haptic_bridge/loop/tick_recorder.hpp"
#include "haptic_bridge/loop/tick_replay.hpp"
#include "scene/model/scene.hpp"
#include "tests/haptic_bridge/devices/fake_arm.hpp"
#include "tests/support/files/overlong.hpp"
#include "tests/support/machine/small_disk.hpp"
#include "tests/support/processes/blocked_child.hpp"
#include "tests/support/processes/server_process.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using namespace haptic_bridge;

/// Returns a scene whose sand rises by a twentieth to the east, so that a hand feels other sand at another place.
scene::Scene ramp() {
    scene::Scene scene = samples::flatScene(60, 60);
    for (int y = 0; y < 60; ++y) {
        for (int x = 0; x < 60; ++x) {
            scene.terrain.setHeight(x, y, x * sand::kUnitsPerCell / 20);
        }
    }
    return scene;
}

/// A hand with an arm over 60 x 60 cells, with its steps and its recorder: a server without threads and link.
class Recorded : public testing::Test {
protected:
    void open(const std::string& file) {
        open(file, [this](const std::string& line) { printed_.push_back(line); });
    }
    void open(const std::string& file, std::function<void(const std::string&)> log) {
        hand_ = std::make_unique<HapticTick>(
            scene_, std::make_unique<MappedDevice>(std::make_unique<test::FakeArm>(state_), HandSettings{}, scene_),
            HandSettings::Datum::level);
        recorder_ = std::make_unique<TickRecorder>(TickRecorder::Options{file, true, std::move(log)}, *hand_, failure_);
    }
    /// Runs a link with steps of 16 ticks. The arm begins in the sand, far from the sand's first probe. Then it draws,
    /// lifts, is away for a while, and once sends values that are not finite.
    void sit(int steps) {
        hand_->restart();
        recorder_->begin();
        PathBuilder path(scene_.rules.stepsPerSecond);
        path.restart(replica_.probe());
        for (int i = 0; i < steps; ++i) {
            takeSurface(replica_, hand_->probe(), surface_);
            for (int tick = 0; tick < 16; ++tick) {
                ++ticks_;
                const double turn = 1.2 + static_cast<double>(ticks_) * 0.004;
                state_.reading.place = {0.05 * std::cos(turn), 0.05 * std::sin(turn), 0.01 * std::sin(3 * turn)};
                state_.reading.present = ticks_ % 100 < 100 - lost_;
                if (ticks_ % 130 == 0) {
                    state_.reading.place.z = std::nan("");
                }
                const std::int64_t now = 1'000'003 * ticks_;
                surface_.timeNs = now - 16'000 * (ticks_ % 7);
                path.add(hand_->tick(1e-3 * static_cast<double>(ticks_), now, surface_));
                recorder_->add();
                engaged_ += hand_->lastTick().engaged ? 1 : 0;
            }
            sand::Step& step = steps_.emplace_back();
            step.number = replica_.stepNumber() + 1;
            (void)path.take(step);
            replica_.apply(step);
        }
        recorder_->flush();
        for (base::Bytes& piece : recorder_->takePieces()) {
            pieces_.push_back(std::move(piece));
        }
    }
    std::string replayed(TickReplay& replay, std::size_t steps) {
        sand::Replica replica(scene_);
        std::string rows = tickTitles();
        replay.feel(replica, rows);
        for (std::size_t i = 0; i < steps; ++i) {
            replica.apply(steps_[i]);
            replay.feel(replica, rows);
        }
        return rows;
    }
    [[nodiscard]] std::string written() const { return folder_.read("ticks.csv"); }

    const test::Folder folder_{};
    const scene::Scene scene_ = ramp();
    test::FakeArm::State state_;
    std::unique_ptr<HapticTick> hand_;
    FirstFailure failure_;
    std::unique_ptr<TickRecorder> recorder_;
    sand::Replica replica_{scene_};
    FeltSand surface_;
    std::vector<sand::Step> steps_;
    std::vector<base::Bytes> pieces_;
    std::vector<std::string> printed_;
    std::int64_t ticks_ = 0;
    int lost_ = 1;  // readings of a hundred
    int engaged_ = 0;
};

TEST_F(Recorded, ReplaysToTheSameRowsByteForByte) {
    open(folder_.file("ticks.csv"));
    sit(40);
    sit(20);  // the link was lost and came back, so the hand starts afresh
    recorder_.reset();
    EXPECT_GT(engaged_, 300) << "the hand must be in the sand";
    TickReplay replay(scene_, pieces_);
    const std::string rows = replayed(replay, steps_.size());
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 60 * 16);
    EXPECT_EQ(rows, written());
    EXPECT_EQ(replay.left(), 0U);
    EXPECT_NE(rows.find(",1\n"), std::string::npos);
    EXPECT_TRUE(printed_.empty());
}

TEST_F(Recorded, ReplaysAForceThatThreeFaultsSwitchOff) {
    open(folder_.file("ticks.csv"));
    lost_ = 20;
    sit(25);
    EXPECT_TRUE(hand_->tripped());
    lost_ = 5;
    const std::uint64_t felt = hand_->handTicks().felt();
    sit(10);  // another link does not switch it on
    EXPECT_TRUE(hand_->tripped());
    EXPECT_EQ(hand_->handTicks().felt(), felt);
    hand_->switchOn();
    sit(10);
    EXPECT_FALSE(hand_->tripped());
    EXPECT_GT(hand_->handTicks().felt(), felt);
    recorder_.reset();
    TickReplay replay(scene_, pieces_);
    EXPECT_EQ(replayed(replay, steps_.size()), written());
    EXPECT_EQ(replay.left(), 0U);
}

TEST_F(Recorded, LeavesOutTicksOfStepsThatWereNotShown) {
    open(folder_.file("ticks.csv"));
    sit(30);
    recorder_.reset();
    TickReplay replay(scene_, pieces_);
    const std::string rows = replayed(replay, 20);
    EXPECT_EQ(rows, written().substr(0, rows.size()));
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 21 * 16) << "step 20 is felt before the next is made";
    EXPECT_EQ(replay.left(), 9 * 16U);
}

TEST_F(Recorded, IgnoresTheTailOfALinkBefore) {
    open(folder_.file("ticks.csv"));
    sit(5);
    const std::size_t first = pieces_.size();
    sit(5);
    recorder_.reset();
    // The first piece, which describes the device, did not arrive.
    TickReplay replay(scene_, {pieces_.begin() + 1, pieces_.end()});
    ASSERT_GT(first, 1U);
    const std::string rows = replayed(replay, steps_.size());
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 5 * 16);
}

// A paused session makes no steps, and the hand still feels the sand. The server sends all pieces before the next step.
TEST_F(Recorded, ThePiecesOfALongPauseFitIntoOneSend) {
    open(folder_.file("ticks.csv"));
    hand_->restart();
    recorder_->begin();
    takeSurface(replica_, hand_->probe(), surface_);
    for (int tick = 0; tick < 60'000; ++tick) {
        (void)hand_->tick(1e-3 * tick, 1'000'003 * static_cast<std::int64_t>(tick), surface_);
        recorder_->add();
    }
    recorder_->flush();
    std::size_t bytes = 0;
    for (base::Bytes& piece : recorder_->takePieces()) {
        bytes += encode(TickPiece{std::move(piece)}).size();
    }
    EXPECT_LE(bytes, Connection::kMaxUnsent);
    EXPECT_GT(bytes, Connection::kMaxUnsent / 4);
}

TEST_F(Recorded, AnExceptionOfItsThreadIsHandedOverAndNoThreadWaitsForItAnyMore) {
    const std::string file = folder_.file("ticks.csv");
    support::testOnSmallDisk(std::filesystem::path(file).parent_path(), "size=16k", [&] {
        alarm(60);  // ends this child if a thread does wait
        open(file, [](const std::string&) { throw std::runtime_error("the terminal is gone"); });
        sit(20);                                     // more than the disk takes, which the recorder logs
        for (int tick = 0; tick < 10'000; ++tick) {  // more than wait in the queue
            recorder_->add();
        }
        recorder_->flush();
        recorder_.reset();
        try {
            failure_.rethrow();
            ADD_FAILURE() << "nothing was handed over";
        } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "the recorder of ticks has failed: the terminal is gone");
        }
    });
}

TEST_F(Recorded, AFullDiskEndsTheRowsAndNotTheTrack) {
    const std::string file = folder_.file("ticks.csv");
    support::testOnSmallDisk(std::filesystem::path(file).parent_path(), "size=16k", [&] {
        open(file);
        sit(20);
        recorder_.reset();
        ASSERT_EQ(printed_.size(), 1U);
        EXPECT_EQ(printed_[0], "--record " + file +
                                   ": cannot be written (No space left on device); the file ends here, and the session "
                                   "continues");
        const std::string written = folder_.read("ticks.csv");
        EXPECT_TRUE(written.empty() || written.ends_with('\n')) << "a whole row";
        TickReplay replay(scene_, pieces_);
        const std::string rows = replayed(replay, steps_.size());
        EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 20 * 16);
        EXPECT_EQ(rows.find(written), 0U) << "the file is the beginning of the rows";
    });
}

TEST_F(Recorded, IntoAPipeOrADeviceIsRefusedWithoutWaiting) {
    const std::string pipe = folder_.file("pipe");
    support::makePipe(pipe);
    EXPECT_TRUE(support::endsByItself([&] { EXPECT_THROW(open(pipe), base::InputError); }));
    EXPECT_THROW(open("/dev/null"), base::InputError);
}

TEST_F(Recorded, IntoALinkIsRefusedAndItsTargetStays) {
    folder_.write("target", "of another program");
    for (const char* target : {"target", "nowhere"}) {
        std::filesystem::remove(folder_.file("link"));
        std::filesystem::create_symlink(folder_.file(target), folder_.file("link"));
        EXPECT_THROW(open(folder_.file("link")), base::InputError);
    }
    EXPECT_EQ(folder_.read("target"), "of another program");
    EXPECT_FALSE(std::filesystem::exists(folder_.file("nowhere")));
}

TEST_F(Recorded, IntoAFileOfAnEarlierSessionLeavesThatFilesOtherNameAlone) {
    folder_.write("ticks.csv", "of an earlier session");
    std::filesystem::create_hard_link(folder_.file("ticks.csv"), folder_.file("other"));
    open(folder_.file("ticks.csv"));
    EXPECT_EQ(folder_.read("other"), "of an earlier session");
}

TEST_F(Recorded, AFileThatCannotBeMadeIsNamed) { EXPECT_THROW(open("/nowhere/ticks.csv"), base::InputError); }

TEST(TickTrack, RefusesBytesThatAreNone) {
    TrackPiece piece;
    piece.ticks.resize(3);
    piece.ticks[1].surfaceProbe = {7, 8, 0};
    const base::Bytes whole = encode(piece);
    EXPECT_EQ(decodeTrackPiece(whole).ticks.size(), 3U);
    for (std::size_t length = 0; length < whole.size(); ++length) {
        EXPECT_THROW((void)decodeTrackPiece(std::span(whole).first(length)), base::FormatError) << length;
    }
    base::Bytes longer = whole;
    longer.push_back(0);
    EXPECT_THROW((void)decodeTrackPiece(longer), base::FormatError);
    piece.ticks[1].surfaceProbe = {0, sand::kMaxProbe, 0};
    EXPECT_NO_THROW((void)decodeTrackPiece(encode(piece)));
    piece.ticks[1].surfaceProbe = {0, sand::kMaxProbe + 1, 0};
    EXPECT_THROW((void)decodeTrackPiece(encode(piece)), base::FormatError) << "beyond any field";
}

TEST(TickTrack, HasOneFormOfEachNumber) {
    TrackPiece piece;
    piece.ticks.resize(3);
    piece.ticks[1].surfaceProbe = {7, 8, 0};
    piece.ticks[2].surfaceProbe = {7, 9, 0};
    const int refused =
        test::widenedNumbers(encode(piece), [](const base::Bytes& wide) { return encode(decodeTrackPiece(wide)); });
    EXPECT_EQ(refused, 1 + 3 * 5 + 2 * 2) << "their count; flags, three times and a step of each; and two places";
}

TEST(TickTrack, KeepsLostReadingsAndForceThatIsOff) {
    TrackPiece piece;
    for (int flags = 0; flags < 4; ++flags) {
        TickInput& tick = piece.ticks.emplace_back();
        tick.silent = flags % 2 == 1;
        tick.tripped = flags >= 2;
        tick.reading.present = !tick.silent;
    }
    const TrackPiece read = decodeTrackPiece(encode(piece));
    for (std::size_t i = 0; i < piece.ticks.size(); ++i) {
        EXPECT_EQ(read.ticks[i].silent, piece.ticks[i].silent) << i;
        EXPECT_EQ(read.ticks[i].tripped, piece.ticks[i].tripped) << i;
    }
}

TEST(TickTrack, RefusesTimesThatNoClockShows) {
    constexpr std::int64_t kMost = std::int64_t{1} << 60;
    TrackPiece piece;
    piece.ticks.resize(2);
    piece.ticks[0].nowNs = -kMost;
    piece.ticks[1].nowNs = piece.ticks[1].surfaceAgeNs = kMost;
    EXPECT_NO_THROW((void)decodeTrackPiece(encode(piece)));
    ++piece.ticks[1].nowNs;
    EXPECT_THROW((void)decodeTrackPiece(encode(piece)), base::FormatError);
    piece.ticks[1].nowNs = 0;
    piece.ticks[1].surfaceAgeNs = std::numeric_limits<std::int64_t>::min();
    EXPECT_THROW((void)decodeTrackPiece(encode(piece)), base::FormatError);
}

TEST(TickTrack, KeepsTheMiddleOfTheSurfaceOfEachTick) {
    const std::array<sand::ProbePoint, 6> middles{{{0, 0, 0}, {300, -5, 0}, {300, -5, 0}, {300, 6, 0}, {0, 0, 0}, {}}};
    TrackPiece piece;
    piece.ticks.resize(middles.size());
    for (std::size_t i = 0; i < middles.size(); ++i) {
        piece.ticks[i].surfaceProbe = middles[i];
    }
    const TrackPiece read = decodeTrackPiece(encode(piece));
    ASSERT_EQ(read.ticks.size(), middles.size());
    for (std::size_t i = 0; i < middles.size(); ++i) {
        EXPECT_EQ(read.ticks[i].surfaceProbe, middles[i]) << "tick " << i;
    }
}

}  // namespace
