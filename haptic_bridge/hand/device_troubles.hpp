// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// What a device may do wrong. The hand is lifted and feels nothing meanwhile; the wall goes on.
enum class Trouble : std::uint8_t { absent, noNumber, jump, backwards, flood };
inline constexpr std::size_t kTroubles = 5;

/// How often each has happened. Counted by one thread without waiting, read by any.
class TroubleCounts {
public:
    void count(Trouble trouble) {
        auto& number = counts_[static_cast<std::size_t>(trouble)];
        number.store(number.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }
    [[nodiscard]] std::uint64_t of(Trouble trouble) const {
        return counts_[static_cast<std::size_t>(trouble)].load(std::memory_order_relaxed);
    }

private:
    std::array<std::atomic<std::uint64_t>, kTroubles> counts_{};
};

/// Makes one line of a trouble however often it happens: when it begins, every kQuiet seconds while it lasts, and, of a
/// device that did not answer, when it does again. One thread.
class TroubleTeller {
public:
    static constexpr double kQuiet = 10;  // [s]
    static constexpr double kOver = 1;    // [s] without another one, and a device answers again

    explicit TroubleTeller(std::string name) : name_(std::move(name)) {}
    /// What a person should read now; `time` [s] on any clock that runs forward.
    [[nodiscard]] std::vector<std::string> lines(const TroubleCounts& counts, double time);

private:
    struct Told {
        std::uint64_t seen = 0;
        double grew = 0, told = -kQuiet;
    };
    std::string name_;
    std::array<Told, kTroubles> told_{};
    bool away_ = false;
};

/// Whether the next reading of a hand can be believed. What is not is counted, and is no reading.
class ReadingCheck {
public:
    /// `farthest` is what a hand may move between two readings.
    ReadingCheck(double farthest, TroubleCounts& counts) : farthest_(farthest), counts_(counts) {}
    /// A hand that jumped is believed from its next reading on, there: a device that was set anew goes on at once.
    [[nodiscard]] bool accept(double time /* [s] */, sand::force::Vec3 place);

private:
    double farthest_;
    TroubleCounts& counts_;
    bool known_ = false;
    double time_ = 0;
    sand::force::Vec3 place_;
};

}  // namespace haptic_bridge
