// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "lockstep/divergence.hpp"
#include "lockstep/frame_barrier.hpp"
#include "lockstep/healing.hpp"

namespace master {

/// All ranks of a wall at the end of a frame, seen from the master. Main thread only.
class Ranks {
public:
    virtual ~Ranks() = default;
    /// The next three functions do what the functions of the same names in lockstep/ do at the master.
    [[nodiscard]] virtual lockstep::Verdict meet(const lockstep::Arrival& mine, std::int64_t nextFrame) = 0;
    [[nodiscard]] virtual lockstep::Divergence findDivergence(sand::Replica& sand,
                                                              const lockstep::Arbiter& arbiter) = 0;
    [[nodiscard]] virtual lockstep::Healing heal(sand::Replica& sand, const lockstep::Remedy& remedy) = 0;
    /// Both return what arrived at the last meet(). Arrivals are in order of rank, the master's own first.
    [[nodiscard]] virtual const std::vector<lockstep::Arrival>& arrivals() const = 0;
    [[nodiscard]] virtual const std::vector<lockstep::FrameBarrier::Nonsense>& nonsense() const = 0;
};

/// The ranks of an MPI job.
class BarrierRanks : public Ranks {
public:
    explicit BarrierRanks(lockstep::FrameBarrier& barrier) : barrier_(barrier) {}

    lockstep::Verdict meet(const lockstep::Arrival& mine, std::int64_t nextFrame) override {
        return barrier_.meet(mine, nextFrame);
    }
    lockstep::Divergence findDivergence(sand::Replica& sand, const lockstep::Arbiter& arbiter) override {
        const auto watched = [&] {
            const lockstep::Busy busy(barrier_, "the sand of its journal");
            return arbiter.sand();
        };
        return *lockstep::findDivergence(barrier_, sand, {watched, arbiter.overrules});
    }
    lockstep::Healing heal(sand::Replica& sand, const lockstep::Remedy& remedy) override {
        return lockstep::heal(barrier_, sand, remedy);
    }
    [[nodiscard]] const std::vector<lockstep::Arrival>& arrivals() const override { return barrier_.arrivals(); }
    [[nodiscard]] const std::vector<lockstep::FrameBarrier::Nonsense>& nonsense() const override {
        return barrier_.nonsense();
    }

private:
    lockstep::FrameBarrier& barrier_;
};

}  // namespace master
