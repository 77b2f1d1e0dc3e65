// SPDX-License-Identifier: Apache-2.0
#include "master/steps/given_state.hpp"

#include <chrono>
#include <utility>

#include "master/journal/keeper.hpp"

namespace master {
namespace {

/// Ends the thread of a state that was dropped.
struct Dropped {};

}  // namespace

std::optional<base::Bytes> GivenState::next(const sand::Replica& replica) {
    if (!bytes_.valid()) {
        const bool copies = copy_ && replica.continueCopy(JournalKeeper::kCopiedCells);
        if (!copy_ || (!copies && !copy_->complete())) {  // another replica may have taken the place of this one
            copy_ = replica.beginCopy();
            (void)replica.continueCopy(JournalKeeper::kCopiedCells);
        }
        if (!copy_->complete()) {
            return std::nullopt;
        }
        dropped_ = std::make_shared<std::atomic<bool>>(false);
        bytes_ = std::async(std::launch::async, [copy = *std::exchange(copy_, std::nullopt), dropped = dropped_] {
            return copy.encode([&] {
                if (*dropped) {
                    throw Dropped();
                }
            });
        });
    }
    constexpr std::chrono::milliseconds kLittle{2};  // enough for a small field
    if (bytes_.wait_for(kLittle) != std::future_status::ready) {
        return std::nullopt;
    }
    return bytes_.get();
}

void GivenState::drop() {
    copy_.reset();
    if (bytes_.valid()) {
        *dropped_ = true;
        bytes_.wait();
        bytes_ = {};
    }
}

}  // namespace master
