// SPDX-License-Identifier: Apache-2.0
#include "replay/checks.hpp"

#include <fmt/format.h>

#include "base/input_error.hpp"
#include "host/print_line.hpp"
#include "master/journal/journal.hpp"
#include "scene/import/raster_memory.hpp"
#include "scene/load/memory.hpp"

namespace replay {

void requireMemory(const std::filesystem::path& journal, DecodedFor use, std::int64_t freeBytes) {
    const journal::JournalReader reader = master::openJournal(journal);
    const sand::FieldSize size = sand::FieldSize::of(journal::rulesOf(reader));
    if (!size.bytesOfReplica()) {
        if (use == DecodedFor::replica) {
            scene::requireReplica(journal::sceneOf(reader), journal.string(), freeBytes);
        }
    } else if (use == DecodedFor::replica) {
        scene::requireReplica(size, journal.string(), freeBytes);
    } else {
        scene::requireBytes(size.bytesOfHeights(), freeBytes, journal.string(),
                            fmt::format("{} x {} heights", size.columns, size.rows), "take a machine with more memory");
    }
}

void printMissing(const std::filesystem::path& journal, std::int64_t tornBytes, bool orderlyEnd) {
    if (tornBytes > 0) {
        host::printLine("{}: the last {} bytes are an incomplete write and were left out", journal.string(), tornBytes);
    }
    if (!orderlyEnd) {
        host::printLine("{}: has no orderly end; the session was cut off", journal.string());
    }
}

void requireStep(const std::filesystem::path& journal, std::uint64_t last, std::optional<std::uint64_t> until) {
    if (until && last < *until) {
        throw base::InputError(fmt::format("{}: ends at step {}, before --until {}", journal.string(), last, *until));
    }
}

}  // namespace replay
