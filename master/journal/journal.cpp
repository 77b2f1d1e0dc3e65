// SPDX-License-Identifier: Apache-2.0
#include "master/journal/journal.hpp"

#include <memory>
#include <system_error>

#include "host/version.hpp"
#include "master/journal/file_parts.hpp"

namespace master {

namespace fs = std::filesystem;

fs::path journalAt(const fs::path& named) {
    std::error_code none;
    return fs::is_directory(named, none) ? named / "session.journal" : named;
}

journal::JournalReader openJournal(const fs::path& journal) {
    return {std::make_unique<FileParts>(journal), host::release()};
}

journal::Journal readJournal(const fs::path& file) {
    journal::JournalReader reader = openJournal(file);
    return journal::readAll(reader);
}

std::int64_t allBytes(const fs::path& journal) {
    std::int64_t sum = 0;
    std::error_code error;
    for (std::uint32_t part = 1;; ++part) {
        const auto size = fs::file_size(partOf(journal, part), error);
        if (error) {
            return sum;
        }
        sum += static_cast<std::int64_t>(size);
    }
}

}  // namespace master
