// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "base/names.hpp"

namespace haptic_bridge {

/// Guards that may change a force before it is pushed. Their order is that of the bits in Tick::guards, lowest first.
enum class Guard : std::uint8_t {
    notANumber,  // a place, velocity or force is not finite: no force is sent
    stiffness,   // the law is stiffer than the device can bear
    damping,     // friction grows faster with speed than the device can bear
    friction,    // friction is greater than the sand can hold
    slew,        // the force grows faster than the stiffness and the fastest hand explain
    passivity,   // the loop has given the hand more energy than it took: the force is damped
    clamp,       // the force exceeds the device's greatest force
    ramp,        // less than two seconds have passed since a start or a fault
    stale,       // the thread that makes steps hangs: no force is sent
    missed,      // the loop has missed ticks: no force is sent
    lost,        // the device does not answer: no force is sent
    jumped,      // the device seems to move faster than any arm can: no force is sent
    frozen,      // the sand gets no steps: the force fades
    contact,     // a contact or an edit asks for much force at once: the excess grows in a ramp
    gate,        // the force to be pushed would grow or turn faster than any guard before the gate allows
    unread,      // the device gives no reading, but may only be late: the force fades
    edit,        // an edit has changed what is felt: the force crosses over
    tripped      // three faults came within ten seconds: no force is sent until an operator switches it on
};
constexpr auto valuesOf(Guard) {
    using enum Guard;
    return std::array{base::Named{notANumber, "not_a_number"},
                      base::Named{stiffness, "stiffness"},
                      base::Named{damping, "damping"},
                      base::Named{friction, "friction"},
                      base::Named{slew, "slew"},
                      base::Named{passivity, "passivity"},
                      base::Named{clamp, "clamp"},
                      base::Named{ramp, "ramp"},
                      base::Named{stale, "stale"},
                      base::Named{missed, "missed"},
                      base::Named{lost, "lost"},
                      base::Named{jumped, "jumped"},
                      base::Named{frozen, "frozen"},
                      base::Named{contact, "contact"},
                      base::Named{gate, "gate"},
                      base::Named{unread, "unread"},
                      base::Named{edit, "edit"},
                      base::Named{tripped, "tripped"}};
}
inline constexpr std::size_t kGuards = valuesOf(Guard{}).size();

[[nodiscard]] constexpr std::uint32_t bit(Guard guard) { return 1U << static_cast<unsigned>(guard); }

/// Guards that act on a fault, or after three of them: in such a tick no force is sent.
inline constexpr std::uint32_t kFaults = bit(Guard::notANumber) | bit(Guard::stale) | bit(Guard::missed) |
                                         bit(Guard::lost) | bit(Guard::jumped) | bit(Guard::tripped);

/// Number of ticks in which each guard acted. One thread writes, any thread may read; no thread waits.
class GuardCounts {
public:
    void add(std::uint32_t acted) {
        for (std::size_t i = 0; i < kGuards; ++i) {
            if ((acted >> i & 1U) != 0) {
                counts_[i].store(counts_[i].load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
            }
        }
    }
    [[nodiscard]] std::array<std::uint64_t, kGuards> all() const {
        std::array<std::uint64_t, kGuards> result{};
        for (std::size_t i = 0; i < kGuards; ++i) {
            result[i] = counts_[i].load(std::memory_order_relaxed);
        }
        return result;
    }
    /// Returns one line such as "guards acted in ticks: stiffness 812, ramp 30".
    [[nodiscard]] std::string inWords() const {
        std::string text;
        const auto counts = all();
        for (std::size_t i = 0; i < kGuards; ++i) {
            if (counts[i] > 0) {
                text += (text.empty() ? "" : ", ") + std::string(valuesOf(Guard{})[i].name) + ' ' +
                        std::to_string(counts[i]);
            }
        }
        return "guards acted in ticks: " + (text.empty() ? "none" : text);
    }

private:
    std::array<std::atomic<std::uint64_t>, kGuards> counts_{};
};

}  // namespace haptic_bridge
