// SPDX-License-Identifier: Apache-2.0
// A master and three render ranks meet at the barrier of some frames. In some frames one of them does something wrong.
// The master prints a line for each frame: the verdict, the rank that sent nonsense and its bytes, and the arrivals.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "lockstep/frame_barrier.hpp"
#include "lockstep/session_message.hpp"

namespace {

using lockstep::Arrival;
using lockstep::Verdict;

constexpr double kLimit = 60;  // [s], limit after which a missing rank ends the job
const std::vector<std::string> kNames{"the master", "rank 1", "rank 2", "rank 3"};

/// Returns the FNV-1a hash of a message, which shows the message that a rank has received.
std::uint64_t hashOf(const base::Bytes& bytes) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const std::uint8_t byte : bytes) {
        hash = (hash ^ byte) * 0x100000001b3U;
    }
    return hash;
}

/// Returns a frame message of exactly this many bytes.
lockstep::FrameMessage messageOf(std::uint64_t frame, std::size_t bytes) {
    lockstep::FrameMessage message;
    message.frame = frame;
    message.steps.push_back({1, frame, true, {}, sand::Edit::loaded(base::Bytes(bytes, 7))});
    for (std::size_t sand = bytes; base::encoded(message).size() > bytes && sand > 0;) {
        message.steps.front().edit = sand::Edit::loaded(base::Bytes(--sand, 7));
    }
    return message;
}

/// Something wrong that one rank does in a frame, instead of its usual arrival.
struct Deed {
    std::uint64_t frame = 0;
    int rank = 0;
    enum Kind { otherSand, otherView, oldFrame, garbage, late } kind = otherSand;
};
const std::vector<Deed> kDeeds{{2, 3, Deed::otherSand}, {3, 2, Deed::otherView}, {4, 1, Deed::otherView},
                               {4, 3, Deed::otherSand}, {5, 0, Deed::otherSand}, {6, 1, Deed::oldFrame},
                               {7, 1, Deed::late},      {30, 2, Deed::garbage},  {31, 2, Deed::garbage},
                               {32, 2, Deed::garbage}};

std::string nameOf(Verdict verdict) {
    return verdict == Verdict::equal       ? "equal"
           : verdict == Verdict::otherSand ? "other sand"
           : verdict == Verdict::otherView ? "other view"
                                           : "nonsense";
}

class Rank {
public:
    explicit Rank(const lockstep::Cluster& cluster) : cluster_(cluster), barrier_(cluster, kNames, kLimit) {}

    /// Shows frame `frame` with a message of `bytes` bytes. Returns the master's line about it; an empty text on other
    /// ranks.
    std::string meet(std::uint64_t frame, std::size_t bytes) {
        std::size_t got = 0;
        const bool master = cluster_.isMaster();
        const lockstep::FrameMessage message =
            barrier_.begin(master ? messageOf(frame, bytes) : lockstep::FrameMessage{}, got);
        // The message's hash stands for the sand. A rank that has received another message therefore differs.
        Arrival mine{message.frame, 1, 2, 100 + cluster_.rank(), hashOf(base::encoded(message)), 5, {'q'}};
        for (const Deed& deed : kDeeds) {
            if (deed.frame == frame && deed.rank == cluster_.rank()) {
                act(deed.kind, mine);
            }
        }
        const Verdict verdict = barrier_.meet(mine);
        const auto all = barrier_.collect({static_cast<std::uint8_t>(verdict)});
        if (!master) {
            return {};
        }
        std::string line = fmt::format("{}: {}", frame, nameOf(verdict));
        for (const auto& one : barrier_.nonsense()) {
            line += fmt::format(" of rank {} ({})", one.rank, one.line);
        }
        std::vector<std::int64_t> drawn;
        for (std::size_t rank = 1; rank < all.size(); ++rank) {
            drawn.push_back(barrier_.arrivals()[rank].drawn);
            line += all[rank] == all[0] ? "" : fmt::format(", and rank {} got another verdict", rank);
        }
        return line + fmt::format("; arrivals {}", fmt::join(drawn, " "));
    }

