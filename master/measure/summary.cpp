// SPDX-License-Identifier: Apache-2.0
#include "master/measure/summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/json_fields.hpp"
#include "host/whole_file.hpp"

namespace master {
namespace {

/// Returns "5 times (secret)" or "5 times (secret 4, busy 1)"; an empty text if all counts are 0.
std::string timesOf(const haptic_bridge::RefusalCounts& counts) {
    std::uint64_t all = 0;
    for (const std::uint64_t count : counts) {
        all += count;
    }
    std::string kinds;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] > 0) {
            kinds += fmt::format("{}{}", kinds.empty() ? "" : ", ", valuesOf(haptic_bridge::RefusalCode{})[i].name);
            kinds += counts[i] < all ? fmt::format(" {}", counts[i]) : "";
        }
    }
    return all == 0 ? "" : fmt::format("{} {} ({})", all, all == 1 ? "time" : "times", kinds);
}

/// Returns the line about refused connections; an empty text if there were no refusals.
std::string describeRefusals(const Summary& summary) {
    std::string text;
    const auto add = [&text](const char* what, const std::string& times) {
        if (!times.empty()) {
            text += fmt::format("{}{} {}", text.empty() ? "" : "; ", what, times);
        }
    };
    add("refused", timesOf(summary.incidents.refusedHere));
    add("refused the server", timesOf(summary.incidents.refused));
    add("the server refused connections",
        timesOf(summary.haptic ? summary.haptic->refused : haptic_bridge::RefusalCounts{}));
    if (text.empty()) {
        return {};
    }
    return fmt::format("  haptics   {}: {}\n", summary.incidents.links == 0 ? "no hand all session" : "beside links",
                       text);
}

/// Returns the line about steps of the hand that were not made; an empty text if all were made.
std::string describeWithheld(const haptic_bridge::WithheldCounts& counts) {
    using haptic_bridge::Withheld;
    const auto of = [&counts](Withheld cause) { return counts[static_cast<std::size_t>(cause)]; };
    std::string text;
    if (of(Withheld::wall) > 0) {
        text = fmt::format(
            "  hand      the wall was too slow for {} steps of the hand, so strokes may have gaps; with --pace fast a "
            "recorded hand waits for the wall\n",
            of(Withheld::wall));
    }
    if (of(Withheld::disk) > 0) {
        text += fmt::format("  hand      the full disk has held {} steps of the hand, so strokes may have gaps\n",
                            of(Withheld::disk));
    }
    return text;
}

/// Returns the line about the slowest rank; an empty text if no rank stands out.
std::string describeDrag(const Summary& summary) {
    if (!summary.drag) {
        return {};
    }
    const auto rank = static_cast<std::size_t>(summary.drag->rank);
    std::string drawing;
    if (rank >= 1 && rank <= summary.ranksReports.size()) {  // a render rank, because the master does not draw
        lockstep::Statistics others;
        for (std::size_t i = 0; i < summary.ranksReports.size(); ++i) {
            if (i + 1 != rank) {
                others.add(summary.ranksReports[i].drawP50);
            }
        }
        drawing = fmt::format(": draws in {:.1f} ms, the others in {:.1f} ms (p50)",
                              summary.ranksReports[rank - 1].drawP50, others.percentile(0.5));
    }
    return fmt::format("  slowest   {} in {:.0f} % of frames{}; the wall waited {:.1f} ms more for it\n",
                       summary.rankNames[rank], 100 * summary.drag->share, drawing, summary.drag->keptMs);
}

}  // namespace

RefusedPressPart refusedPressOf(const sand::Replica& replica) {
    const sand::RefusedPress& press = replica.firstRefusedPress().value();
    const double perProbe = replica.cellSize() / sand::kProbePerCell;
    RefusedPressPart part{std::string(base::nameOf(press.tool.kind)), press.tool.radius * perProbe, std::nullopt};
    if (press.largest) {
        part.largest = *press.largest * perProbe;
    }
    return part;
}

