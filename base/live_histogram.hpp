// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>

namespace base {

/// Histogram of durations [ns] with 128 buckets per octave, so that percentiles are within 1 %.
///
/// Threads: one thread adds, any number of threads read, and no call waits. Negative durations count as 0.
class LiveHistogram {
public:
    void add(std::int64_t ns) {
        const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0));
        bump(buckets_[bucketOf(value)], std::uint64_t{1});
        bump(count_, std::uint64_t{1});
        bump(sum_, static_cast<double>(value));
        bump(squares_, static_cast<double>(value) * static_cast<double>(value));
        max_.store(std::max(max_.load(std::memory_order_relaxed), value), std::memory_order_relaxed);
    }
    [[nodiscard]] std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }
    [[nodiscard]] double maxNs() const { return static_cast<double>(max_.load(std::memory_order_relaxed)); }
    [[nodiscard]] double meanNs() const {
        return count() == 0 ? 0 : sum_.load(std::memory_order_relaxed) / static_cast<double>(count());
    }
    [[nodiscard]] double stddevNs() const {
        const double mean = meanNs();
        const double square =
            count() == 0 ? 0 : squares_.load(std::memory_order_relaxed) / static_cast<double>(count());
        return std::sqrt(std::max(0.0, square - mean * mean));
    }
    /// Returns the middle of the bucket that holds the quantile `share` (0 to 1), or 0 if the histogram is empty.
    [[nodiscard]] double percentileNs(double share) const {
        const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count())));
        std::uint64_t seen = 0;
        for (std::size_t i = 0; i < buckets_.size() && wanted > 0; ++i) {
            seen += buckets_[i].load(std::memory_order_relaxed);
            if (seen >= wanted) {
                return std::min(middleOf(i), maxNs());
            }
        }
        return 0;
    }

    /// Calls visit(lowest [ns], count) for every bucket that is not empty, shortest durations first.
    template <class Visit>
    void eachBucket(const Visit& visit) const {
        for (std::size_t i = 0; i < buckets_.size(); ++i) {
            if (const std::uint64_t count = buckets_[i].load(std::memory_order_relaxed); count > 0) {
                visit(lowestOf(i), count);
            }
        }
    }

private:
    static constexpr unsigned kBits = 7;  // 2^7 buckets an octave

    static std::size_t bucketOf(std::uint64_t value) {
        const unsigned width = static_cast<unsigned>(std::bit_width(value));
        const unsigned shift = width > kBits + 1 ? width - kBits - 1 : 0;
        return (std::size_t{shift} << kBits) + static_cast<std::size_t>(value >> shift);
    }
    static std::size_t shiftOf(std::size_t bucket) { return std::max<std::size_t>(bucket >> kBits, 1) - 1; }
    static double lowestOf(std::size_t bucket) {
        const std::size_t shift = shiftOf(bucket);
        return std::ldexp(static_cast<double>(bucket - (shift << kBits)), static_cast<int>(shift));
    }
    static double middleOf(std::size_t bucket) {
        return lowestOf(bucket) + (std::ldexp(1.0, static_cast<int>(shiftOf(bucket))) - 1) / 2;
    }
    template <class Number>
    static void bump(std::atomic<Number>& number, Number by) {
        number.store(number.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
    }

    std::array<std::atomic<std::uint64_t>, (64 - kBits + 1) << kBits> buckets_{};
    std::atomic<std::uint64_t> count_{0}, max_{0};
    std::atomic<double> sum_{0}, squares_{0};
};

}  // namespace base
