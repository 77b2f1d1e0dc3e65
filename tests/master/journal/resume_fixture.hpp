// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "base/input_error.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"
#include "master/journal/resume.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/journal/read_session.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace test {

/// Records a session of 40 steps, two per frame, with a checkpoint after every tenth step.
class Resume : public FolderTest {
protected:
    void SetUp() override {
        scene_.material.humidity = 0.25;
        master::JournalWriter writer(journal(), scene_, "test");
        record(writer, 20);
        hashes_.push_back(replica_.stateHash());
    }

    void record(master::JournalWriter& writer, int frames, std::uint32_t epoch = 1) {
        for (int i = 0; i < frames; ++i) {
            journal::JournalFrame written{++frame_, replica_.stateHash(), {}};
            for (int k = 0; k < 2; ++k) {
                hashes_.push_back(replica_.stateHash());
                written.steps.push_back(samples::wildStep(replica_.stepNumber() + 1, scene_.rules, random_));
                written.steps.back().epoch = epoch;
                replica_.apply(written.steps.back());
            }
            writer.append(written);
            if (replica_.stepNumber() % 10 == 0) {
                keepCheckpoint(writer.session());
            }
        }
    }
    void keepCheckpoint(std::uint64_t session) {
        const master::Checkpoint checkpoint{session, "test", scene_.rules.digest(), replica_.stepNumber(),
                                            frame_,  1,      replica_.stateHash(),  replica_.encodeState()};
        master::writeCheckpoint(journal(), checkpoint, 3);
    }
    [[nodiscard]] std::filesystem::path journal() const { return folder_ / "session.journal"; }
    /// Expects the same sand as after an undisturbed replay of all steps.
    void expectSand(std::uint64_t step, std::uint64_t checkpoint) const {
        master::RestoredSand restored = master::restoreSand(journal(), step);
        EXPECT_EQ(restored.replica.stepNumber(), step);
        EXPECT_EQ(restored.replica.stateHash(), hashes_[step]) << step;
        EXPECT_EQ(restored.checkpointStep, checkpoint) << step;
        EXPECT_EQ(restored.replayedSteps, step - checkpoint) << step;
    }
    void spoil(const std::filesystem::path& file, std::streamoff at) const {
        std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekg(at);
        const int before = stream.get();
        stream.seekp(at);
        stream.put(static_cast<char>(before ^ 4));
    }
    static std::string refusal(const std::filesystem::path& journal, const std::string& scene = "") {
        try {
            const auto session = test::readSession(journal, scene);
            session->check->require();
        } catch (const base::InputError& error) {
            return error.what();
        }
        return "not refused";
    }

    scene::Scene scene_ = samples::flatScene(40, 30);
    sand::Replica replica_{scene_};
    std::mt19937 random_{59};
    std::uint64_t frame_ = 0;
    std::vector<std::uint64_t> hashes_;  // state hashes after every step, from 0
};

}  // namespace test
