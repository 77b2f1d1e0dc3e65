// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_options.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "base/input_error.hpp"
#include "host/command_line.hpp"
#include "host/whole_file.hpp"
#include "scene/export/results.hpp"
#include "scene/import/raster_file.hpp"

namespace replay {
namespace {

/// Throws base::InputError if one file would be written over another, or over the journal.
void requireDifferentFiles(const ReplayOptions& options) {
    std::map<std::filesystem::path, std::string> writers;
    std::error_code none;
    writers.emplace(std::filesystem::weakly_canonical(options.file, none), "FILE");
    for (const auto& [option, file] : options.outputs()) {
        const bool plain = !std::filesystem::exists(file, none) || std::filesystem::is_regular_file(file, none);
        const auto [other, isNew] = writers.emplace(std::filesystem::weakly_canonical(file, none), option);
        if (plain && !isNew) {
            throw base::InputError(fmt::format("{} and {}: both name {}; choose another file for one of them",
                                               other->second, option, file));
        }
    }
}

/// Returns an error text for a negative number, which would otherwise be read as a huge one.
std::string notNegative(const std::string& text) {
    return text.starts_with('-') ? "a step's number is 0 or more, got " + text : "";
}

/// Returns an error text for an empty name, which would otherwise mean that no file is wanted.
std::string notEmpty(const std::string& text) { return text.empty() ? "name a file" : ""; }

}  // namespace

std::vector<std::pair<std::string, std::string>> ReplayOptions::outputs() const {
    std::vector<std::pair<std::string, std::string>> all{{"--export", steps},
                                                         {"--heights", heights},
                                                         {"--difference", difference},
                                                         {"--mesh", mesh},
                                                         {"--forces", forces}};
    std::erase_if(all, [](const auto& output) { return output.second.empty(); });
    return all;
}

void ReplayOptions::checkOutputs() const {
    requireDifferentFiles(*this);
    if (!mesh.empty()) {
        scene::checkMeshName(mesh);
    }
    for (const std::string& written : {heights, difference}) {
        if (!written.empty()) {
            scene::checkRasterName(written);
        }
    }
    for (const std::string& written : {steps, heights, difference, mesh}) {
        if (!written.empty()) {
            host::requireWritable(written);
        }
    }
}

void ReplayOptions::addTo(host::CommandLine& line) {
    line.option("FILE", file, "session.journal of a session, or the session's folder").required();
    const std::vector<host::Option> combined{
        line.flag("--hash", hash, "print the state hash after the last step"),
        line.option(
                "--heights", heights,
                "write the heights after the last step, in the terrain's coordinates: a .tif, or an ESRI ASCII grid")
            .check(notEmpty),
        line.option("--difference", difference,
                    "write how much higher the sand is than at the start, in the same formats")
            .check(notEmpty),
        line.option("--mesh", mesh, "write the surface as triangles: a .ply or .obj").check(notEmpty),
        line.flag("--volumes", volumes, "print what was cut and filled since the start, as one line of JSON"),
        line.option("--forces", forces,
                    "recompute what a hand felt at every tick, from a session recorded with --record, into this CSV "
                    "file")
            .check(notEmpty),
        line.option("--until", until, "stop after this step").check(notNegative),
        line.option("--export", steps, "write every step as a row of this CSV file").check(notEmpty)};
    const host::Option verifies =
        line.flag("--verify", verify, "check records, parts, hashes and checkpoints; excludes all other options");
    const host::Option recovers =
        line.option("--recover", recovered,
                    "write the intact part of a damaged journal as a new journal; excludes all other options")
            .check(notEmpty);
    verifies.excludes(recovers);
    for (const host::Option& other : combined) {
        verifies.excludes(other);
        recovers.excludes(other);
    }
}

}  // namespace replay
