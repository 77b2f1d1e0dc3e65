// SPDX-License-Identifier: Apache-2.0
// Fuzzes a journal, either as it is or put together from records with correct checksums. The correct checksums let the
// fuzzer reach the contents of the records.
#include "host/version.hpp"
#include "journal/memory_parts.hpp"
#include "journal/recording.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

/// Returns the header of a session of 8 x 8 cells.
base::Bytes header(std::uint64_t& chain) {
    journal::JournalHeader header;
    header.session = 1;
    header.buildId = "build";
    header.scene = samples::flatScene(8, 8).encode();
    header.material = scene::Material();
    return journal::encodeHeader(header, host::release(), chain);
}

/// Returns a journal whose records are pieces of the input. The first byte of each piece is the type of its record.
base::Bytes journalOf(fuzz::Input input) {
    base::ByteWriter writer;
    std::uint64_t chain = 0;
    writer.putBytes(header(chain));
    for (const fuzz::Input body : fuzz::piecesOf(input)) {
        if (!body.empty()) {
            writer.put(static_cast<std::uint32_t>(body.size() - 1));
            writer.putBytes(body);
            chain = journal::recordChecksum(body, chain);
            writer.put(chain);
        }
    }
    return writer.take();
}

}  // namespace

SANDWALL_FUZZER(journal) {
    if (size == 0) {
        return 0;
    }
    const fuzz::Input input = fuzz::Input(data, size).subspan(1);
    const bool whole = (data[0] & 1U) != 0;
    const base::Bytes made = whole ? base::Bytes{} : journalOf(input);
    const fuzz::Input bytes = whole ? input : fuzz::Input(made);
    fuzz::takeOrRefuse([&] {
        auto parts =
            std::make_unique<journal::MemoryParts>("journal", std::vector<base::Bytes>{{bytes.begin(), bytes.end()}});
        journal::JournalReader reader(std::move(parts), host::release());
        const journal::Recording recording(journal::readAll(reader), "journal", 30);
        (void)recording.stepsOf(1);
    });
    return 0;
}
