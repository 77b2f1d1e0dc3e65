// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "master/journal/journal.hpp"
#include "sand/replica.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/run_program.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace test {

/// A journal that sandwall-replay reads.
class Replay : public FolderTest {
protected:
    /// Records 40 steps, two per frame. `hashError` changes the hash of frame 10.
    sand::Replica record(std::uint64_t hashError = 0) { return record(samples::flatScene(40, 30), hashError); }
    sand::Replica record(const scene::Scene& scene, std::uint64_t hashError) {
        sand::Replica replica(scene);
        std::mt19937 random(53);
        master::JournalWriter writer(journal(), scene, "test");
        for (std::uint64_t frame = 1; frame <= 20; ++frame) {
            journal::JournalFrame written{frame, replica.stateHash() ^ (frame == 10 ? hashError : 0), {}};
            for (int i = 0; i < 2; ++i) {
                written.steps.push_back(samples::randomStep(replica.stepNumber() + 1, scene.rules, random));
                replica.apply(written.steps.back());
            }
            writer.append(written);
        }
        writer.finish(replica.stepNumber(), replica.stateHash());
        return replica;
    }
    [[nodiscard]] std::string journal() const { return path("s.journal"); }
    [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ifstream stream(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    [[nodiscard]] support::Ran replay(const std::string& options) const {
        return support::runProgram("sandwall-replay", journal() + " " + options);
    }
    /// Expects exit status 2, one line that contains `words`, and only the journal in the folder.
    void expectRefused(const std::string& options, const std::string& words) const {
        const support::Ran ran = replay(options);
        EXPECT_EQ(ran.status, 2) << options << ": " << ran.output;
        EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << options << ": " << ran.output;
        EXPECT_NE(ran.output.find(words), std::string::npos) << options << ": " << ran.output;
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << options;
    }
};

}  // namespace test
