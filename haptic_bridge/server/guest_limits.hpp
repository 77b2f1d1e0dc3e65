// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/ip/address.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "haptic_bridge/link/protocol.hpp"

namespace haptic_bridge {

/// What counts as one guest: an IPv4 address, also one that is mapped into IPv6, or the /64 network of an IPv6 address,
/// of which one machine may have as many as it likes.
[[nodiscard]] boost::asio::ip::address guestOf(const boost::asio::ip::address& address);

/// How often somebody may come: kBurst times at once, then kPerSecond, by guestOf() an address; who is refused comes
/// later still. Knows no clock.
class GuestLimits {
public:
    static constexpr double kBurst = 16, kPerSecond = 8;
    static constexpr double kPenalty = 1;            // a refusal costs as much as so many more connections
    static constexpr double kDeepest = -16;          // and nobody waits for longer than two seconds
    static constexpr std::size_t kAddresses = 1024;  // that are kept apart; the rest shares one count

    [[nodiscard]] bool mayCome(const boost::asio::ip::address& address, std::int64_t nowNs);
    void refused(const boost::asio::ip::address& address, std::int64_t nowNs);

private:
    struct Visits {
        double allowed = kBurst;
        std::int64_t countedNs = 0;
    };
    [[nodiscard]] Visits& visitsOf(const boost::asio::ip::address& address, std::int64_t nowNs);

    std::map<boost::asio::ip::address, Visits> visits_;
    Visits others_;
};

/// Counts what was refused by kind, and says it once a minute at most for each peer and kind.
class RefusalLog {
public:
    static constexpr std::int64_t kQuietNs = 60'000'000'000;
    static constexpr std::size_t kRemembered = 1024;  // peers and kinds; of more it says one line a minute

    /// Nothing when it has been said already; how many were not said meanwhile stands behind `line`.
    [[nodiscard]] std::optional<std::string> add(RefusalCode code, const std::string& address, const std::string& line,
                                                 std::int64_t nowNs);
    void count(RefusalCode code) { ++counts_[static_cast<std::size_t>(code) - 1]; }
    [[nodiscard]] const RefusalCounts& counts() const { return counts_; }

private:
    struct Said {
        std::int64_t ns = 0;
        std::uint64_t more = 0;
    };
    RefusalCounts counts_{};
    std::map<std::pair<std::string, RefusalCode>, Said> said_;
};

/// Lets guests in as often as GuestLimits allows, and remembers who was refused and why. `log` gets lines for a person.
class Gate {
public:
    explicit Gate(std::function<void(const std::string&)> log) : log_(std::move(log)) {}
    [[nodiscard]] bool mayCome(const boost::asio::ip::address& address, std::int64_t nowNs) {
        return limits_.mayCome(address, nowNs);
    }
    /// Counts a refusal, and logs `line` unless it is empty. A guest that was refused may come less often.
    void refused(RefusalCode code, const boost::asio::ip::address& address, const std::string& line,
                 std::int64_t nowNs);
    [[nodiscard]] const RefusalCounts& counts() const { return refusals_.counts(); }

private:
    std::function<void(const std::string&)> log_;
    GuestLimits limits_;
    RefusalLog refusals_;
};

}  // namespace haptic_bridge
