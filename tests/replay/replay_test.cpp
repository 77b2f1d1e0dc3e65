// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"
#include "master/journal/resume.hpp"
#include "sand/replica.hpp"
#include "scene/import/esri_file.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/replay/replay_fixture.hpp"
#include "tests/support/journal/read_session.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using test::Replay;

TEST_F(Replay, EndsInTheSessionsHash) {
    sand::Replica replica = record();
    const support::Ran ran = support::runProgram("sandwall-replay", journal() + " --hash");
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(ran.output, fmt::format("{:016x}\n", replica.stateHash()));
}

TEST_F(Replay, WritesTheHeights) {
    const sand::Replica replica = record();
    const std::string file = (folder_ / "h.asc").string();
    ASSERT_EQ(support::runProgram("sandwall-replay", journal() + " --heights " + file).status, 0);
    const scene::EsriGrid grid = scene::readEsriGrid(file);
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 40; ++x) {
            ASSERT_NEAR(grid.at(x, y), samples::fieldOf(replica).height(x, y) * samples::fieldOf(replica).unit(), 1e-6);
        }
    }
}

TEST_F(Replay, WritesNoDataWhereATinHasHoles) {
    std::ofstream dem(folder_ / "dem.asc");
    dem << "ncols 24\nnrows 20\nxllcorner 100\nyllcorner 200\ncellsize 2\nNODATA_value -1\n";
    const auto isGap = [](int column, int row) {
        return (column > 8 && column < 13 && row > 5 && row < 11) || row > 26 - column;
    };
    for (int row = 19; row >= 0; --row) {
        for (int column = 0; column < 24; ++column) {
            dem << (isGap(column, row) ? -1.0 : 3 + 0.1 * column) << ' ';
        }
        dem << '\n';
    }
    dem.close();
    std::ofstream(folder_ / "s.toml") << "[terrain]\nkind = \"esri_ascii\"\nfile = \"dem.asc\"\n[tin]\n[material]\n"
                                         "settling_time = 0.1\n[tool]\nradius = 4\n";
    sand::Replica replica = record(scene::loadScene(folder_ / "s.toml"), 0);
    EXPECT_EQ(support::runProgram("sandwall-replay", journal() + " --hash").output,
              fmt::format("{:016x}\n", replica.stateHash()));
    for (const std::string option : {"--heights", "--difference"}) {
        const std::string file = (folder_ / "h.asc").string();
        ASSERT_EQ(support::runProgram("sandwall-replay", fmt::format("{} {} {}", journal(), option, file)).status, 0);
        const scene::EsriGrid grid = scene::readEsriGrid(file);
        for (int row = 0; row < 20; ++row) {
            for (int column = 0; column < 24; ++column) {
                ASSERT_EQ(grid.isNoData(column, row), isGap(column, row)) << option << ' ' << column << ", " << row;
            }
        }
    }
}

TEST_F(Replay, SaysWhereASessionDiffers) {
    record(1);
    const support::Ran ran = support::runProgram("sandwall-replay", journal());
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.output.find("before frame 10, after step 18: the session had "), std::string::npos) << ran.output;
}

TEST_F(Replay, ComparesTheHashOfSandThatRests) {
    for (const std::uint64_t error : {0U, 8U}) {
        std::filesystem::remove(journal());
        const scene::Scene scene = samples::flatScene(40, 30);
        sand::Replica replica(scene);
        {
            std::mt19937 random(53);
            master::JournalWriter writer(journal(), scene, "test");
            const sand::Step step = samples::randomStep(1, scene.rules, random);
            writer.append({1, replica.stateHash(), {step}});
            replica.apply(step);
            writer.append({2, replica.stateHash() ^ error, {}});
        }
        const support::Ran ran = replay("");
        EXPECT_EQ(ran.status, error == 0 ? 0 : 1) << ran.output;
        EXPECT_EQ(ran.output.find("before frame 2, after step 1: ") == std::string::npos, error == 0) << ran.output;
        EXPECT_EQ(replay("--verify").status, error == 0 ? 0 : 1);
    }
}

TEST_F(Replay, VerifiesAllThatAJournalSays) {
    const sand::Replica replica = record();
    const std::uint64_t session = master::openJournal(journal()).header().session;
    const auto keep = [&](const sand::Replica& sand) {
        sand::Replica copy = sand;
        master::writeCheckpoint(
            journal(),
            {session, "test", sand.rules().digest(), sand.stepNumber(), 20, 1, copy.stateHash(), copy.encodeState()},
            3);
    };
    keep(replica);
    const support::Ran good = support::runProgram("sandwall-replay", journal() + " --verify");
    EXPECT_EQ(good.status, 0) << good.output;
    for (const char* line : {"records      21 whole, ", "chain        whole", "parts        1\n",
                             "tail         whole\n", "steps        40 without a gap, in frames 1 to 20, epochs to 1",
                             "hashes       21 of 21 equal to the replay's",
                             "checkpoint   of step 40: the replay's sand\n", "end          orderly, at step 40"}) {
        EXPECT_NE(good.output.find(line), std::string::npos) << line << "\n" << good.output;
    }
    // The checkpoint has the same step and other sand.
    sand::Replica other(samples::flatScene(40, 30));
    for (std::uint64_t number = 1; number <= 40; ++number) {
        other.apply({.epoch = 1, .number = number, .engaged = false, .path = {}});
    }
    keep(other);
    const support::Ran bad = support::runProgram("sandwall-replay", journal() + " --verify");
    EXPECT_EQ(bad.status, 1) << bad.output;
    EXPECT_NE(bad.output.find("of step 40: differs from the replay's sand"), std::string::npos) << bad.output;
    record(1);
    EXPECT_EQ(support::runProgram("sandwall-replay", journal() + " --verify").status, 1);
    std::filesystem::resize_file(journal(), 20);
    EXPECT_EQ(support::runProgram("sandwall-replay", journal() + " --verify").status, 2);
}

