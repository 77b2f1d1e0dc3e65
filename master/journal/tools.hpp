// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace master {

/// What sandwall-replay does with a journal beside replaying it. All of it is read record by record, so that memory
/// does not grow with the session. All throw base::InputError for a journal that cannot be used.

/// Checks all that a journal says of itself, and checkpoints beside it: a line on standard output for each. Returns 0
/// when all agrees, and 1 when the sand or a checkpoint differs.
[[nodiscard]] int verifyJournal(const std::filesystem::path& journal);

/// Use of a decoded journal: its scene alone, or a replica that its steps are applied to.
enum class DecodedFor : std::uint8_t { scene, replica };
/// Checks, before any height is made, that this use fits into `freeBytes`. Throws base::InputError if it does not, or
/// if the journal cannot be read.
void requireMemory(const std::filesystem::path& journal, DecodedFor use, std::int64_t freeBytes);

/// Says on standard error what a journal that is read to its end lacks, if anything.
void sayWhatIsMissing(const std::filesystem::path& journal, std::int64_t tornBytes, bool orderlyEnd);

/// Writes every step up to `until` as a row of a CSV file (docs/journal.md). Prints on standard error what the journal
/// lacks. Writes nothing if the journal ends before `until`, and throws.
void exportSteps(const std::filesystem::path& journal, const std::filesystem::path& file,
                 std::optional<std::uint64_t> until = {});
/// Throws base::InputError if a journal whose last step is `last` ends before the step `until` that the user named.
void requireStep(const std::filesystem::path& journal, std::uint64_t last, std::optional<std::uint64_t> until);

/// Writes the intact part of a journal as a new journal, and prints on standard output what is lost. Refuses to
/// overwrite a file.
void recoverJournal(const std::filesystem::path& journal, const std::filesystem::path& file);

}  // namespace master
