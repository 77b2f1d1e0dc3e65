// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace replay {

/// Writes the intact part of a journal as a new journal, and prints on standard output what is lost. Reads the journal
/// record by record, so that the memory does not grow with the session. Throws base::InputError if `file` exists, or if
/// the journal cannot be used.
void recoverJournal(const std::filesystem::path& journal, const std::filesystem::path& file);

}  // namespace replay
