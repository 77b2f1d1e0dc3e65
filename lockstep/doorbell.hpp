// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

namespace lockstep {

/// A number in shared memory by which threads wake each other, also across processes. Each ring adds 1 to the number.
///
/// Any number of processes and threads may ring and sleep. No ring is lost if a thread first reads the number and then
/// looks for a message. If the bell has rung in between, sleep() returns at once. Uses a futex of Linux.
class Doorbell {
public:
    /// `rings` must outlive the doorbell.
    explicit Doorbell(std::atomic<std::uint32_t>& rings) : rings_(&rings) {}

    void ring() const;
    [[nodiscard]] std::uint32_t rings() const { return rings_->load(std::memory_order_acquire); }
    /// Sleeps until `limit` [ns] has passed or the number differs from `heard`. Returns whether it differs. May wake
    /// early.
    bool sleep(std::uint32_t heard, std::int64_t limit) const;

private:
    std::atomic<std::uint32_t>* rings_;
};

/// Doorbells of the ranks on this host.
///
/// MPI can only be polled for a message, and a dozen ranks that poll on two cores take a fifth of both cores. Between
/// ranks of one host, the sender therefore rings after its message, and the receiver sleeps until the ring. A rank on
/// another host has no bell here. A rank that is alone on its host, or finds no room in memory, has no bell either.
///
/// The bells are in the system's shared memory and not in an MPI window. Open MPI 4.1 crashes with a window if the
/// ranks of a host communicate over TCP.
class HostBells {
public:
    /// Opens the shared memory of this host. Collective.
    HostBells();
    ~HostBells();
    HostBells(const HostBells&) = delete;
    HostBells& operator=(const HostBells&) = delete;

    /// Returns the bell of rank `rank` of MPI_COMM_WORLD; nullopt if the rank has no bell here.
    [[nodiscard]] std::optional<Doorbell> of(int rank) const { return bells_.at(static_cast<std::size_t>(rank)); }

private:
    struct Slot;
    void release();

    std::vector<std::optional<Doorbell>> bells_;  // by rank
    Slot* slots_ = nullptr;                       // by rank, in the shared memory of this host
};

}  // namespace lockstep
