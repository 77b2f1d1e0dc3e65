// SPDX-License-Identifier: Apache-2.0
// What passes while a server numbers the steps: its steps and timing tests one way, what the wall has shown the other.
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <iterator>
#include <utility>

#include "haptic_bridge/client/connection_thread.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

namespace asio = boost::asio;

namespace {

constexpr std::size_t kMaxTests = 64;  // a wall that stands still has no round trip to tell

}  // namespace

void Client::Session::accept(const TimingTest& test) {
    connection_->send(TimingEcho{test.id, Leg::received});
    const std::lock_guard lock(shelf.mutex);
    shelf.tests.push_back({test.id, lastStep_});
    if (shelf.tests.size() > kMaxTests) {
        shelf.tests.pop_front();
    }
}

void Client::Session::accept(StepMessage&& message) {
    const sand::Step& step = message.step;
    const std::uint64_t number = step.number;
    const bool linked = link() == Link::linked;
    bool full = false;
    {
        const std::lock_guard lock(shelf.mutex);
        if (!linked || step.epoch != granted_.epoch) {
            ++shelf.counters.stepsForeign;
            return;
        }
        if (number <= lastStep_) {
            ++shelf.counters.stepsStale;
            return;
        }
        if (number == lastStep_ + 1) {
            lastStep_ = number;
            ++shelf.counters.stepsIn;
            shelf.steps.push_back(
                {std::move(message.step), message.serverTimeNs, message.stateHash, host::monotonicNs()});
            full = shelf.full = shelf.steps.size() >= kMaxQueued;
        }
    }
    if (lastStep_ < number) {
        connection_->close(fmt::format("step {} came after step {}", number, lastStep_));
    } else if (full) {
        connection_->pause();
    }
}

std::vector<TimedStep> Client::Session::drain(std::size_t most) {
    std::vector<TimedStep> steps;
    const std::lock_guard lock(shelf.mutex);
    const std::size_t count = std::min(most, shelf.steps.size());
    const auto end = shelf.steps.begin() + static_cast<std::ptrdiff_t>(count);
    steps.assign(std::make_move_iterator(shelf.steps.begin()), std::make_move_iterator(end));
    shelf.steps.erase(shelf.steps.begin(), end);
    const std::uint64_t next = shelf.steps.empty() ? ~std::uint64_t{0} : shelf.steps.front().step.number;
    while (!shelf.tests.empty() && shelf.tests.front().after < next) {
        if (shelf.testsInFrame.size() < kMaxTests) {
            shelf.testsInFrame.push_back(shelf.tests.front().id);
        }
        shelf.tests.pop_front();
    }
    if (shelf.full && shelf.steps.size() < kMaxQueued) {
        resumeReading();
    }
    return steps;
}

/// Under the shelf's mutex.
void Client::Session::resumeReading() {
    shelf.full = false;
    asio::post(io_, [this] {
        if (connection_ && !silent()) {
            connection_->resume();
        }
    });
}

void Client::Session::shown(const Shown& frame) {
    std::vector<std::uint32_t> tests;
    {
        const std::lock_guard lock(shelf.mutex);
        tests.swap(shelf.testsInFrame);
    }
    asio::post(io_, [this, frame, tests = std::move(tests)] {
        if (!connection_ || silent() || link() != Link::linked) {
            return;
        }
        // A frame drawn before the hand-over's first step says nothing about the server's steps yet.
        const auto connection = connection_;  // sending may close it
        connection->send(Shown{std::clamp(frame.stepNumber, granted_.stepNumber, lastStep_), frame.frameIntervalNs});
        for (const std::uint32_t id : tests) {
            connection->send(TimingEcho{id, Leg::shown});
        }
    });
}

}  // namespace haptic_bridge
