// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "host/whole_file.hpp"
#include "master/summary.hpp"

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
    for (std::size_t i = 0; i < valuesOf(haptic_bridge::RefusalCode{}).size(); ++i) {
        const std::string kind(valuesOf(haptic_bridge::RefusalCode{})[i].name);
        part["refused_by_server"][kind] = summary.link.refusedHere[i];
        part["refused"]["servers"][kind] = summary.link.refused[i];
        part["refused"]["guests"][kind] = summary.haptic ? summary.haptic->refused[i] : 0;
    }
    if (const auto& report = summary.haptic) {
        part["force_us"] = {{"p50", report->forceUsP50}, {"p99", report->forceUsP99}};
        part["half_round_trip_ms"] = halfRoundTrip(report->toWall);
        part["half_round_trip_to_master_ms"] = halfRoundTrip(report->toMaster);
        part["step_message_bytes"] = report->stepBytesMean;
        part["steps_withheld"] = haptic_bridge::inAll(report->stepsWithheld);
        for (std::size_t i = 0; i < valuesOf(haptic_bridge::Withheld{}).size(); ++i) {
            part["steps_withheld_by"][std::string(valuesOf(haptic_bridge::Withheld{})[i].name)] =
                report->stepsWithheld[i];
        }
        part["samples_dropped"] = report->samplesDropped;
        part["ticks"] = report->ticks;
        part["ticks_missed"] = report->ticksMissed;
        part["literal"] = report->literal;
        part["hand_ticks"] = report->handTicks;
        part["felt_ticks"] = report->feltTicks;
        part["faulted_ticks"] = report->faultedTicks;
        for (std::size_t i = 0; i < haptic_bridge::kGuards; ++i) {
            part["guarded_ticks"][std::string(haptic_bridge::kGuardNames[i])] = report->guards[i];
        }
    }
    return part;
}

ordered_json journalPart(const Summary::Journal& journal) {
    return {{"policy", journal.policy},
            {"state", journal.state},
            {"whole", journal.whole},
            {"parts", journal.parts},
            {"checkpoints", journal.checkpointMs.count()},
            {"checkpoints_failed", journal.checkpointsFailed},
            {"checkpoints_beyond", journal.checkpointsBeyond},
            {"checkpoint_copy_ms", spread(journal.checkpointMs)},
            {"full_disk", {{"times", journal.stands}, {"seconds", journal.stoodSeconds}}}};
}

template <class Value>
ordered_json orNull(const std::optional<Value>& value) {
    return value ? ordered_json(*value) : ordered_json();
}

ordered_json comparedPart(const Summary& summary) {
    const Summary::Compared& compared = summary.compared;
    return {{"at_end", compared.atEnd},
            {"server_at_end", orNull(compared.serverAtEnd)},
            {"last_whole", compared.lastWhole},
            {"frames_since", summary.frames - compared.lastWhole},
            {"first_difference", orNull(compared.firstDifference)}};
}

ordered_json handPart(const Summary& summary) {
    const Summary::Hand& hand = summary.hand;
    return {{"asked", hand.asked},
            {"links", summary.link.links},
            {"frames_with_hand", hand.frames},
            {"linked_at_end", hand.atEnd},
            {"last_refusal", orNull(hand.lastRefusal)}};
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

/// Returns what the numbers of each file of terrain mean; null if that is unknown.
ordered_json jsonOf(const std::optional<std::vector<scene::RasterStatement>>& terrain) {
    if (!terrain) {
        return nullptr;
    }
    ordered_json json = ordered_json::array();
    for (const scene::RasterStatement& file : *terrain) {
        json.push_back({{"file", file.file},
                        {"across", file.across},
                        {"across_from", file.acrossFrom},
                        {"up", file.up},
                        {"up_from", file.upFrom},
                        {"no_data", file.noData ? ordered_json(*file.noData) : ordered_json(nullptr)},
                        {"no_data_share", file.noDataShare}});
    }
    return json;
}

ordered_json jsonOf(const Summary& summary) {
    ordered_json json;
    json["version"] = kSummaryVersion;
    json["scene"] = summary.scene;
    json["terrain"] = jsonOf(summary.terrain);
    json["wall"] = summary.wall;
    json["frames"] = summary.frames;
    json["steps"] = summary.steps;
    json["frames_before"] = summary.framesBefore;
    json["steps_before"] = summary.stepsBefore;
    json["pace"] = summary.pace;
    json["refresh_hz"] = summary.refreshHz;
    json["ranks"] = summary.ranks;
    json["state_hash"] = fmt::format("{:016x}", summary.stateHash);
    json["divergences"] = summary.divergences;
    json["healed"] = summary.healed;
    json["outvoted"] = summary.outvoted;
    json["master_healed"] = summary.rankStatistics.empty() ? 0 : summary.rankStatistics.front().healed;
    json["server_divergences"] = summary.serverDivergences;
    json["unhealed"] = summary.unhealed;
    json["compared"] = comparedPart(summary);
    json["steps_left_out"] = summary.stepsLeftOut;
    json["volume_initial"] = summary.volumeInitial;
    json["volume_final"] = summary.volumeFinal;
    json["edits"] = summary.edits;
    json["volume_outflow"] = summary.volumeOutflow;
    json["seconds"] = summary.seconds;
    json["fps"] = summary.framesPerSecond();
    json["frame_ms"] = spread(summary.frameMs);
    json["frame_ms"].update({{"count", summary.frameMs.count()}, {"mean", summary.frameMs.mean()}});
    json["late_frames"] = summary.lateFrames;
    json["held_seconds"] = {{"pause", summary.pausedSeconds}, {"disk", summary.fullDiskSeconds}};
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
    json["hand"] = handPart(summary);
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
    // A server may have sent any bytes as the text of its refusal.
    whole.stream() << jsonOf(summary).dump(2, ' ', false, ordered_json::error_handler_t::replace) << '\n';
    whole.keep();
}

}  // namespace master
