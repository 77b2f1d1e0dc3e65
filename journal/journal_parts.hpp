// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "base/byte_stream.hpp"

namespace journal {

/// The bytes of a journal, part by part, from files or from memory. Parts count from 1. Used by one thread.
class JournalParts {
public:
    JournalParts() = default;
    virtual ~JournalParts() = default;
    JournalParts(const JournalParts&) = delete;
    JournalParts& operator=(const JournalParts&) = delete;

    /// Returns the name of a part for messages, such as the path of its file. The part need not exist.
    [[nodiscard]] virtual std::string name(std::uint32_t part) const = 0;
    [[nodiscard]] virtual bool has(std::uint32_t part) const = 0;
    /// Returns the length of a part [byte]. Throws base::InputError, which names the part, if it cannot be read.
    [[nodiscard]] virtual std::int64_t length(std::uint32_t part) = 0;
    /// Sets `bytes` to `size` bytes from `offset` of a part whose length has been asked for, or to fewer at its end.
    virtual void read(std::uint32_t part, std::int64_t offset, std::int64_t size, base::Bytes& bytes) = 0;
};

}  // namespace journal
