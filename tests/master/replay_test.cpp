// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "master/journal.hpp"
#include "sand/esri_grid.hpp"
#include "sand/terrain.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/sand_samples.hpp"

namespace {

class Replay : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("sandwall_replay_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    /// Records 40 steps in frames of two; `hashError` spoils the hash of frame 10.
    sand::Terrain record(std::uint64_t hashError = 0) {
        const sand::Scene scene = samples::flatScene(40, 30);
        sand::Terrain terrain(scene);
        std::mt19937 random(53);
        master::JournalWriter writer(journal(), scene, "test");
        for (std::uint64_t frame = 1; frame <= 20; ++frame) {
            master::JournalFrame written{frame, terrain.stateHash() ^ (frame == 10 ? hashError : 0), {}};
            for (int i = 0; i < 2; ++i) {
                written.steps.push_back(samples::randomStep(terrain.stepNumber() + 1, scene.rules, random));
                terrain.apply(written.steps.back());
            }
            writer.append(written);
        }
        writer.finish(terrain.stepNumber(), terrain.stateHash());
        return terrain;
    }
    [[nodiscard]] std::string journal() const { return (folder_ / "s.journal").string(); }
    std::filesystem::path folder_;
};

TEST_F(Replay, EndsInTheSessionsHash) {
    sand::Terrain terrain = record();
    const support::Ran ran = support::runProgram("sandwall-replay", journal() + " --hash");
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(ran.output, fmt::format("{:016x}\n", terrain.stateHash()));
}

TEST_F(Replay, WritesTheHeights) {
    const sand::Terrain terrain = record();
    const std::string file = (folder_ / "h.asc").string();
    ASSERT_EQ(support::runProgram("sandwall-replay", journal() + " --heights " + file).status, 0);
    const sand::EsriGrid grid = sand::readEsriGrid(file);
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 40; ++x) {
            ASSERT_NEAR(grid.at(x, y), terrain.field().height(x, y) * terrain.field().unit(), 1e-6);
        }
    }
}

TEST_F(Replay, SaysWhereASessionDiffers) {
    record(1);
    const support::Ran ran = support::runProgram("sandwall-replay", journal());
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.output.find("before frame 10, after step 18: the session had "), std::string::npos) << ran.output;
}

TEST_F(Replay, RefusesAStepThatIsNotThere) {
    record();
    const support::Ran ran = support::runProgram("sandwall-replay", journal() + " --until 41");
    EXPECT_EQ(ran.status, 2);
    EXPECT_NE(ran.output.find("ends at step 40, before --until 41"), std::string::npos) << ran.output;
}

}  // namespace
