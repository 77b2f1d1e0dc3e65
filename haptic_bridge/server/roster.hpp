// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <list>
#include <memory>
#include <set>
#include <vector>

#include "haptic_bridge/link/link_options.hpp"
#include "haptic_bridge/server/connection_limits.hpp"

namespace haptic_bridge {

inline constexpr std::size_t kMaxUnauthenticated = 16;  // unauthenticated connections
inline constexpr int kMaxUnauthenticatedOfOne = 4;      // of these, from one address of another machine
inline constexpr std::size_t kMaxWatchers = 8;
inline constexpr int kMaxConnections = 64;  // of all kinds, also connections that are being closed

/// All connections: unauthenticated ones, at most one master, and watchers. `Member` is Peer; tests use members without
/// sockets. Used by one thread.
template <class Member>
class Roster {
public:
    using Pointer = std::shared_ptr<Member>;

    /// Returns whether one more connection from this address has a place.
    [[nodiscard]] bool hasRoomFor(const boost::asio::ip::address& address) const {
        const auto same = std::count_if(
            unauthenticated_.begin(), unauthenticated_.end(),
            [from = countedAddress(address)](const auto& one) { return countedAddress(one->address()) == from; });
        return (same < kMaxUnauthenticatedOfOne || isLoopback(address)) && *connections_ < kMaxConnections;
    }
    /// Adds a connection, which is unauthenticated at first. If there are too many of these, closes the oldest.
    void add(Pointer connection) {
        if (unauthenticated_.size() >= kMaxUnauthenticated) {
            // The oldest is closed and not the newest, because sixteen silent connections would keep the master out. A
            // greeting takes milliseconds.
            Pointer(unauthenticated_.front())->makeRoom();
        }
        unauthenticated_.push_back(std::move(connection));
    }
    /// Makes an unauthenticated connection the master. Returns the number of its session.
    std::uint32_t promoteToMaster(const Pointer& connection) {
        removeUnauthenticated(*connection);
        master_ = connection;
        return ++sessions_;
    }
    /// Makes an unauthenticated connection a watcher.
    void promoteToWatcher(const Pointer& connection) {
        removeUnauthenticated(*connection);
        watchers_.insert(connection);
    }
    /// Removes a member that ends. Returns whether it was the master.
    bool remove(const Pointer& member) {
        removeUnauthenticated(*member);
        watchers_.erase(member);
        const bool wasMaster = master_ == member;
        master_ = wasMaster ? nullptr : master_;
        return wasMaster;
    }

    [[nodiscard]] const Pointer& master() const { return master_; }
    [[nodiscard]] bool watchersAreFull() const { return watchers_.size() >= kMaxWatchers; }
    // These return copies, because a member may leave while the caller uses it.
    [[nodiscard]] std::vector<Pointer> unauthenticated() const {
        return {unauthenticated_.begin(), unauthenticated_.end()};
    }
    [[nodiscard]] std::vector<Pointer> watchers() const { return {watchers_.begin(), watchers_.end()}; }

    /// Counts `thing` among the connections for as long as it lives.
    template <class Thing>
    [[nodiscard]] std::shared_ptr<Thing> counted(std::unique_ptr<Thing> thing) {
        ++*connections_;
        return {thing.release(), [count = connections_](Thing* gone) {
                    delete gone;
                    --*count;
                }};
    }
    [[nodiscard]] int connections() const { return *connections_; }

private:
    void removeUnauthenticated(const Member& connection) {
        std::erase_if(unauthenticated_, [&](const auto& one) { return one.get() == &connection; });
    }

    std::list<Pointer> unauthenticated_;  // unauthenticated connections, oldest first
    Pointer master_;
    std::set<Pointer> watchers_;
    std::shared_ptr<int> connections_ = std::make_shared<int>(0);  // also connections that are being closed
    std::uint32_t sessions_ = 0;
};

}  // namespace haptic_bridge
