// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace host {
class CommandLine;
}

namespace replay {

/// Options of sandwall-replay.
struct ReplayOptions {
    std::string file;
    bool hash = false;
    bool verify = false;
    bool volumes = false;
    std::string heights, difference, mesh, forces, steps, recovered;
    std::optional<std::uint64_t> until;

    /// Adds these options to `line`. All options that read the replayed sand can be combined, also with --export.
    /// --verify and --recover read every record themselves, so they exclude all other options.
    void addTo(host::CommandLine& line);

    /// Returns whether no option asks for results of the replayed sand or of the hand.
    [[nodiscard]] bool plain() const {
        return !hash && !volumes && heights.empty() && difference.empty() && mesh.empty() && forces.empty();
    }
    /// Returns all files that are to be written, each with the option that names it.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> outputs() const;
    /// Checks all outputs before the replay, which may take hours. Throws base::InputError.
    void checkOutputs() const;
};

}  // namespace replay
