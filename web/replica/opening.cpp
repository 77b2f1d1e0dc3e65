// SPDX-License-Identifier: Apache-2.0
#include "web/replica/opening.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "base/input_error.hpp"
#include "journal/journal.hpp"
#include "journal/memory_parts.hpp"

namespace web {
namespace {

constexpr double kMebibyte = 1 << 20;

/// Throws base::InputError, with what a page can do, if another release wrote the journal.
void requireOurs(const std::string& name, const std::vector<base::Bytes>& parts, std::string_view release) {
    try {
        base::ByteReader reader(parts.at(0));
        std::uint64_t chain = 0;
        (void)journal::decodeHeader(reader, release, chain);
    } catch (const journal::ForeignFile& error) {
        const std::string why = error.what();
        const std::size_t advice = why.rfind(": ");
        throw base::InputError(
            advice == std::string::npos
                ? fmt::format("{}: {}", name, why)
                : fmt::format("{}: {}. A page cannot run another release; open it with the page of that release", name,
                              why.substr(0, advice)));
    } catch (const base::FormatError&) {
        return;  // the reader says more about it
    }
}

}  // namespace

void requireMemory(const std::string& name, const sand::FieldSize& size, std::int64_t memory, std::int64_t more) {
    const std::int64_t needed = size.leastBytes() + more;
    if (needed > memory) {
        throw base::InputError(
            fmt::format("{}: {} need at least {:.0f} MiB, and a page has {:.0f} MiB; use a program on a computer", name,
                        size.text(), static_cast<double>(needed) / kMebibyte, static_cast<double>(memory) / kMebibyte));
    }
}

journal::JournalReader openedJournal(const std::string& name, std::vector<base::Bytes> parts, std::string_view release,
                                     std::int64_t memory) {
    if (parts.empty()) {
        throw base::InputError(name + ": has no part");
    }
    requireOurs(name, parts, release);
    journal::JournalReader reader(std::make_unique<journal::MemoryParts>(name, std::move(parts)), release);
    requireMemory(reader.place().journal, sand::FieldSize::of(journal::rulesOf(reader)), memory);
    return reader;
}

scene::Scene sceneWithMaterial(const journal::JournalReader& reader) {
    scene::Scene scene = journal::sceneOf(reader);
    scene.material = reader.header().material.value_or(scene::Material());
    return scene;
}

}  // namespace web
