// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <variant>

#include "journal/reader.hpp"
#include "master/journal/journal.hpp"

namespace test {

/// Returns the length of a journal of one part up to the first note of a majority, and with it [byte]. Returns nullopt
/// without such a note. A session may be writing the journal.
inline std::optional<std::uintmax_t> lengthWithDoubt(const std::filesystem::path& journal) {
    journal::JournalReader reader = master::openJournal(journal);
    while (const auto record = reader.next()) {
        if (std::holds_alternative<journal::JournalDoubt>(*record)) {
            return static_cast<std::uintmax_t>(reader.place().offset);
        }
    }
    return std::nullopt;
}

}  // namespace test
