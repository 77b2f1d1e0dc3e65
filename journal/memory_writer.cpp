// SPDX-License-Identifier: Apache-2.0
#include "journal/memory_writer.hpp"

#include <utility>

namespace journal {

MemoryWriter::MemoryWriter(const scene::Scene& scene, std::uint64_t session, std::string buildId,
                           std::string_view release) {
    JournalHeader header;
    header.session = session;
    header.buildId = std::move(buildId);
    header.scene = scene.encode();
    header.material = scene.material;
    bytes_ = encodeHeader(header, release, chain_);
}

void MemoryWriter::add(const JournalRecord& record) {
    const base::Bytes more = encodeRecord(record, chain_, bytes_.size());
    bytes_.insert(bytes_.end(), more.begin(), more.end());
}

base::Bytes MemoryWriter::endedAt(const JournalEnd& end) const {
    MemoryWriter ended(*this);
    ended.add(end);
    return std::move(ended.bytes_);
}

}  // namespace journal
