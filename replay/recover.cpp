// SPDX-License-Identifier: Apache-2.0
#include "replay/recover.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <system_error>
#include <variant>

#include "base/input_error.hpp"
#include "host/regular_file.hpp"
#include "master/journal/journal.hpp"
#include "scene/model/scene.hpp"

namespace replay {

void recoverJournal(const std::filesystem::path& journal, const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::exists(file, error)) {
        throw base::InputError(fmt::format("{}: is there already; choose another file", file.string()));
    }
    journal::JournalReader reader = master::openJournal(journal);
    scene::Scene scene = journal::sceneOf(reader);
    scene.material = reader.header().material.value_or(scene::Material());
    if (file.has_parent_path()) {
        try {
            host::makeFolders(file.parent_path());
        } catch (const std::filesystem::filesystem_error&) {
            error.clear();  // the writer reports it
        }
    }
    master::JournalWriter writer(file, scene, reader.header().buildId);
    std::uint64_t records = 0, step = 0;
    std::string damage;
    try {
        while (auto record = reader.next()) {
            ++records;
            if (auto* const resumed = std::get_if<journal::JournalResumed>(&*record)) {
                resumed->failure.clear();  // earlier builds have written the names of hosts there
            }
            const auto* frame = std::get_if<journal::JournalFrame>(&*record);
            step = frame != nullptr && !frame->steps.empty() ? frame->steps.back().number : step;
            writer.keep(*record);
        }
    } catch (const base::InputError& found) {
        damage = found.what();
    }
    writer.sync();
    const std::int64_t lost = master::allBytes(journal) - reader.wholeBytes();
    if (!damage.empty()) {
        fmt::print("{}\n", damage);
    }
    fmt::print("{}: {} records, to step {}; {} of {} bytes are lost\n", file.string(), records, step, lost,
               master::allBytes(journal));
}

}  // namespace replay
