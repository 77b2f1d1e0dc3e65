// SPDX-License-Identifier: Apache-2.0
#include "master/measure/summary.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/sand/high_sand.hpp"

namespace {

/// Returns the statistics of 200 frames of a still wall of three tiles. Rank 2 comes 30 ms late in 97 % of them.
master::Summary draggedWall(bool dragged) {
    master::Summary summary;
    summary.scene = summary.wall = "test";
    summary.frames = 200;
    summary.ranks = 3;
    summary.tileNames = {"r1c1", "r1c2", "r1c3"};
    summary.rankNames = {"the master", "rank 1 (tile r1c1) on vm", "rank 2 (tile r1c2) on vm",
                         "rank 3 (tile r1c3) on vm"};
    summary.ranksReports.resize(3);
    lockstep::RankStatistics statistics(4);
    for (int frame = 0; frame < 200; ++frame) {
        std::vector<lockstep::Arrival> arrivals(4);
        arrivals[2].arrived = dragged && frame >= 6 ? 30'100'000 : 0;
        arrivals[3].arrived = 400'000;
        statistics.add(arrivals, true);
    }
    for (lockstep::RankReport& report : summary.ranksReports) {
        report.drawP50 = 1;
    }
    summary.ranksReports[1].drawP50 = 31.2;
    summary.rankStatistics = statistics.ranks();
    summary.drag = statistics.drag();
    return summary;
}

nlohmann::json written(const master::Summary& summary) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "sandwall_summary_test.json";
    master::writeSummary(summary, file);
    nlohmann::json json = nlohmann::json::parse(std::ifstream(file));
    std::filesystem::remove(file);
    return json;
}

TEST(Summary, HasTheFirstRefusedPressInUnitsOfTheScene) {
    constexpr double kCell = 0.25;  // [scene unit]
    sand::Replica replica(samples::highScene(24, sand::ToolKind::ellipsoid, kCell));
    replica.apply({.number = 1, .engaged = true, .path = {samples::aboveHighSand(2)}});
    const std::int32_t largest = replica.firstRefusedPress().value().largest.value();
    const master::RefusedPressPart part = master::refusedPressOf(replica);
    EXPECT_EQ(part.shape, "ellipsoid");
    EXPECT_EQ(part.radius, 24 * kCell);
    ASSERT_GT(largest, 0);
    EXPECT_EQ(part.largest, kCell * largest / sand::kProbePerCell);
}

TEST(Summary, SaysWhichToolWouldFitWhereAPressWasRefused) {
    const std::string text = master::describe(master::RefusedPressPart{"sphere", 2.5, 1.25});
    EXPECT_NE(text.find("the sphere of radius 2.5 "), std::string::npos) << text;
    EXPECT_NE(text.find("the largest sphere that fits there has a radius of 1.25"), std::string::npos) << text;
    const std::string none = master::describe(master::RefusedPressPart{"circle", 2.5, 0.0});
    EXPECT_NE(none.find("no circle fits there"), std::string::npos) << none;
    const std::string unknown = master::describe(master::RefusedPressPart{"circle", 2.5, std::nullopt});
    EXPECT_EQ(unknown.find("fits"), std::string::npos) << "on a TIN no radius is computed: " << unknown;
}

TEST(Summary, HasTheUnitsOfEachFileOfTerrain) {
    master::Summary summary = draggedWall(false);
    EXPECT_EQ(written(summary)["terrain"], nlohmann::json()) << "unknown";
    summary.terrain.emplace();
    EXPECT_EQ(written(summary)["terrain"], nlohmann::json::array()) << "no files";
    summary.terrain = {{"valley.asc", "metres", "EPSG:32633", "feet", "vertical datum", "-9999", 0.25},
                       {"rock.asc", "metres", "EPSG:32633", "the same", "no unit of heights", std::nullopt, 0}};
    const nlohmann::json terrain = written(summary)["terrain"];
    ASSERT_EQ(terrain.size(), 2U);
    EXPECT_EQ(terrain[0],
              nlohmann::json::parse(R"({"file": "valley.asc", "across": "metres", "across_from": "EPSG:32633",
        "up": "feet", "up_from": "vertical datum", "no_data": "-9999", "no_data_share": 0.25})"));
    EXPECT_EQ(terrain[1]["no_data"], nullptr);
}

TEST(Summary, CountsFramesPerSecondSinceTheLastStart) {
    master::Summary summary = draggedWall(false);
    summary.seconds = 2;
    EXPECT_EQ(summary.framesPerSecond(), 199.0 / 2);
    summary.framesBefore = 79;  // 121 frames are from this start, with 120 periods between them
    EXPECT_EQ(summary.framesPerSecond(), 60);
    EXPECT_EQ(written(summary)["fps"], 60);
}

