// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "journal/journal_parts.hpp"

namespace journal {

/// The parts of a journal in memory: NAME, NAME.2 and so on.
class MemoryParts : public JournalParts {
public:
    /// `name` is that of the first part.
    MemoryParts(std::string name, std::vector<base::Bytes> parts) : name_(std::move(name)), parts_(std::move(parts)) {}

    [[nodiscard]] std::string name(std::uint32_t part) const override;
    [[nodiscard]] bool has(std::uint32_t part) const override { return part >= 1 && part <= parts_.size(); }
    [[nodiscard]] std::int64_t length(std::uint32_t part) override {
        return static_cast<std::int64_t>(parts_.at(part - 1).size());
    }
    void read(std::uint32_t part, std::int64_t offset, std::int64_t size, base::Bytes& bytes) override;

private:
    std::string name_;
    std::vector<base::Bytes> parts_;
};

}  // namespace journal
