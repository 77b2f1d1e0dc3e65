// SPDX-License-Identifier: Apache-2.0
// Computes a session and compares its hashes, as the page's first pass does, with the native kernels of a code path.
// usage: verify_times FILE PATH. PATH is baseline or x86-64-v3. Prints the processor's time for a step [ms].
#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "base/code_path.hpp"
#include "journal/journal.hpp"
#include "journal/memory_parts.hpp"
#include "journal/verification.hpp"
#include "sand/grid/surface.hpp"
#include "sand/surface_factory.hpp"

namespace {

base::Bytes bytesOf(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Returns the sand of a scene. A TIN has one code path for the sweeps that take its time.
sand::Replica sandOf(const scene::Scene& scene, base::CodePath path) {
    if (scene.tin != nullptr) {
        return sand::Replica(scene);
    }
    sand::grid::Erosion::Options options;
    options.path = path;
    return {scene, std::make_unique<sand::grid::GridSurface>(scene.rules, scene.terrain, scene.ground, options)};
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 3) {
        fmt::print(stderr, "usage: verify_times FILE PATH\n");
        return 2;
    }
    const std::string file = arguments[1];
    const base::CodePath path = std::string(arguments[2]) == "baseline" ? base::CodePath::baseline : base::CodePath::v3;
    journal::JournalReader reader(std::make_unique<journal::MemoryParts>(file, std::vector<base::Bytes>{bytesOf(file)}),
                                  SANDWALL_RELEASE_NAME);
    const scene::Scene scene = journal::sceneOf(reader);
    std::vector<journal::JournalRecord> records;
    while (auto record = reader.next()) {
        records.push_back(std::move(*record));
    }
    journal::Verification verification(file, sandOf(scene, path));
    const std::clock_t began = std::clock();
    for (const journal::JournalRecord& record : records) {
        verification.take(record);
    }
    const double ms = 1e3 * static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
    fmt::print("{}\n", ms / static_cast<double>(verification.replica().stepNumber()));
    return verification.counts().differing == 0 ? 0 : 1;
}
