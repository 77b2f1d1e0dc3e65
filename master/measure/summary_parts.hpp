// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "haptic_bridge/link/report.hpp"
#include "lockstep/rank_statistics.hpp"
#include "lockstep/session_message.hpp"
#include "lockstep/statistics.hpp"
#include "sand/replica.hpp"

/// Parts of summary.json that are computed from several values. They are described (base/fields.hpp), and only written.
namespace master {

/// Spread of a series.
struct Spread {
    const lockstep::Statistics& series;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("p50", it.series.percentile(0.5));
        visit("p99", it.series.percentile(0.99));
        visit("max", it.series.largest());
    }
};

/// Distribution of a series.
struct Distribution {
    const lockstep::Statistics& series;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("mean", it.series.mean());
        visit("stddev", it.series.deviation());
        visit("p50", it.series.percentile(0.5));
        visit("p99", it.series.percentile(0.99));
    }
};

/// A rank that keeps the wall waiting, as summary.json and `ctl status` contain it.
struct SlowestRank {
    lockstep::Drag drag;
    std::string name;  // in messages
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        lockstep::Drag::fields(it.drag, visit);
        visit("name", it.name);
    }
};

/// Returns the rank that keeps the wall waiting; nullopt if no rank stands out. `rankNames` are the names in messages.
[[nodiscard]] std::optional<SlowestRank> slowestRank(const std::optional<lockstep::Drag>& drag,
                                                     const std::vector<std::string>& rankNames);

/// The first press since the last start that was refused, as summary.json contains it.
struct RefusedPressPart {
    std::string shape;
    double radius = 0;              // [scene unit], of the tool
    std::optional<double> largest;  // [scene unit], sand::RefusedPress::largest
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("tool_shape", it.shape);
        visit("tool_radius", it.radius);
        visit("largest_radius", it.largest);
    }
};

/// Returns the first press of `replica` that was refused. Requires that there is one.
[[nodiscard]] RefusedPressPart refusedPressOf(const sand::Replica& replica);
/// Returns a sentence for the user.
[[nodiscard]] std::string describe(const RefusedPressPart& press);

/// Returns a state hash as programs print it.
[[nodiscard]] std::string hashText(std::uint64_t hash);

/// An element of `per_rank`.
struct RankPart {
    std::size_t number;  // 1 is the first render rank
    const std::string& tile;
    const lockstep::RankReport& report;
    const lockstep::RankStatistics::Rank& seen;
    std::uint64_t frames;  // since the last start
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("rank", it.number);
        visit("tile", it.tile);
        lockstep::RankReport::fields(it.report, visit);
        const std::size_t last = it.seen.keptMs.count();
        visit("slowest/frames", last);
        visit("slowest/share", it.frames == 0 ? 0.0 : static_cast<double>(last) / static_cast<double>(it.frames));
        visit("slowest/wall_waited_ms", Spread{it.seen.keptMs});
        visit("swap_us", Spread{it.seen.swapUs});
        visit("frames_agreed", it.seen.agreed);
        visit("frames_differed", it.seen.differed);
        visit("healed", it.seen.healed);
    }
};

/// The part of `haptic` that a haptic server has reported.
struct ReportPart {
    const haptic_bridge::Report& report;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        const auto printed = [&visit](std::string_view name, const auto& member) {
            // The period of the force loop has a key of its own. `steps` and `audited` are for the master alone.
            if (!name.starts_with("haptic_period_us/") && name != "steps" && name != "audited") {
                visit(name, member);
            }
        };
        haptic_bridge::Report::fields(it.report, printed);
        visit("steps_withheld", haptic_bridge::inAll(it.report.stepsWithheld));
    }
};

}  // namespace master
