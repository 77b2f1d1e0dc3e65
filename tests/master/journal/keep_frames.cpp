// SPDX-License-Identifier: Apache-2.0
// Writes three frames to FOLDER/session.journal under a policy, as a session does. After each frame it appends a line
// to the file that SANDWALL_SYNC_LOG names, with the length of the journal or the error of the disk. Exit status 3 if
// the disk refuses a required journal, 2 if the journal cannot be made.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/input_error.hpp"
#include "master/journal/keeper.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

int keepFrames(const std::filesystem::path& folder, const std::string& policy) {
    std::ofstream log(std::getenv("SANDWALL_SYNC_LOG"), std::ios::app);
    const auto print = [&](const std::string& line) { log << line << std::endl; };
    const scene::Scene scene = samples::flatScene(40, 30);
    sand::Replica replica(scene);
    master::JournalKeeper keeper(
        folder, {.policy = base::valueNamed<master::JournalPolicy>(policy).value(), .checkpointSeconds = 0}, scene,
        nullptr, "", "test");
    print("made");
    for (std::uint64_t frame = 1; frame <= 3; ++frame) {
        sand::Step step{1, frame, false, {}};
        step.sweeps = replica.wholeSweeps(step);
        try {
            keeper.keep({frame, replica.stateHash(), {step}}, {});
        } catch (const master::DiskFailure&) {
            print("refused");
            return 3;
        }
        print(fmt::format("kept {} {}", std::filesystem::file_size(folder / "session.journal"), keeper.state()));
        replica.apply(step);
    }
    return 0;
}

}  // namespace

int main(int count, char** words) {
    try {
        return count == 3 ? keepFrames(words[1], words[2]) : 2;
    } catch (const base::InputError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    }
}