TEST_F(Replay, WritesEveryStepAsARow) {
    scene::Scene scene = samples::flatScene(40, 30);
    {
        master::JournalWriter writer(journal(), scene, "test");
        sand::Tuning tuning = scene.rules.tuning;
        tuning.tool.kind = sand::ToolKind::circle;
        tuning.tool.radius = 3 * sand::kProbePerCell;
        sand::Step first{.epoch = 7, .number = 1, .engaged = true, .path = {{256, 512, -64}, {384, 0, 0}}};
        sand::Step second{.epoch = 7, .number = 2, .engaged = false, .path = {}, .edit = sand::Edit::tuned(tuning)};
        sand::Step third{.epoch = 8,
                         .number = 3,
                         .engaged = false,
                         .path = {},
                         .edit = sand::Edit::undo,
                         .heading = sand::Heading{0, 16384}};
        first.sweeps = second.sweeps = third.sweeps = 8;
        writer.append({5, 0, {first, second}});
        writer.append({9, 0, {third}});
    }
    const std::string file = (folder_ / "steps.csv").string();
    ASSERT_EQ(support::runProgram("sandwall-replay", journal() + " --export " + file).status, 0);
    std::ifstream stream(file);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}),
              "epoch,number,frame,engaged,tool,radius,heading,path,edit\n"
              "7,1,5,1,sphere,4,0,1 2 -0.25;1.5 0 0,\n"
              "7,2,5,0,sphere,4,0,,tune\n"
              "8,3,9,0,circle,3,90,,undo\n");
}

