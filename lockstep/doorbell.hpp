// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

namespace lockstep {

/// Wakes whoever sleeps, in another process too: a number in memory that both have, which every ring counts up.
///
/// Any number of processes and threads may ring and sleep. Nothing is lost: whoever has looked at the number before it
/// looked for a message does not sleep when it rang in between. Of Linux: a futex.
class Doorbell {
public:
    /// `rings` must outlive it.
    explicit Doorbell(std::atomic<std::uint32_t>& rings) : rings_(&rings) {}

    void ring() const;
    [[nodiscard]] std::uint32_t rings() const { return rings_->load(std::memory_order_acquire); }
    /// Sleeps until `limit` [ns] has passed, or the number is another than `heard`; says whether it is. May wake early.
    bool sleep(std::uint32_t heard, std::int64_t limit) const;

private:
    std::atomic<std::uint32_t>* rings_;
};

/// A bell for every rank of this host.
///
/// MPI can only be asked whether a message is there, and a dozen ranks that ask on two cores take a fifth of both.
/// Between ranks of one host whoever sends rings behind its message, and whoever waits sleeps until then. Ranks of
/// other hosts have no bell here, nor has a rank that is alone on its host, nor any where there is no room in memory.
///
/// The memory is the system's and not an MPI window: Open MPI 4.1 dies of one where the ranks of a host talk over TCP.
class HostBells {
public:
    /// Collective.
    HostBells();
    ~HostBells();
    HostBells(const HostBells&) = delete;
    HostBells& operator=(const HostBells&) = delete;

    /// That of a rank of MPI_COMM_WORLD; nothing where it has none here.
    [[nodiscard]] std::optional<Doorbell> of(int rank) const { return bells_.at(static_cast<std::size_t>(rank)); }

private:
    struct Slot;
    void release();

    std::vector<std::optional<Doorbell>> bells_;  // by rank
    Slot* slots_ = nullptr;                       // by rank, of this host
};

}  // namespace lockstep
