// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/connection_limits.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace haptic_bridge {
namespace {

void refill(double& allowed, std::int64_t& countedNs, std::int64_t nowNs) {
    const double seconds = static_cast<double>(std::max<std::int64_t>(0, nowNs - countedNs)) * 1e-9;
    allowed = std::min(ConnectionLimits::kBurst, allowed + seconds * ConnectionLimits::kPerSecond);
    countedNs = nowNs;
}

}  // namespace

boost::asio::ip::address countedAddress(const boost::asio::ip::address& address) {
    if (address.is_v4()) {
        return address;
    }
    if (address.to_v6().is_v4_mapped()) {
        return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, address.to_v6());
    }
    auto bytes = address.to_v6().to_bytes();
    std::fill(bytes.begin() + 8, bytes.end(), std::uint8_t{0});
    return boost::asio::ip::address_v6(bytes);
}

ConnectionLimits::Visits& ConnectionLimits::visitsOf(const boost::asio::ip::address& from, std::int64_t nowNs) {
    const auto address = countedAddress(from);
    if (!visits_.contains(address) && visits_.size() >= kAddresses) {
        std::erase_if(visits_, [nowNs](const auto& entry) {
            Visits visits = entry.second;
            refill(visits.allowed, visits.countedNs, nowNs);
            return visits.allowed >= kBurst;  // as an address that has never connected
        });
    }
    const bool kept = visits_.contains(address) || visits_.size() < kAddresses;
    Visits& visits = kept ? visits_.try_emplace(address, Visits{kBurst, nowNs}).first->second : others_;
    refill(visits.allowed, visits.countedNs, nowNs);
    return visits;
}

bool ConnectionLimits::mayCome(const boost::asio::ip::address& address, std::int64_t nowNs) {
    Visits& visits = visitsOf(address, nowNs);
    if (visits.allowed < 1) {
        return false;
    }
    visits.allowed -= 1;
    return true;
}

void ConnectionLimits::refused(const boost::asio::ip::address& address, std::int64_t nowNs) {
    Visits& visits = visitsOf(address, nowNs);
    visits.allowed = std::max(kDeepest, visits.allowed - kPenalty);
}

std::optional<std::string> RefusalLog::add(RefusalCode code, const std::string& address, const std::string& line,
                                           std::int64_t nowNs) {
    count(code);
    std::pair key{address, code};
    if (!printed_.contains(key) && printed_.size() >= kRemembered) {
        std::erase_if(printed_, [nowNs](const auto& entry) { return nowNs - entry.second.ns >= kQuietNs; });
        if (printed_.size() >= kRemembered) {
            key = {"", code};
        }
    }
    const auto [printed, first] = printed_.try_emplace(key, Printed{nowNs, 0});
    if (!first && nowNs - printed->second.ns < kQuietNs) {
        ++printed->second.more;
        return std::nullopt;
    }
    const std::uint64_t more = printed->second.more;
    printed->second = {nowNs, 0};
    return more == 0 ? line : fmt::format("{} (and {} more of this kind since the last such line)", line, more);
}

void Gate::refused(RefusalCode code, const boost::asio::ip::address& address, const std::string& line,
                   std::int64_t nowNs) {
    if (code != RefusalCode::limit && code != RefusalCode::busy) {
        limits_.refused(address, nowNs);
    }
    if (line.empty()) {
        refusals_.count(code);
    } else if (const auto text =
                   refusals_.add(code, countedAddress(address).to_string(), address.to_string() + ": " + line, nowNs)) {
        log_(*text);
    }
}

}  // namespace haptic_bridge