TEST_F(Replay, RecoversWhatStandsBeforeTheDamage) {
    sand::Replica replica = record();
    const auto middle = static_cast<std::streamoff>(std::filesystem::file_size(journal()) * 3 / 4);
    std::fstream stream(journal(), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(middle);
    const int before = stream.get();
    stream.seekp(middle);
    stream.put(static_cast<char>(before ^ 16));
    stream.close();
    const std::string file = (folder_ / "new" / "session.journal").string();
    EXPECT_EQ(support::runProgram("sandwall-replay", journal()).status, 2);
    const support::Ran ran = support::runProgram("sandwall-replay", journal() + " --recover " + file);
    EXPECT_EQ(ran.status, 0) << ran.output;
    EXPECT_NE(ran.output.find("damaged at byte"), std::string::npos) << ran.output;
    EXPECT_NE(ran.output.find("bytes are lost"), std::string::npos) << ran.output;
    const journal::Journal kept = master::readJournal(file);
    ASSERT_GT(kept.frames.size(), 5U);
    ASSERT_LT(kept.frames.size(), 20U);
    EXPECT_EQ(kept.scene.encode(), samples::flatScene(40, 30).encode());
    EXPECT_EQ(support::runProgram("sandwall-replay", file + " --verify").status, 0);
    const support::Ran again = support::runProgram("sandwall-replay", journal() + " --recover " + file);
    EXPECT_EQ(again.status, 2);
    EXPECT_NE(again.output.find("is there already"), std::string::npos) << again.output;
}

TEST_F(Replay, ARecoveredJournalNamesNoHostThatAnEarlierBuildHasWritten) {
    record();
    {
        const auto session = test::readSession(journal());
        master::JournalWriter writer(session->place, "test");
        writer.resume({session->frame, {session->step, session->hash}, 0, "rank 1 on node02 was killed by SIGKILL"});
        writer.finish(session->step, session->hash);
    }
    ASSERT_NE(read("s.journal").find("node02"), std::string::npos);
    EXPECT_EQ(replay("--recover " + path("new.journal")).status, 0);
    EXPECT_EQ(read("new.journal").find("node02"), std::string::npos);
    EXPECT_EQ(master::readJournal(path("new.journal")).resumes.size(), 1U);
    EXPECT_EQ(support::runProgram("sandwall-replay", path("new.journal") + " --verify").status, 0);
}

TEST_F(Replay, SaysWhatItReplayedWhereNothingElseIsAskedFor) {
    sand::Replica replica = record();
    EXPECT_EQ(support::runProgram("sandwall-replay", journal()).output,
              fmt::format("{}: 40 steps replayed, state hash {:016x}; no hash differs from the session's\n", journal(),
                          replica.stateHash()));
    record(1);
    const support::Ran differs = support::runProgram("sandwall-replay", journal() + " --until 39");
    EXPECT_EQ(differs.status, 1);
    EXPECT_NE(differs.output.find(": 39 steps replayed, state hash "), std::string::npos) << differs.output;
    EXPECT_NE(differs.output.find("; hashes differ\n"), std::string::npos) << differs.output;
}

TEST_F(Replay, SaysThatItsAnswerCouldNotBeWritten) {
    record();
    for (const char* question : {"", "--hash", "--verify", "--volumes"}) {
        const support::Ran ran = support::runCommand("{ '" SANDWALL_BIN_DIR "/sandwall-replay' " + journal() + " " +
                                                     question + " >/dev/full; }");
        EXPECT_EQ(ran.status, 2) << question;
        EXPECT_EQ(ran.output, "sandwall-replay: standard output: cannot be written (No space left on device)\n")
            << question;
    }
}

TEST_F(Replay, SaysThatTheRowsEndWithATornRecord) {
    record();
    const std::string rows = " --export " + (folder_ / "steps.csv").string();
    EXPECT_EQ(support::runProgram("sandwall-replay", journal() + rows).output, "");
    std::filesystem::resize_file(journal(), std::filesystem::file_size(journal()) - 5);
    const support::Ran torn = support::runProgram("sandwall-replay", journal() + rows);
    EXPECT_EQ(torn.status, 0);
    EXPECT_EQ(torn.output,
              support::runProgram("sandwall-replay", journal() + " --mesh " + (folder_ / "m.ply").string()).output)
        << "a replay prints the same line";
    EXPECT_NE(torn.output.find("bytes are an incomplete write and were left out\n"), std::string::npos) << torn.output;
    EXPECT_NE(torn.output.find("has no orderly end"), std::string::npos) << torn.output;
}

TEST_F(Replay, SaysThatNothingCanBeRecoveredOfAHeaderThatIsCut) {
    record();
    const auto whole = std::filesystem::file_size(journal());
    for (const std::uintmax_t size : {whole / 100, std::uintmax_t{20}}) {
        std::filesystem::resize_file(journal(), size);
        for (const std::string& question : {std::string("--hash"), "--recover " + (folder_ / "new.journal").string()}) {
            const support::Ran ran = support::runProgram("sandwall-replay", journal() + " " + question);
            EXPECT_EQ(ran.status, 2) << size << question;
            EXPECT_NE(ran.output.find("its header is cut off or damaged ("), std::string::npos) << ran.output;
            EXPECT_NE(ran.output.find(": cut short: "), std::string::npos) << ran.output;
            EXPECT_NE(ran.output.find("; it holds the scene as the session began, without which nothing can be "
                                      "recovered\n"),
                      std::string::npos)
                << ran.output;
        }
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "new.journal"));
}

TEST_F(Replay, DoesAllThatIsAskedOfOneJournal) {
    record();
    const support::Ran ran = replay("--until 10 --hash --mesh " + path("a.ply") + " --heights " + path("a.asc") +
                                    " --difference " + path("d.asc") + " --export " + path("s.csv"));
    ASSERT_EQ(ran.status, 0) << ran.output;
    EXPECT_EQ(ran.output, replay("--until 10 --hash").output);
    for (const auto& [option, name, alone] :
         {std::array{"--mesh", "a.ply", "b.ply"}, std::array{"--heights", "a.asc", "b.asc"},
          std::array{"--difference", "d.asc", "e.asc"}, std::array{"--export", "s.csv", "t.csv"}}) {
        ASSERT_EQ(replay(fmt::format("--until 10 {} {}", option, path(alone))).status, 0) << option;
        EXPECT_FALSE(read(name).empty()) << option;
        EXPECT_EQ(read(name), read(alone)) << option;
    }
}

TEST_F(Replay, ExportsTheStepsUpToTheOneThatIsNamed) {
    record();
    ASSERT_EQ(replay("--export " + path("all.csv")).status, 0);
    ASSERT_EQ(replay("--until 7 --export " + path("some.csv")).status, 0);
    const std::string all = read("all.csv"), some = read("some.csv");
    EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 41) << "titles and 40 steps";
    EXPECT_EQ(std::count(some.begin(), some.end(), '\n'), 8) << "frames hold two steps: 7 is in the middle of one";
    EXPECT_EQ(some, all.substr(0, some.size()));
    const support::Ran ran = replay("--until 41 --export " + path("none.csv"));
    EXPECT_EQ(ran.status, 2);
    EXPECT_NE(ran.output.find("ends at step 40, before --until 41"), std::string::npos) << ran.output;
    EXPECT_FALSE(std::filesystem::exists(path("none.csv")));
}

// The scene in this journal ends after its rules, so that decoding its heights would fail in another way. A replica of
// 16384 x 16384 cells takes 4 GiB, and its heights alone take 1 GiB. Both are more than the limit of 1 GB.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // sanitizers reserve terabytes of addresses

#endif

}  // namespace
