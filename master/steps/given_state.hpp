// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>

#include "base/byte_stream.hpp"
#include "sand/replica.hpp"

namespace master {

/// The whole sand for a haptic server. It is copied over some frames and compressed on a thread, because this takes
/// seconds for a large field, and the wall shows frames meanwhile. The replica must not make a step until the bytes are
/// there. Main thread only. The destructor waits until the thread notices it, at most for a stripe of the sand.
class GivenState {
public:
    GivenState() = default;
    ~GivenState() { drop(); }
    GivenState(const GivenState&) = delete;
    GivenState& operator=(const GivenState&) = delete;

    /// Begins with the present sand of `replica`, or continues. Call it once a frame. Returns the bytes of
    /// sand::Replica::encodeState() once, when they are there. Throws std::bad_alloc.
    [[nodiscard]] std::optional<base::Bytes> next(const sand::Replica& replica);
    /// Forgets the sand. The next call of next() begins again.
    void drop();

private:
    std::optional<sand::StateCopy> copy_;  // while it is copied
    std::future<base::Bytes> bytes_;
    std::shared_ptr<std::atomic<bool>> dropped_;  // shared with the thread of bytes_
};

}  // namespace master
