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
#include "haptic_bridge/server/guest_limits.hpp"

namespace haptic_bridge {

inline constexpr std::size_t kMaxGuests = 16;  // connections that have not been welcomed yet
inline constexpr int kMaxGuestsOfOne = 4;      // of those, from one address beyond this machine
inline constexpr std::size_t kMaxWatchers = 8;
inline constexpr int kMaxConnections = 64;  // of all kinds, those included that are being closed

/// Who is connected: guests that have not been welcomed, at most one master, and watchers. `Member` is Peer; tests have
/// members without sockets. One thread.
template <class Member>
class Roster {
public:
    using Pointer = std::shared_ptr<Member>;

    /// Whether there is a place for one more from this address.
    [[nodiscard]] bool hasRoomFor(const boost::asio::ip::address& address) const {
        const auto same = std::count_if(guests_.begin(), guests_.end(), [guest = guestOf(address)](const auto& one) {
            return guestOf(one->address()) == guest;
        });
        return (same < kMaxGuestsOfOne || isLoopback(address)) && *connections_ < kMaxConnections;
    }
    /// A connection begins as a guest. Closes the oldest guest when there are too many.
    void add(Pointer guest) {
        if (guests_.size() >= kMaxGuests) {
            // Not the newcomer: sixteen who say nothing would keep out the master. A greeting takes milliseconds.
            Pointer(guests_.front())->makeRoom();
        }
        guests_.push_back(std::move(guest));
    }
    /// A guest becomes the master; returns the number of its session.
    std::uint32_t promoteToMaster(const Pointer& guest) {
        removeGuest(*guest);
        master_ = guest;
        return ++sessions_;
    }
    void promoteToWatcher(const Pointer& guest) {
        removeGuest(*guest);
        watchers_.insert(guest);
    }
    /// Forgets a member that ends. Returns whether it was the master.
    bool remove(const Pointer& member) {
        removeGuest(*member);
        watchers_.erase(member);
        const bool wasMaster = master_ == member;
        master_ = wasMaster ? nullptr : master_;
        return wasMaster;
    }

    [[nodiscard]] const Pointer& master() const { return master_; }
    [[nodiscard]] bool watchersAreFull() const { return watchers_.size() >= kMaxWatchers; }
    // Copies, because a member may leave while it is spoken to.
    [[nodiscard]] std::vector<Pointer> guests() const { return {guests_.begin(), guests_.end()}; }
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
    void removeGuest(const Member& guest) {
        std::erase_if(guests_, [&](const auto& one) { return one.get() == &guest; });
    }

    std::list<Pointer> guests_;  // the oldest first
    Pointer master_;
    std::set<Pointer> watchers_;
    std::shared_ptr<int> connections_ = std::make_shared<int>(0);  // those included that are being closed
    std::uint32_t sessions_ = 0;
};

}  // namespace haptic_bridge
