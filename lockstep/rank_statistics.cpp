// SPDX-License-Identifier: Apache-2.0
#include "lockstep/rank_statistics.hpp"

#include <algorithm>
#include <utility>

namespace lockstep {
namespace {

constexpr std::size_t kSamplesPerRank = 1 << 12;
constexpr std::size_t kFewestFrames = 30;  // a rank is judged by at least this many
constexpr double kLeastShare = 0.25;
constexpr double kByFar = 2;  // times as often as the next rank

/// Number and total time of the wall's waits for one rank.
struct Waits {
    double count = 0, ms = 0;
};

/// Returns the rank that stands out; nullopt if no rank stands out. On shared cores some rank is always last, but a
/// different one in each frame.
std::optional<Drag> standsOut(const std::vector<Waits>& waits, double frames) {
    Drag drag;
    double next = 0, most = 0;
    for (std::size_t rank = 0; rank < waits.size(); ++rank) {
        if (waits[rank].count > most) {
            next = most;
            most = waits[rank].count;
            drag = {static_cast<int>(rank), most / frames, waits[rank].ms / most};
        } else {
            next = std::max(next, waits[rank].count);
        }
    }
    const bool clear = frames >= kFewestFrames && drag.share >= kLeastShare && most >= kByFar * next;
    return clear ? std::optional(drag) : std::nullopt;
}

}  // namespace

std::optional<LastToCome> lastToCome(std::span<const Arrival> arrivals) {
    if (arrivals.size() < 3) {  // the master and one render rank, which has no other to be compared with
        return std::nullopt;
    }
    std::size_t last = 0;
    std::int64_t before = arrivals[1].arrived;  // the latest of the others
    for (std::size_t rank = 1; rank < arrivals.size(); ++rank) {
        if (arrivals[rank].arrived > arrivals[last].arrived) {
            before = arrivals[last].arrived;
            last = rank;
        } else {
            before = std::max(before, arrivals[rank].arrived);
        }
    }
    const double by = static_cast<double>(arrivals[last].arrived - before) * 1e-6;
    return by < kTieMs ? std::nullopt : std::optional<LastToCome>({static_cast<int>(last), by});
}

RankStatistics::Rank::Rank() : keptMs(kSamplesPerRank), swapUs(kSamplesPerRank) {}

RankStatistics::RankStatistics(std::size_t ranks) : ranks_(ranks) { recent_.reserve(kRecent); }

void RankStatistics::add(std::span<const Arrival> arrivals, bool swapsCount) {
    const std::optional<LastToCome> last = lastToCome(arrivals);
    if (last) {
        ranks_[static_cast<std::size_t>(last->rank)].keptMs.add(last->byMs);
    }
    if (recent_.size() < kRecent) {
        recent_.emplace_back();
    }
    recent_[frames_++ % kRecent] = last.value_or(LastToCome{});
    addOdd(std::exchange(healedNow_, {}));
    lastSwapsUs_.clear();
    const auto earlier = [](const Arrival& a, const Arrival& b) { return a.lastSwap < b.lastSwap; };
    const std::int64_t first = std::min_element(arrivals.begin() + 1, arrivals.end(), earlier)->lastSwap;
    if (!swapsCount || first == 0) {
        return;
    }
    for (std::size_t rank = 1; rank < arrivals.size(); ++rank) {
        const std::int64_t after = arrivals[rank].lastSwap - first;
        ranks_[rank].swapUs.add(static_cast<double>(after) * 1e-3);
        lastSwapsUs_.push_back(static_cast<std::uint32_t>(after / 1000));
    }
}

void RankStatistics::addOdd(std::span<const int> ranks) {
    for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
        const bool odd = std::find(ranks.begin(), ranks.end(), static_cast<int>(rank)) != ranks.end();
        ++(odd ? ranks_[rank].differed : ranks_[rank].agreed);
    }
}

void RankStatistics::addHealed(std::span<const int> ranks) {
    for (const int rank : ranks) {
        ++ranks_[static_cast<std::size_t>(rank)].healed;
        healedNow_.push_back(rank);
    }
}

std::optional<Drag> RankStatistics::drag() const {
    std::vector<Waits> waits;
    for (const Rank& rank : ranks_) {
        const auto count = static_cast<double>(rank.keptMs.count());
        waits.push_back({count, count * rank.keptMs.mean()});
    }
    return standsOut(waits, static_cast<double>(frames_));
}

std::optional<Drag> RankStatistics::recentDrag() const {
    std::vector<Waits> waits(ranks_.size());
    for (const LastToCome& last : recent_) {
        waits[static_cast<std::size_t>(last.rank)].count += last.byMs > 0 ? 1 : 0;
        waits[static_cast<std::size_t>(last.rank)].ms += last.byMs;
    }
    return standsOut(waits, static_cast<double>(recent_.size()));
}

}  // namespace lockstep
