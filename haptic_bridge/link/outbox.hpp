// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <utility>

#include "base/byte_stream.hpp"

namespace haptic_bridge {

/// Queue of the bytes that wait to be sent over one connection, oldest first. Its size is limited.
class Outbox {
public:
    explicit Outbox(std::size_t most) : most_(most) {}

    /// Sets how many bytes of ordinary messages may wait.
    void setMost(std::size_t most) { most_ = most; }
    /// Adds `bytes`. Returns false, and leaves the queue unchanged, if too much would wait: more ordinary bytes than
    /// setMost() allows, or a second long message.
    [[nodiscard]] bool push(base::Bytes bytes, bool isLong) {
        if (isLong ? long_ > 0 : bytes_ + bytes.size() > most_) {
            return false;
        }
        long_ += isLong ? 1 : 0;
        bytes_ += isLong ? 0 : bytes.size();
        waiting_.push_back({std::move(bytes), isLong});
        return true;
    }
    [[nodiscard]] bool empty() const { return waiting_.empty(); }
    [[nodiscard]] std::size_t size() const { return waiting_.size(); }
    [[nodiscard]] const base::Bytes& front() const { return waiting_.front().bytes; }
    /// Removes the oldest entry, because it has been sent.
    void pop() {
        const Entry& sent = waiting_.front();
        long_ -= sent.isLong ? 1 : 0;
        bytes_ -= sent.isLong ? 0 : sent.bytes.size();
        waiting_.pop_front();
    }

private:
    struct Entry {
        base::Bytes bytes;
        bool isLong = false;
    };
    std::deque<Entry> waiting_;
    std::size_t bytes_ = 0, most_;  // of ordinary messages
    int long_ = 0;
};

}  // namespace haptic_bridge
