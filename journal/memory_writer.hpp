// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "journal/format.hpp"
#include "scene/model/scene.hpp"

namespace journal {

/// Writes a journal of one part into memory. Each record counts as a write of its own. Used by one thread.
class MemoryWriter {
public:
    /// Begins with the header of `scene`. `session` is the random number of the session, `buildId` names the program,
    /// and `release` is its release.
    MemoryWriter(const scene::Scene& scene, std::uint64_t session, std::string buildId, std::string_view release);

    void add(const JournalRecord& record);
    /// Returns the bytes of all records, and of `end` behind them. Further records may be added afterwards.
    [[nodiscard]] base::Bytes endedAt(const JournalEnd& end) const;
    /// Returns the bytes of all records.
    [[nodiscard]] const base::Bytes& bytes() const { return bytes_; }

private:
    base::Bytes bytes_;
    std::uint64_t chain_ = 0;
};

}  // namespace journal
