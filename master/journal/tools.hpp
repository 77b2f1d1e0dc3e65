// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace master {

/// What sandwall-replay does with a journal beside replaying it. All of it is read record by record, so that memory
/// does not grow with the session. All throw base::InputError for a journal that cannot be used.

/// Checks all that a journal says of itself, and checkpoints beside it: a line on standard output for each. Returns 0
/// when all agrees, and 1 when the sand or a checkpoint differs.
[[nodiscard]] int verifyJournal(const std::filesystem::path& journal);

/// Says on standard error what a journal that is read to its end lacks, if anything.
void sayWhatIsMissing(const std::filesystem::path& journal, std::int64_t tornBytes, bool orderlyEnd);

/// Every step as a row of a CSV file (docs/journal.md). Says on standard error what the journal lacks.
void exportSteps(const std::filesystem::path& journal, const std::filesystem::path& file);

/// Writes the intact part of a journal as a new journal, and prints on standard output what is lost. Refuses to
/// overwrite a file.
void recoverJournal(const std::filesystem::path& journal, const std::filesystem::path& file);

}  // namespace master
