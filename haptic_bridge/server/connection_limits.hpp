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

/// Returns the address by which unauthenticated connections are counted. This is an IPv4 address, also if it is mapped
/// into IPv6, or the /64 network of an IPv6 address. One machine may use every address of such a network.
[[nodiscard]] boost::asio::ip::address countedAddress(const boost::asio::ip::address& address);

/// Limits how often connections may come from one address, as countedAddress() returns it: kBurst at once, then
/// kPerSecond. An address that was refused must wait longer. The caller passes the time.
class ConnectionLimits {
public:
    static constexpr double kBurst = 16, kPerSecond = 8;
    static constexpr double kPenalty = 1;    // a refusal counts as this many further connections
    static constexpr double kDeepest = -16;  // lowest allowance, so that no address waits longer than about two seconds
    static constexpr std::size_t kAddresses = 1024;  // [address] counted separately; further addresses share one count

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

/// Counts refusals by kind, and gives at most one line per minute for each peer and kind.
class RefusalLog {
public:
    static constexpr std::int64_t kQuietNs = 60'000'000'000;
    // [pair of peer and kind]; further peers share one line per minute and kind.
    static constexpr std::size_t kRemembered = 1024;

    /// Counts a refusal and returns the line to print. Returns nullopt if this peer and kind had a line in the last
    /// minute. The next line then ends with the number of lines that were left out.
    [[nodiscard]] std::optional<std::string> add(RefusalCode code, const std::string& address, const std::string& line,
                                                 std::int64_t nowNs);
    void count(RefusalCode code) { ++counts_[static_cast<std::size_t>(code) - 1]; }
    [[nodiscard]] const RefusalCounts& counts() const { return counts_; }

private:
    struct Printed {
        std::int64_t ns = 0;
        std::uint64_t more = 0;
    };
    RefusalCounts counts_{};
    std::map<std::pair<std::string, RefusalCode>, Printed> printed_;
};

/// Admits unauthenticated connections as often as ConnectionLimits allows, and logs refusals with the reason. `log`
/// gets lines for the user.
class Gate {
public:
    explicit Gate(std::function<void(const std::string&)> log) : log_(std::move(log)) {}
    [[nodiscard]] bool mayCome(const boost::asio::ip::address& address, std::int64_t nowNs) {
        return limits_.mayCome(address, nowNs);
    }
    /// Counts a refusal, and logs `line` unless it is empty. An address that was refused may connect less often.
    void refused(RefusalCode code, const boost::asio::ip::address& address, const std::string& line,
                 std::int64_t nowNs);
    [[nodiscard]] const RefusalCounts& counts() const { return refusals_.counts(); }

private:
    std::function<void(const std::string&)> log_;
    ConnectionLimits limits_;
    RefusalLog refusals_;
};

}  // namespace haptic_bridge