TEST(Summary, NamesTheRankThatDragsTheWall) {
    const master::Summary summary = draggedWall(true);
    EXPECT_NE(
        master::describe(summary).find("  slowest   rank 2 (tile r1c2) on vm in 97 % of frames: draws in 31.2 ms, "
                                       "the others in 1.0 ms (p50); the wall waited 29.7 ms more for it\n"),
        std::string::npos)
        << master::describe(summary);
    const nlohmann::json json = written(summary);
    EXPECT_EQ(json["slowest"]["rank"], 2);
    EXPECT_EQ(json["slowest"]["name"], "rank 2 (tile r1c2) on vm");
    EXPECT_EQ(json["per_rank"][1]["slowest"]["frames"], 194);
    EXPECT_NEAR(json["per_rank"][1]["slowest"]["share"], 0.97, 1e-9);
    EXPECT_NEAR(json["per_rank"][1]["slowest"]["wall_waited_ms"]["p50"], 29.7, 1e-6);
    EXPECT_EQ(json["per_rank"][0]["slowest"]["frames"], 0);
    EXPECT_EQ(json["per_rank"][0]["frames_agreed"], 200);
    EXPECT_EQ(json["per_rank"][0]["frames_differed"], 0);
}

TEST(Summary, TellsBothHalfRoundTripsApart) {
    master::Summary summary = draggedWall(false);
    summary.haptic.emplace();
    summary.haptic->toWall = {13.6, 9.8, 12, 40, 70};
    summary.haptic->toMaster = {0.2, 0.1, 0.15, 1, 71};
    const nlohmann::json haptic = written(summary)["haptic"];
    const nlohmann::json toWall = {{"mean", 13.6}, {"stddev", 9.8}, {"p50", 12.}, {"p99", 40.}, {"count", 70}};
    const nlohmann::json toMaster = {{"mean", 0.2}, {"stddev", 0.1}, {"p50", 0.15}, {"p99", 1.}, {"count", 71}};
    EXPECT_EQ(haptic["half_round_trip_ms"], toWall);
    EXPECT_EQ(haptic["half_round_trip_to_master_ms"], toMaster);
}

TEST(Summary, SaysThatTheWallWasTooSlowForTheHand) {
    master::Summary summary = draggedWall(false);
    summary.haptic.emplace();
    EXPECT_EQ(master::describe(summary).find("  hand "), std::string::npos) << "no step was missing";
    summary.haptic->stepsWithheld = {3185, 0, 40, 8};
    EXPECT_EQ(master::describe(summary).find("disk"), std::string::npos) << "a pause and the start are no fault";
    EXPECT_NE(master::describe(summary).find("\n  hand      the wall was too slow for 3185 steps of the hand"),
              std::string::npos)
        << master::describe(summary);
}

TEST(Summary, SaysThatAHandWasRefusedAndWhy) {
    const auto index = [](haptic_bridge::RefusalCode code) { return static_cast<std::size_t>(code) - 1; };
    const auto saysHaptics = [](const master::Summary& summary, const std::string& line) {
        const std::string text = master::describe(summary);
        EXPECT_NE(text.find("\n  haptics   " + line + "\n"), std::string::npos) << text;
    };
    master::Summary summary = draggedWall(false);
    EXPECT_EQ(master::describe(summary).find("haptics"), std::string::npos) << "a wall without haptics";
    summary.incidents.refusedHere[index(haptic_bridge::RefusalCode::secret)] = 5;
    saysHaptics(summary, "no hand all session: refused 5 times (secret)");
    summary.incidents.refused[index(haptic_bridge::RefusalCode::tls)] = 1;
    summary.incidents.refused[index(haptic_bridge::RefusalCode::garbage)] = 2;
    saysHaptics(summary,
                "no hand all session: refused 5 times (secret); refused the server 3 times (garbage 2, tls 1)");
    const nlohmann::json haptic = written(summary)["haptic"];
    EXPECT_EQ(haptic["refused_by_server"]["secret"], 5);
    EXPECT_EQ(haptic["refused_by_server"]["busy"], 0);
    EXPECT_EQ(haptic["refused"]["servers"]["tls"], 1);

    summary = draggedWall(false);
    summary.incidents.links = 1;
    summary.haptic.emplace();
    EXPECT_EQ(master::describe(summary).find("haptics"), std::string::npos) << "there were no refusals";
    summary.incidents.refusedHere[index(haptic_bridge::RefusalCode::busy)] = 1;
    summary.haptic->refused[index(haptic_bridge::RefusalCode::secret)] = 7;
    saysHaptics(summary, "beside links: refused 1 time (busy); the server refused connections 7 times (secret)");
}

