// SPDX-License-Identifier: Apache-2.0
#include "lockstep/fault.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <iterator>
#include <thread>

namespace lockstep {

FaultsOfRank::FaultsOfRank(const std::vector<Fault>& all, int rank) {
    std::copy_if(all.begin(), all.end(), std::back_inserter(faults_),
                 [rank](const Fault& fault) { return fault.rank == rank; });
}

void FaultsOfRank::strike(std::uint64_t frame, sand::Replica& replica) const {
    for (const Fault& fault : faults_) {
        if (fault.frame != frame) {
            continue;
        }
        if (fault.kind == Fault::Kind::die) {
            std::raise(fault.signal);
        } else if (fault.kind == Fault::Kind::diverge) {
            replica.corrupt(fault.column, fault.row, fault.bit);
        } else if (fault.kind == Fault::Kind::movement) {
            replica.corruptMovement(fault.column, fault.row);
        }
        while (fault.kind == Fault::Kind::hang) {
            std::this_thread::sleep_for(std::chrono::hours(1));
        }
    }
}

void FaultsOfRank::delay(std::uint64_t frame) const {
    for (const Fault& fault : faults_) {
        const bool slow = fault.kind == Fault::Kind::slow && frame >= fault.frame && frame - fault.frame < fault.frames;
        if (slow || (fault.kind == Fault::Kind::partition && frame == fault.frame)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(fault.milliseconds));
        }
    }
}

bool FaultsOfRank::any(Fault::Kind kind, std::uint64_t frame) const {
    return std::any_of(faults_.begin(), faults_.end(),
                       [&](const Fault& fault) { return fault.kind == kind && fault.frame == frame; });
}

bool FaultsOfRank::garbles(std::uint64_t frame) const { return any(Fault::Kind::garbage, frame); }

bool FaultsOfRank::movesView(std::uint64_t frame) const { return any(Fault::Kind::view, frame); }

bool FaultsOfRank::spoilsShader() const { return any(Fault::Kind::shader, 0); }

}  // namespace lockstep
