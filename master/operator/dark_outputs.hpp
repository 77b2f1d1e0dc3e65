// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/monitor_state.hpp"
#include "lockstep/arrival.hpp"
#include "walls/wall.hpp"

namespace master {

/// An output that was dark in this session, as summary.json has it.
struct DarkOutput {
    std::string output, tile, monitor;
    std::int32_t rank = 0;
    std::uint64_t times = 0;  // times that it became dark
    double seconds = 0;       // [s], for which it was dark
    bool atEnd = false;       // whether it is dark now

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("output", it.output);
        visit("tile", it.tile);
        visit("rank", it.rank);
        visit("monitor", it.monitor);
        visit("times", it.times);
        visit("seconds", it.seconds);
        visit("at_end", it.atEnd);
    }
};

/// Keeps which outputs of the wall no monitor shows, from what the ranks report at the barrier. Prints a line and emits
/// the event `monitor` when that changes. An output is dark while its monitor is off, or has another size. Main thread
/// only.
class DarkOutputs {
public:
    /// `rankNames` are the names of the ranks in messages, the master's first.
    DarkOutputs(const walls::Wall& wall, std::vector<std::string> rankNames);

    /// Adds the arrivals at one barrier, in order of rank, the master's first. `nowNs` is the time of the steady clock.
    void add(const std::vector<lockstep::Arrival>& arrivals, std::int64_t nowNs /* [ns] */);

    /// Returns the ranks that have a dark output now, in order.
    [[nodiscard]] std::vector<std::uint32_t> ranks() const;
    /// Returns the names of the outputs that are dark now, in order of rank.
    [[nodiscard]] std::vector<std::string> names() const;
    /// Returns the outputs that were dark at any time, in order of rank, as of the last add().
    [[nodiscard]] std::vector<DarkOutput> history() const;

private:
    struct Output {
        DarkOutput kept;
        glm::ivec2 pixels{1};  // [pixel]
        base::MonitorState state = base::MonitorState::on;
        double lastSeconds = 0;  // [s], of the last time that it was dark
    };
    void change(Output& output, base::MonitorState state) const;

    std::vector<std::string> rankNames_;
    std::vector<std::vector<Output>> outputs_;  // of each tile, in order of rank from 1
    std::int64_t lastNs_ = 0;                   // [ns], of the last add()
};

}  // namespace master