TEST(Summary, TellsTheCausesOfWithheldStepsApart) {
    master::Summary summary = draggedWall(false);
    summary.haptic.emplace();
    summary.haptic->stepsWithheld = {1, 20, 300, 4000};
    const nlohmann::json haptic = written(summary)["haptic"];
    EXPECT_EQ(haptic["steps_withheld"], 4321);
    const nlohmann::json causes = {{"wall", 1}, {"disk", 20}, {"pause", 300}, {"start", 4000}};
    EXPECT_EQ(haptic["steps_withheld_by"], causes);
    EXPECT_NE(master::describe(summary).find("\n  hand      the full disk has held 20 steps"), std::string::npos)
        << master::describe(summary);
}

TEST(Summary, SaysHowFarTheSandWasCompared) {
    master::Summary summary = draggedWall(false);
    summary.compared.lastWhole = 140;
    const nlohmann::json lost = {{"at_end", false},
                                 {"server_at_end", nullptr},
                                 {"last_whole", 140},
                                 {"frames_since", 60},
                                 {"first_difference", nullptr}};
    EXPECT_EQ(written(summary)["compared"], lost);
    summary.compared = {true, false, 200};
    summary.incidents.firstDifference = 17;
    const nlohmann::json toTheEnd = {
        {"at_end", true}, {"server_at_end", false}, {"last_whole", 200}, {"frames_since", 0}, {"first_difference", 17}};
    EXPECT_EQ(written(summary)["compared"], toTheEnd);
}

TEST(Summary, SaysWhichHandWasAskedForAndWhetherItCame) {
    master::Summary summary = draggedWall(false);
    const nlohmann::json none = {{"asked", "none"},        {"links", 0},
                                 {"frames_with_hand", 0},  {"linked_at_end", false},
                                 {"slow_motion", nullptr}, {"last_refusal", nullptr}};
    EXPECT_EQ(written(summary)["hand"], none);
    summary.hand = {"server", 12, true, 2.5, "refuses: \xff not UTF-8"};
    summary.incidents.links = 2;
    const nlohmann::json hand = written(summary)["hand"];
    EXPECT_EQ(hand["links"], 2);
    EXPECT_EQ(hand["frames_with_hand"], 12);
    EXPECT_EQ(hand["linked_at_end"], true);
    EXPECT_EQ(hand["slow_motion"], 2.5);
    EXPECT_EQ(hand["last_refusal"], "refuses: \xef\xbf\xbd not UTF-8") << "U+FFFD in its place";
}

TEST(Summary, SaysWhatTheDeviceGot) {
    master::Summary summary = draggedWall(false);
    summary.haptic.emplace();
    summary.haptic->handTicks = 900;
    summary.haptic->feltTicks = 300;
    summary.haptic->faultedTicks = 5;
    summary.haptic->handSeconds = 2;
    summary.haptic->faultedSeconds = 1;
    summary.haptic->asked[static_cast<std::size_t>(haptic_bridge::ForceOutcome::slowMotion)] = 7;
    summary.haptic->literal = true;
    summary.haptic->deviceLosses = 2;
    summary.haptic->deviceAway = true;
    summary.haptic->arm = true;
    const nlohmann::json haptic = written(summary)["haptic"];
    EXPECT_EQ(haptic["hand_ticks"], 900);
    EXPECT_EQ(haptic["felt_ticks"], 300);
    EXPECT_EQ(haptic["faulted_ticks"], 5);
    EXPECT_EQ(haptic["hand_seconds"], 2);
    EXPECT_EQ(haptic["faulted_seconds"], 1);
    EXPECT_EQ(haptic["asked_ticks"]["slow_motion"], 7);
    EXPECT_EQ(haptic["asked_ticks"]["half"], 0);
    EXPECT_EQ(haptic["literal"], true);
    EXPECT_EQ(haptic["device_losses"], 2);
    EXPECT_EQ(haptic["device_away"], true);
    EXPECT_EQ(haptic["arm"], true);
}

TEST(Summary, NamesNobodyWhereNoneStandsOut) {
    const master::Summary summary = draggedWall(false);
    EXPECT_EQ(master::describe(summary).find("\n  slowest   "), std::string::npos) << master::describe(summary);
    EXPECT_TRUE(written(summary)["slowest"].is_null());
}

}  // namespace
