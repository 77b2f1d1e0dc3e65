// SPDX-License-Identifier: Apache-2.0
#include "master/summary.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "host/whole_file.hpp"

namespace master {
namespace {

using nlohmann::ordered_json;

ordered_json spread(const lockstep::Statistics& figures) {
    return {{"p50", figures.percentile(0.5)}, {"p99", figures.percentile(0.99)}, {"max", figures.largest()}};
}

ordered_json distribution(const lockstep::Statistics& figures) {
    return {{"mean", figures.mean()},
            {"stddev", figures.deviation()},
            {"p50", figures.percentile(0.5)},
            {"p99", figures.percentile(0.99)}};
}

double framesPerSecond(const Summary& summary) {
    const std::uint64_t shown = summary.frames - summary.framesBefore;
    return summary.seconds > 0 ? static_cast<double>(shown - 1) / summary.seconds : 0;
}

ordered_json halfRoundTrip(const haptic_bridge::HalfRoundTrip& trip) {
    return {{"mean", trip.msMean},
            {"stddev", trip.msStddev},
            {"p50", trip.msP50},
            {"p99", trip.msP99},
            {"count", trip.count}};
}

ordered_json hapticPart(const Summary& summary) {
    ordered_json part = ordered_json::object();
    part["reconnects"] = summary.link.reconnects;
    part["hand_overs"] = {{"by_steps", summary.link.catchUps}, {"by_state", summary.link.snapshots}};
    for (std::size_t i = 0; i < haptic_bridge::kRefusalNames.size(); ++i) {
        const std::string kind(haptic_bridge::kRefusalNames[i]);
        part["refused_by_server"][kind] = summary.link.refusedHere[i];
        part["refused"]["servers"][kind] = summary.link.refused[i];
        part["refused"]["guests"][kind] = summary.haptic ? summary.haptic->refused[i] : 0;
    }
    if (const auto& report = summary.haptic) {
        part["force_us"] = {{"p50", report->forceUsP50}, {"p99", report->forceUsP99}};
        part["half_round_trip_ms"] = halfRoundTrip(report->toWall);
        part["half_round_trip_to_master_ms"] = halfRoundTrip(report->toMaster);
        part["step_message_bytes"] = report->stepBytesMean;
        part["steps_withheld"] = report->stepsWithheld;
        part["samples_dropped"] = report->samplesDropped;
        part["ticks"] = report->ticks;
        part["ticks_missed"] = report->ticksMissed;
        for (std::size_t i = 0; i < haptic_bridge::kGuards; ++i) {
            part["guarded_ticks"][std::string(haptic_bridge::kGuardNames[i])] = report->guards[i];
        }
    }
    return part;
}

ordered_json journalPart(const Summary::Journal& journal) {
    return {{"policy", journal.policy},
            {"state", journal.state},
            {"parts", journal.parts},
            {"checkpoints", journal.checkpointMs.count()},
            {"checkpoints_failed", journal.checkpointsFailed},
            {"checkpoints_beyond", journal.checkpointsBeyond},
            {"checkpoint_copy_ms", spread(journal.checkpointMs)},
            {"full_disk", {{"times", journal.stands}, {"seconds", journal.stoodSeconds}}}};
}

double shareOf(std::size_t count, std::uint64_t frames) {
    return frames == 0 ? 0 : static_cast<double>(count) / static_cast<double>(frames);
}

ordered_json slowestPart(const Summary& summary, const lockstep::RankStatistics::Rank& rank) {
    return {{"frames", rank.keptMs.count()},
            {"share", shareOf(rank.keptMs.count(), summary.frames - summary.framesBefore)},
            {"wall_waited_ms", spread(rank.keptMs)}};
}

ordered_json rankPart(const Summary& summary, std::size_t index) {
    const lockstep::RankReport& report = summary.ranksReports[index];
    const lockstep::RankStatistics::Rank& seen = summary.rankStatistics[index + 1];
    return {{"rank", index + 1},
            {"tile", summary.tileNames[index]},
            {"host", report.host},
            {"renderer", report.renderer},
            {"swap_lock", report.swapLock},
            {"draw_ms", {{"p50", report.drawP50}, {"p99", report.drawP99}, {"max", report.drawMax}}},
            {"barrier_wait_ms", {{"p50", report.waitP50}, {"p99", report.waitP99}}},
            {"slowest", slowestPart(summary, seen)},
            {"swap_us", spread(seen.swapUs)},
            {"frames_agreed", seen.agreed},
            {"frames_differed", seen.differed},
            {"healed", seen.healed},
            {"views",
             {{"skipped", report.viewsSkipped},
              {"in_part", report.viewsInPart},
              {"whole", report.viewsWhole},
              {"pixel_share", report.pixelShare}}},
            {"memory_bytes", report.residentBytes},
            {"frame_buffer_bytes", report.frameBufferBytes}};
}

ordered_json jsonOf(const Summary& summary) {
    ordered_json json;
    json["version"] = kSummaryVersion;
    json["scene"] = summary.scene;
    json["wall"] = summary.wall;
    json["frames"] = summary.frames;
    json["steps"] = summary.steps;
    json["ranks"] = summary.ranks;
    json["state_hash"] = fmt::format("{:016x}", summary.stateHash);
    json["divergences"] = summary.divergences;
    json["healed"] = summary.healed;
    json["outvoted"] = summary.outvoted;
    json["master_healed"] = summary.rankStatistics.empty() ? 0 : summary.rankStatistics.front().healed;
    json["server_divergences"] = summary.serverDivergences;
    json["steps_left_out"] = summary.stepsLeftOut;
    json["volume_initial"] = summary.volumeInitial;
    json["volume_final"] = summary.volumeFinal;
    json["edits"] = summary.edits;
    json["volume_outflow"] = summary.volumeOutflow;
    json["seconds"] = summary.seconds;
    json["fps"] = framesPerSecond(summary);
    json["frame_ms"] = spread(summary.frameMs);
    json["frame_ms"].update({{"count", summary.frameMs.count()}, {"mean", summary.frameMs.mean()}});
    json["late_frames"] = summary.lateFrames;
    json["skew_us"] = spread(summary.skewUs);
    json["latency_ms"] = distribution(summary.latency.wholeWay);
    json["latency_legs_ms"] = {{"to_master", distribution(summary.latency.toMaster)},
                               {"queued", distribution(summary.latency.queued)},
                               {"drawn", distribution(summary.latency.drawn)},
                               {"swapped", distribution(summary.latency.swapped)}};
    // Only a force loop in real time has a meaningful period.
    const bool felt = summary.haptic && summary.haptic->hapticPeriodUsMax > 0;
    const haptic_bridge::Report report = summary.haptic.value_or(haptic_bridge::Report{});
    json["haptic_period_us"] = felt ? ordered_json{{"p50", report.hapticPeriodUsP50},
                                                   {"p99", report.hapticPeriodUsP99},
                                                   {"max", report.hapticPeriodUsMax}}
                                    : ordered_json{{"p50", nullptr}, {"p99", nullptr}, {"max", nullptr}};
    json["slowest"] = slowestRank(summary.drag, summary.rankNames);
    json["broadcast_bytes"] = spread(summary.broadcastBytes);
    json["haptic"] = hapticPart(summary);
    if (const auto& head = summary.tracking) {
        json["head_tracking"] = {{"packets", head->packets},    {"refused", head->refused}, {"old", head->old},
                                 {"absent", head->absent},      {"lost", head->timesLost},  {"outside", head->outside},
                                 {"strangers", head->strangers}};
    }
    json["master_memory_bytes"] = summary.masterResidentBytes;
    json["journal"] = journalPart(summary.journal);
    json["recoveries"] = ordered_json::array();
    for (const std::string& recovery : summary.recoveries) {
        json["recoveries"].push_back(ordered_json::parse(recovery));
    }
    json["per_rank"] = ordered_json::array();
    for (std::size_t i = 0; i < summary.ranksReports.size(); ++i) {
        json["per_rank"].push_back(rankPart(summary, i));
    }
    return json;
}

/// Returns "5 times (secret)" or "5 times (secret 4, busy 1)"; an empty text if all counts are 0.
std::string timesOf(const haptic_bridge::RefusalCounts& counts) {
    std::uint64_t all = 0;
    for (const std::uint64_t count : counts) {
        all += count;
    }
    std::string kinds;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] > 0) {
            kinds += fmt::format("{}{}", kinds.empty() ? "" : ", ", haptic_bridge::kRefusalNames[i]);
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
    add("refused", timesOf(summary.link.refusedHere));
    add("refused the server", timesOf(summary.link.refused));
    add("the server refused connections",
        timesOf(summary.haptic ? summary.haptic->refused : haptic_bridge::RefusalCounts{}));
    if (text.empty()) {
        return {};
    }
    return fmt::format("  haptics   {}: {}\n", summary.link.links == 0 ? "no hand all session" : "beside links", text);
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

ordered_json slowestRank(const std::optional<lockstep::Drag>& drag, const std::vector<std::string>& rankNames) {
    if (!drag) {
        return nullptr;
    }
    return {{"rank", drag->rank},
            {"name", rankNames[static_cast<std::size_t>(drag->rank)]},
            {"share", drag->share},
            {"wall_waited_ms", drag->keptMs}};
}

void writeSummary(const Summary& summary, const std::filesystem::path& file) {
    host::WholeFile whole(file, host::WholeFile::Other::refused);
    whole.stream() << jsonOf(summary).dump(2) << '\n';
    whole.keep();
}

std::string describe(const Summary& summary) {
    std::string text = fmt::format(
        "{} on {}: {} steps in {} frames, {:.1f} fps, {} render ranks\n"
        "  sand      state hash {:016x}, {} divergences, {} healed, {}volume {} + outflow {} = {} at the start: {}\n"
        "  wall      swap skew p50 {:.0f} us, p99 {:.0f} us, max {:.0f} us; frame message p50 {:.0f} bytes\n",
        summary.scene, summary.wall, summary.steps, summary.frames, framesPerSecond(summary), summary.ranks,
        summary.stateHash, summary.divergences, summary.healed,
        summary.outvoted == 0 ? "" : fmt::format("{} outvoted by the journal, ", summary.outvoted), summary.volumeFinal,
        summary.volumeOutflow, summary.volumeInitial, summary.exact() ? "exact" : "WRONG",
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
    if (summary.haptic && summary.haptic->stepsWithheld > 0) {
        text += fmt::format(
            "  hand      the wall was too slow for {} steps of the hand, so strokes may have gaps; with --pace fast a "
            "recorded hand waits for the wall\n",
            summary.haptic->stepsWithheld);
    }
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

}  // namespace master
