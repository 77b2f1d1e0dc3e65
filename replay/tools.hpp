// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace replay {

/// Functions of sandwall-replay, except the replay itself. They read a journal record by record, so that the memory
/// does not grow with the session. All throw base::InputError if the journal cannot be used.

/// Checks a journal and the checkpoints beside it, and prints a line on standard output for each result. Returns 0 if
/// all agree, and 1 if the sand or a checkpoint differs.
[[nodiscard]] int verifyJournal(const std::filesystem::path& journal);

/// Use of a decoded journal: only its scene, or a replica that its steps are applied to.
enum class DecodedFor : std::uint8_t { scene, replica };
/// Checks, before any height is made, that this use fits into `freeBytes`. Throws base::InputError if it does not, or
/// if the journal cannot be read.
void requireMemory(const std::filesystem::path& journal, DecodedFor use, std::int64_t freeBytes);

/// Prints on standard error if a journal that was read to its end lacks an orderly end or has torn bytes.
void sayWhatIsMissing(const std::filesystem::path& journal, std::int64_t tornBytes, bool orderlyEnd);

/// Writes every step up to `until` as a row of a CSV file (docs/journal.md). Prints on standard error what the journal
/// lacks. If the journal ends before `until`, throws base::InputError and leaves the file unchanged.
void exportSteps(const std::filesystem::path& journal, const std::filesystem::path& file,
                 std::optional<std::uint64_t> until = {});
/// Throws base::InputError if a journal whose last step is `last` ends before the step `until` that the user named.
void requireStep(const std::filesystem::path& journal, std::uint64_t last, std::optional<std::uint64_t> until);

/// Writes the intact part of a journal as a new journal, and prints on standard output what is lost. Throws
/// base::InputError if `file` exists.
void recoverJournal(const std::filesystem::path& journal, const std::filesystem::path& file);

}  // namespace replay
