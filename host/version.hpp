// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace host {

/// Returns the release of this build, such as "0.2.0", from the topmost CMakeLists.txt.
[[nodiscard]] std::string_view release();

/// Version numbers of formats and rules that a program knows, such as {"journal", 6}.
using KnownVersions = std::vector<std::pair<std::string_view, std::uint32_t>>;

/// Returns version, build id and known versions of a program, for people or as one JSON object.
[[nodiscard]] std::string versionText(std::string_view program, const KnownVersions& known, bool json);

/// Prints versionText() if `--version` is among the arguments, as JSON if `--json` is too. Call it first in main, and
/// end the program if it returns true: the answer needs no MPI and no other option.
[[nodiscard]] bool answersVersion(int argc, char** argv, std::string_view program, const KnownVersions& known = {});

}  // namespace host
