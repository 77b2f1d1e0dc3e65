// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace replay {

/// Checks a journal and the checkpoints beside it, and prints a line on standard output for each result. Returns 0 if
/// all agree, and 1 if the sand or a checkpoint differs. Reads the journal record by record, so that the memory does
/// not grow with the session. Throws base::InputError if the journal cannot be used.
[[nodiscard]] int verifyJournal(const std::filesystem::path& journal);

}  // namespace replay
