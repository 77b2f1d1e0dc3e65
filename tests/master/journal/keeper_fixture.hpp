// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <random>

#include "master/journal/journal.hpp"
#include "master/journal/keeper.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace test {

/// A session of one process, without a wall.
class KeeperTest : public FolderTest {
protected:
    void begin(const master::JournalOptions& options, const master::ResumedSession* resumed = nullptr) {
        keeper_.emplace(folder_, options, scene_, resumed, "a test", "test");
    }
    /// Shows a frame with a step. Returns false if the keeper does not allow a step.
    bool showFrame(const sand::Edit& edit = {}) {
        if (!keeper_->mayTake(1 << 16, {replica_.stepNumber(), replica_.stateHash()})) {
            return false;
        }
        sand::Step step = samples::randomStep(replica_.stepNumber() + 1, scene_.rules, random_);
        step.edit = edit;
        keeper_->keep({++frame_, replica_.stateHash(), {step}}, {});
        replica_.apply(step);
        keeper_->shown(replica_, frame_, 1, replica_.stateHash());
        return true;
    }
    [[nodiscard]] std::filesystem::path journal() const { return folder_ / "session.journal"; }
    void expectWhole(std::uint64_t steps) {
        master::RestoredSand restored = master::restoreSand(journal(), steps);
        EXPECT_EQ(restored.replica.stateHash(), replica_.stateHash());
        const journal::Journal journal = master::readJournal(this->journal());
        EXPECT_EQ(journal.frames.size(), steps);
        EXPECT_EQ(journal.tornBytes, 0);
    }

    scene::Scene scene_ = samples::flatScene(40, 30);
    sand::Replica replica_{scene_};
    std::mt19937 random_{61};
    std::uint64_t frame_ = 0;
    std::optional<master::JournalKeeper> keeper_;
};

}  // namespace test
