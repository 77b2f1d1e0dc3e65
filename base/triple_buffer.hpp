// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace base {

/// Passes the latest value from one thread to another. It has three buffers, so that neither thread waits.
template <class Value>
class TripleBuffer {
public:
    /// Returns the buffer of the writing thread. Fill it, then call publish().
    [[nodiscard]] Value& next() { return buffers_[writing_]; }
    void publish() { writing_ = middle_.exchange(writing_ | kFresh, std::memory_order_acq_rel) & kIndex; }

    /// Returns the value that was published last, to the reading thread. It does not change before the next call.
    [[nodiscard]] const Value& latest() {
        if ((middle_.load(std::memory_order_relaxed) & kFresh) != 0) {
            reading_ = middle_.exchange(reading_, std::memory_order_acq_rel) & kIndex;
        }
        return buffers_[reading_];
    }

private:
    static constexpr std::uint32_t kFresh = 4, kIndex = 3;
    std::array<Value, 3> buffers_{};
    std::uint32_t writing_ = 0, reading_ = 1;
    std::atomic<std::uint32_t> middle_{2};
};

}  // namespace base