std::string describe(const RefusedPressPart& press) {
    // A TIN knows no largest radius.
    std::string text =
        fmt::format("the cells around the {} of radius {:.4g} cannot hold its sand, so the tool {}", press.shape,
                    press.radius, press.largest ? "digs less deep than the hand" : "passes through it");
    if (press.largest) {
        text += *press.largest > 0 ? fmt::format("; the largest {} that fits there has a radius of {:.4g}", press.shape,
                                                 *press.largest)
                                   : fmt::format("; no {} fits there", press.shape);
    }
    return text;
}

double Summary::framesPerSecond() const {
    const std::uint64_t shown = frames - framesBefore;
    return seconds > 0 ? static_cast<double>(shown - 1) / seconds : 0;
}

std::string describe(const Summary& summary) {
    std::string text = fmt::format(
        "{} on {}: {} steps in {} frames, {:.1f} fps, {} render ranks\n"
        "  sand      state hash {:016x}, {} divergences, {} healed, {}volume {} + outflow {} = {} at the start: {}\n"
        "  wall      swap skew p50 {:.0f} us, p99 {:.0f} us, max {:.0f} us; frame message p50 {:.0f} bytes\n",
        summary.scene, summary.wall, summary.steps, summary.frames, summary.framesPerSecond(), summary.ranks,
        summary.stateHash, summary.incidents.divergences, summary.incidents.healed,
        summary.incidents.outvoted == 0 ? "" : fmt::format("{} outvoted by the journal, ", summary.incidents.outvoted),
        summary.volumeFinal, summary.volumeOutflow, summary.volumeInitial, summary.exact() ? "exact" : "WRONG",
        summary.skewUs.percentile(0.5), summary.skewUs.percentile(0.99), summary.skewUs.largest(),
        summary.broadcastBytes.percentile(0.5));
    if (summary.latency.wholeWay.count() > 0) {
        text += fmt::format("  latency   hand to wall p50 {:.1f} ms, p99 {:.1f} ms\n",
                            summary.latency.wholeWay.percentile(0.5), summary.latency.wholeWay.percentile(0.99));
    }
    if (summary.haptic && summary.haptic->hapticPeriodUsMax > 0) {
        text += fmt::format(
            "  haptics   period p50 {:.0f} us, p99 {:.0f} us; force p99 {:.2f} us; half round trip {:.1f} ms, "
            "{:.1f} ms to the master\n",
            summary.haptic->hapticPeriodUsP50, summary.haptic->hapticPeriodUsP99, summary.haptic->forceUsP99,
            summary.haptic->toWall.msMean, summary.haptic->toMaster.msMean);
    }
    text += summary.haptic ? describeWithheld(summary.haptic->stepsWithheld) : "";
    text += describeRefusals(summary);
    double slowest = 0;
    std::int64_t memory = 0;
    for (const lockstep::RankReport& report : summary.ranksReports) {
        slowest = std::max(slowest, report.drawP50);
        memory = std::max(memory, report.residentBytes);
    }
    text += fmt::format("  ranks     slowest draws in {:.1f} ms (p50), largest holds {:.0f} MiB\n", slowest,
                        static_cast<double>(memory) / (1 << 20));
    return text + describeDrag(summary);
}

std::string hashText(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

std::optional<SlowestRank> slowestRank(const std::optional<lockstep::Drag>& drag,
                                       const std::vector<std::string>& rankNames) {
    return drag ? std::optional(SlowestRank{*drag, rankNames[static_cast<std::size_t>(drag->rank)]}) : std::nullopt;
}

std::optional<double> Summary::period(double haptic_bridge::Report::*value) const {
    return haptic && haptic->hapticPeriodUsMax > 0 ? std::optional((*haptic).*value) : std::nullopt;
}

std::vector<RankPart> Summary::rankParts() const {
    std::vector<RankPart> parts;
    for (std::size_t i = 0; i < ranksReports.size(); ++i) {
        parts.push_back({i + 1, tileNames[i], ranksReports[i], rankStatistics[i + 1], frames - framesBefore});
    }
    return parts;
}

void writeSummary(const Summary& summary, const std::filesystem::path& file) {
    host::WholeFile whole(file, host::WholeFile::Other::refused);
    // A server may have sent any bytes as the text of its refusal.
    whole.stream() << host::jsonOf(summary).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
                   << '\n';
    whole.keep();
}

}  // namespace master
