// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace replay {

/// Use of a decoded journal: only its scene, or a replica that its steps are applied to.
enum class DecodedFor : std::uint8_t { scene, replica };
/// Checks, before any height is made, that this use fits into `freeBytes`. Throws base::InputError if it does not, or
/// if the journal cannot be read.
void requireMemory(const std::filesystem::path& journal, DecodedFor use, std::int64_t freeBytes);

/// Prints on standard error if a journal that was read to its end lacks an orderly end or has torn bytes.
void printMissing(const std::filesystem::path& journal, std::int64_t tornBytes, bool orderlyEnd);

/// Throws base::InputError if a journal whose last step is `last` ends before the step `until` that the user named.
void requireStep(const std::filesystem::path& journal, std::uint64_t last, std::optional<std::uint64_t> until);

}  // namespace replay