    /// Sends bytes to the master, from one rank to two, and to all ranks.
    std::string hand() {
        const auto rank = static_cast<std::uint8_t>(cluster_.rank());
        std::string line = "collected";
        for (const base::Bytes& bytes : barrier_.collect(base::Bytes(std::size_t{1000} * rank + 1, rank))) {
            line += fmt::format(" {}x{}", bytes.size(), bytes.back());
        }
        const base::Bytes passed = barrier_.pass(2, {1, 3}, base::Bytes(rank == 2 ? 5 : 0, 9));
        const base::Bytes received = barrier_.broadcast(base::Bytes(cluster_.isMaster() ? 7 : 0, 4));
        line += "; passed and told";
        for (const base::Bytes& one :
             barrier_.collect({static_cast<std::uint8_t>(passed.size()), static_cast<std::uint8_t>(received.size())})) {
            line += fmt::format(" {}+{}", one[0], one[1]);
        }
        return line;
    }

    /// Returns all numbers of the reports, in order of rank.
    std::string report() {
        const auto rank = cluster_.rank();
        const double base = 100 * rank;
        lockstep::RankReport mine{fmt::format("host {}", rank),
                                  "renderer",
                                  "lock",
                                  base + 1,
                                  base + 2,
                                  base + 3,
                                  base + 4,
                                  base + 5,
                                  6,
                                  7,
                                  8,
                                  9,
                                  10,
                                  base + 11};
        std::string line = "reports";
        for (const lockstep::RankReport& one : lockstep::gatherReports(barrier_, mine)) {
            line +=
                fmt::format(" [{}, {}, {}, {} {} {} {} {} {} {} {} {} {} {}]", one.host, one.renderer, one.swapLock,
                            one.drawP50, one.drawP99, one.drawMax, one.waitP50, one.waitP99, one.residentBytes,
                            one.frameBufferBytes, one.viewsSkipped, one.viewsInPart, one.viewsWhole, one.pixelShare);
        }
        return line;
    }

private:
    void act(Deed::Kind kind, Arrival& mine) {
        switch (kind) {
            case Deed::otherSand:
                mine.stateHash ^= 1;
                break;
            case Deed::otherView:
                mine.viewHash ^= 1;
                break;
            case Deed::oldFrame:
                --mine.frame;
                break;
            case Deed::garbage:
                barrier_.garble();
                break;
            case Deed::late:  // after all others
                std::this_thread::sleep_for(std::chrono::milliseconds(200));
                break;
        }
    }

    const lockstep::Cluster& cluster_;
    lockstep::FrameBarrier barrier_;
};

void say(const lockstep::Cluster& cluster, const std::string& line) {
    if (cluster.isMaster()) {
        fmt::print("{}\n", line);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const lockstep::Cluster cluster(&argc, &argv);
    const std::string who = fmt::format("of rank {}", cluster.rank());
    std::string ready = "ready";
    for (const lockstep::Readiness& one :
         lockstep::gatherReadiness(cluster, {"host " + who,
                                             "build",
                                             "error " + who,
                                             "renderer",
                                             {"a", "b " + who},
                                             7U + static_cast<unsigned>(cluster.rank())})) {
        ready += fmt::format(" [{}, {}, {}, {}, {}, {}]", one.host, one.buildId, one.error, one.renderer,
                             fmt::join(one.shortcomings, "+"), one.framesToIgnore);
    }
    say(cluster, ready);
    Rank rank(cluster);
    constexpr std::size_t kShort = 400;
    for (std::uint64_t frame = 1; frame <= 8; ++frame) {
        say(cluster, rank.meet(frame, kShort));
    }
    // Lengths around kOneMessage. The rest of a longer message follows in a second one.
    constexpr std::size_t kWhole = lockstep::FrameBarrier::kOneMessage - sizeof(std::uint32_t);
    std::uint64_t frame = 9;
    for (const std::size_t bytes : {kWhole - 1, kWhole, kWhole + 1, kWhole, 3 * kWhole, kShort}) {
        say(cluster, rank.meet(frame++, bytes));
    }
    for (frame = 30; frame <= 33; ++frame) {
        say(cluster, rank.meet(frame, kShort));
    }
    say(cluster, rank.hand());
    say(cluster, rank.report());
    return 0;
}
