// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "journal/journal.hpp"
#include "journal/reader.hpp"
#include "master/journal/writer.hpp"

namespace master {

/// Returns the journal that a user has named: `named` itself, or the journal in it if it is a session's folder. If
/// `named` is a link to a file, returns that file, because the functions below follow no link to a part of a journal.
/// Throws base::InputError if the link leads nowhere.
[[nodiscard]] std::filesystem::path journalAt(const std::filesystem::path& named);

/// Returns a reader of the journal in the file `journal` and of its parts beside it. Throws as its constructor does.
[[nodiscard]] journal::JournalReader openJournal(const std::filesystem::path& journal);
/// Returns a further reader of the journal that `opened` reads. It shares the header, which is large for a large field.
/// Throws as the constructor of the reader does.
[[nodiscard]] journal::JournalReader openAgain(const std::filesystem::path& journal,
                                               const journal::JournalReader& opened);
/// Reads a whole journal. Throws base::InputError if the file is missing, is not a journal, has another format or
/// algorithm, or is damaged before its end. Also throws if one of its parts is missing.
[[nodiscard]] journal::Journal readJournal(const std::filesystem::path& file);
/// Returns the length of all parts that are regular files [byte].
[[nodiscard]] std::int64_t allBytes(const std::filesystem::path& journal);

}  // namespace master
