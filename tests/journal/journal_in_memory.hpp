// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "journal/memory_parts.hpp"
#include "journal/reader.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace test {

/// Makes the bytes of a journal, of which each record is a write.
class JournalInMemory {
public:
    explicit JournalInMemory(const scene::Scene& scene) {
        header_.session = 1;
        header_.buildId = "build";
        header_.scene = scene.encode();
        header_.material = scene.material;
        parts_.push_back(journal::encodeHeader(header_, "1.2.3", chain_));
    }
    void add(const journal::JournalRecord& record) {
        const base::Bytes bytes = journal::encodeRecord(record, chain_, parts_.back().size());
        parts_.back().insert(parts_.back().end(), bytes.begin(), bytes.end());
    }
    void beginPart(const journal::JournalEnd& sand) {
        header_.part = static_cast<std::uint32_t>(parts_.size() + 1);
        add(journal::JournalContinued{header_.part});
        header_.continues = chain_;
        header_.sand = sand;
        header_.scene.clear();
        header_.material.reset();
        parts_.push_back(journal::encodeHeader(header_, "1.2.3", chain_));
    }
    [[nodiscard]] std::vector<base::Bytes>& parts() { return parts_; }
    [[nodiscard]] journal::JournalReader reader(std::string_view release = "1.2.3") const {
        return {std::make_unique<journal::MemoryParts>("folder/JOURNAL", parts_), release};
    }

private:
    journal::JournalHeader header_;
    std::uint64_t chain_ = 0;
    std::vector<base::Bytes> parts_;
};

}  // namespace test
