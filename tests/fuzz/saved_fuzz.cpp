// SPDX-License-Identifier: Apache-2.0
// Fuzzes a file of saved sand, either as it is on disk or with a correct checksum. The correct checksum lets the fuzzer
// reach the header and the sand behind it. Accepted sand must be equal after it is written and read again.
#include <array>

#include "master/journal/saved_sand.hpp"
#include "sand/replica.hpp"
#include "tests/fuzz/checksummed.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/support/sand/tin_scene.hpp"

SANDWALL_FUZZER(saved) {
    if (size == 0) {
        return 0;
    }
    static const std::array<scene::Scene, 2> kScenes{samples::flatScene(24, 16), samples::tinScene()};
    static const fuzz::ScratchFolder kScratch;
    const scene::Scene& scene = kScenes.at((data[0] >> 1U) & 1U);
    kScratch.write("given.sand", fuzz::checksummed({data, size}));
    fuzz::takeOrRefuse([&] {
        const auto place = master::SandPlace::of(scene);
        const auto read = sand::Replica(scene).sandReader();
        const master::SavedSand saved = master::readSavedSand(kScratch.path() / "given.sand", place, read);
        const std::filesystem::path written = kScratch.path() / "again.sand";
        writeSavedSand(written, saved);
        const master::SavedSand again = master::readSavedSand(written, place, read);
        fuzz::require(again.step == saved.step && again.stateHash == saved.stateHash && again.sand == saved.sand,
                      "saved sand differs after it is written and read");
    });
    return 0;
}
