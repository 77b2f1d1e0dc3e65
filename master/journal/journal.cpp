// SPDX-License-Identifier: Apache-2.0
#include "master/journal/journal.hpp"

#include <fmt/format.h>

#include <memory>
#include <system_error>

#include "base/input_error.hpp"
#include "host/regular_file.hpp"
#include "host/version.hpp"
#include "master/journal/file_parts.hpp"

namespace master {

namespace fs = std::filesystem;

fs::path journalAt(const fs::path& named) {
    std::error_code error;
    if (fs::is_directory(named, error)) {
        return named / "session.journal";
    }
    if (!fs::is_symlink(named, error)) {
        return named;
    }
    fs::path target = fs::canonical(named, error);
    if (error) {
        throw base::InputError(fmt::format("{}: cannot be read ({}); check the path", named.string(), error.message()));
    }
    return target;
}

journal::JournalReader openJournal(const fs::path& journal) {
    return {std::make_unique<FileParts>(journal), host::release()};
}

journal::JournalReader openAgain(const fs::path& journal, const journal::JournalReader& opened) {
    return {std::make_unique<FileParts>(journal), opened};
}

journal::Journal readJournal(const fs::path& file) {
    journal::JournalReader reader = openJournal(file);
    return journal::readAll(reader);
}

std::int64_t allBytes(const fs::path& journal) {
    std::int64_t sum = 0;
    for (std::uint32_t part = 1;; ++part) {
        const host::RegularFile file(partOf(journal, part), host::RegularFile::Links::refused);
        if (!file.error().empty()) {
            return sum;
        }
        sum += static_cast<std::int64_t>(file.size());
    }
}

}  // namespace master
