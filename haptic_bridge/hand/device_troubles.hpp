// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "sand/force/vec3.hpp"

namespace haptic_bridge {

/// Kinds of trouble with a device. While the trouble lasts, the tool is lifted and the hand feels nothing. The wall
/// continues.
enum class Trouble : std::uint8_t {
    absent,     // the device does not answer
    noNumber,   // a time or a coordinate is not finite
    jump,       // the hand moves farther than it can between two readings
    backwards,  // a reading is older than the one before it
    flood       // the device sends more than the master can take in
};
inline constexpr std::size_t kTroubles = 5;

/// Number of times that each trouble has happened. One thread counts without waiting; any thread may read.
class TroubleCounts {
public:
    void count(Trouble trouble) {
        auto& number = counts_[static_cast<std::size_t>(trouble)];
        number.store(number.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }
    [[nodiscard]] std::uint64_t of(Trouble trouble) const {
        return counts_[static_cast<std::size_t>(trouble)].load(std::memory_order_relaxed);
    }

    /// Counts a reading that the device has answered, or has not. A reading without an answer is Trouble::absent.
    void answered(bool answers) {
        if (!answers) {
            count(Trouble::absent);
        }
        if (!answers && !away()) {
            losses_.store(losses() + 1, std::memory_order_relaxed);
        }
        away_.store(!answers, std::memory_order_relaxed);
    }
    /// Returns how often the device has stopped to answer.
    [[nodiscard]] std::uint64_t losses() const { return losses_.load(std::memory_order_relaxed); }
    /// Returns whether the device has not answered the last reading.
    [[nodiscard]] bool away() const { return away_.load(std::memory_order_relaxed); }

private:
    std::array<std::atomic<std::uint64_t>, kTroubles> counts_{};
    std::atomic<std::uint64_t> losses_{0};
    std::atomic<bool> away_{false};
};

/// Makes lines for the user out of the counts of troubles. Used by one thread.
///
/// A trouble gives a line when it first happens, and then at most one line every kQuiet seconds. A device that does not
/// answer gives one line, and one more when it answers again.
class TroubleReporter {
public:
    static constexpr double kQuiet = 10;  // [s] between two lines about the same trouble
    static constexpr double kOver = 1;    // [s] since the last absent reading: the device answers again

    explicit TroubleReporter(std::string name) : name_(std::move(name)) {}
    /// Returns the lines that the user should read now. `time` [s] comes from any clock that never runs backwards.
    [[nodiscard]] std::vector<std::string> lines(const TroubleCounts& counts, double time);

private:
    struct Reported {
        std::uint64_t seen = 0;
        double grew = 0, lastLine = -kQuiet;
    };
    std::string name_;
    std::array<Reported, kTroubles> reported_{};
    bool away_ = false;
};

/// Decides whether the next reading of a hand is plausible. Counts each implausible reading as a trouble; the caller
/// then ignores it.
class ReadingCheck {
public:
    /// `farthest` is the largest distance that a hand may move between two readings, in the unit of places.
    ReadingCheck(double farthest, TroubleCounts& counts) : farthest_(farthest), counts_(counts) {}
    /// Returns whether the reading is plausible. After a jump, the next reading near the new place is plausible again.
    /// A device that was put elsewhere therefore continues at once.
    [[nodiscard]] bool accept(double time /* [s] */, sand::force::Vec3 place);

private:
    double farthest_;
    TroubleCounts& counts_;
    bool known_ = false;
    double time_ = 0;
    sand::force::Vec3 place_;
};

}  // namespace haptic_bridge
