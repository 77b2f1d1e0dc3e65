// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <csignal>
#include <optional>

#include "tests/cluster/session_fixture.hpp"
#include "tests/master/journal/doubted_journal.hpp"

namespace {

/// Ranks whose memory is corrupted while the wall runs.
class Healing : public SessionTest {
protected:
    /// Runs a fast session of at least 75 frames with injected faults. A flipped bit stays undetected until the audit
    /// reads its hash tile again, after at most 16 frames. Two flips that are further apart are found one by one.
    Ended dig(const std::string& wallFile, const std::vector<std::string>& faults, const std::string& folder) {
        std::vector<std::string> arguments{"--wall",   wallFile,     "--scene", scene(),
                                           "--device", "script:gis", "--pace",  "fast",
                                           "--steps",  "300",        "--out",   (folder_ / folder).string()};
        for (const std::string& fault : faults) {
            arguments.insert(arguments.end(), {"--inject", fault});
        }
        return runToEnd(arguments);
    }
    /// Runs a fast session of dunes that slide without a hand. Its sand depends only on the number of steps.
    Ended slide(const std::vector<std::string>& more, const std::string& folder) {
        const std::string dunes = write("dunes.toml",
                                        "name = \"dunes\"\n[field]\ncolumns = 128\nrows = 128\n[terrain]\nkind = "
                                        "\"dunes\"\ndune_height = 0.4\n[material]\ntalus_deg = 15\n[tool]\n");
        std::vector<std::string> arguments{"--wall", wall(1, 2), "--scene", dunes,
                                           "--pace", "fast",     "--out",   (folder_ / folder).string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runToEnd(arguments);
    }
    /// Runs the command in the session's last `divergence` event and returns the hash that it prints.
    std::string reproduced(const Ended& ended) {
        const std::vector<nlohmann::json> divergences = support::eventsIn(ended.output, "divergence");
        EXPECT_FALSE(divergences.empty()) << ended.output;
        support::ChildProcess replay(divergences.back()["reproduce"], folder_ / "replay.txt");
        EXPECT_EQ(replay.wait(kLong), 0) << replay.output();
        std::string printed = replay.output();  // the hash is in the last line
        printed = printed.substr(printed.size() - std::min<std::size_t>(printed.size(), 17), 16);
        EXPECT_EQ(divergences.back()["state_hash"], printed);
        return printed;
    }
    void expectHealed(const Ended& ended, const nlohmann::json& wanted) {
        EXPECT_TRUE(ended.has("healed", wanted)) << wanted << "\n" << ended.output;
    }

    /// Returns how many majorities the session has outvoted, as it saved them.
    [[nodiscard]] int outvotedSoFar() const {
        return std::filesystem::exists(folder_ / "out/incidents.json")
                   ? json("out/incidents.json")["outvoted"].get<int>()
                   : 0;
    }

    void expectEqualPictures(const std::string& one, const std::string& other) {
        int pictures = 0;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / one)) {
            const std::string name = entry.path().filename().string();
            if (entry.path().extension() == ".png") {
                ++pictures;
                const auto in = [&](const std::string& folder) { return read(fmt::format("{}/{}", folder, name)); };
                EXPECT_TRUE(in(one) == in(other)) << name;
            }
        }
        EXPECT_EQ(pictures, 7) << "expected two eyes of two tiles, two of the wall, and a red-cyan picture";
    }
};

TEST_F(Healing, LeavesNoTraceInPicturesAndSand) {
    const std::string wallFile = wall(1, 2);
    ASSERT_EQ(dig(wallFile, {}, "undisturbed").status, 0);
    // The faults are in a render rank early on, in the master, and in the same render rank again. The last fault is in
    // a cell that is dug by then.
    const Ended ended = dig(wallFile,
                            {"diverge:rank=2,frame=2,column=5,row=120", "diverge:rank=0,frame=22",
                             "diverge:rank=2,frame=42,column=64,row=64"},
                            "out");
    ASSERT_EQ(ended.status, 0) << ended.output;
    // Only rank 2 is wrong, in one cell of the hash tile in the north-west. Two of three ranks agree.
    const nlohmann::json odd{{"rank", 2}, {"hash_tile", 12}, {"columns", {0, 31}}, {"rows", {96, 127}}, {"cells", 1}};
    EXPECT_TRUE(ended.has(
        "divergence", {{"judge", "majority"}, {"agreeing", 2}, {"ranks", 3}, {"odd", nlohmann::json::array({odd})}}))
        << ended.output;
    expectHealed(ended, {{"rank", 2}, {"source", "rank"}, {"source_rank", 0}, {"times", 1}});
    expectHealed(ended, {{"rank", 0}, {"source", "rank"}, {"source_rank", 1}, {"times", 1}});
    EXPECT_EQ(reproduced(ended).size(), 16U);

    const nlohmann::json healed = summary();
    EXPECT_EQ(healed["divergences"], 3);
    EXPECT_EQ(healed["healed"], 3);
    EXPECT_EQ(healed["master_healed"], 1);
    EXPECT_EQ(healed["per_rank"][0]["healed"], 0);
    EXPECT_EQ(healed["per_rank"][1]["healed"], 2);
    EXPECT_EQ(healed["per_rank"][1]["frames_differed"], 2);
    EXPECT_EQ(healed["server_divergences"], 0) << "the haptic server's sand was never wrong";
    EXPECT_EQ(healed["state_hash"], json("undisturbed/summary.json")["state_hash"]);
    expectEqualPictures("undisturbed", "out");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/failure.json"));
}

// The hand never digs in this hash tile, and its sand has come to rest. A step that moves it would overwrite the fault
// before it is found.
TEST_F(Healing, FindsAndHealsMovementThatDiffers) {
    const std::string wallFile = wall(1, 2);
    ASSERT_EQ(dig(wallFile, {}, "undisturbed").status, 0);
    const Ended ended = dig(
        wallFile, {"movement:rank=2,frame=30,column=5,row=120", "movement:rank=0,frame=45,column=5,row=120"}, "out");
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("only in the steps in which its sand moved last"), std::string::npos) << ended.output;
    expectHealed(ended, {{"frame", 30}, {"rank", 2}, {"source", "rank"}, {"source_rank", 0}, {"times", 1}});
    expectHealed(ended, {{"frame", 45}, {"rank", 0}, {"source", "rank"}, {"source_rank", 1}, {"times", 1}});
    EXPECT_EQ(summary()["state_hash"], json("undisturbed/summary.json")["state_hash"]);
    expectEqualPictures("undisturbed", "out");
}

// Two ranks have no majority. With a journal its replay decides. Without one the master's sand is right, whatever it
// is.
TEST_F(Healing, OfMovementNeedsNoMajority) {
    const std::string wallFile = wall(1, 1);
    const std::string fault = "movement:rank=1,frame=30,column=5,row=120";
    for (const auto& [journal, judge] : {std::pair{"required", "journal"}, {"off", "master"}}) {
        const Ended ended =
            runToEnd({"--wall", wallFile, "--scene", scene(), "--device", "script:gis", "--pace", "fast", "--steps",
                      "300", "--out", out(), "--journal", journal, "--inject", fault});
        ASSERT_EQ(ended.status, 0) << ended.output;
        EXPECT_TRUE(ended.has("divergence", {{"frame", 30}, {"judge", judge}, {"agreeing", 1}})) << ended.output;
        expectHealed(ended, {{"frame", 30}, {"rank", 1}, {"source", "rank"}, {"source_rank", 0}});
        EXPECT_EQ(summary()["divergences"], 1);
    }
}

// A column of sand four cells high appears in the middle of a sliding dune, in the frame whose pictures are written.
TEST_F(Healing, RedrawsTheFrameInWhichItHappens) {
    ASSERT_EQ(slide({"--frames", "20"}, "undisturbed").status, 0);
    const Ended ended = slide({"--frames", "20", "--inject", "diverge:rank=1,frame=20,column=40,row=64,bit=18",
                               "--inject", "diverge:rank=2,frame=20,column=40,row=64,bit=19"},
                              "out");
    ASSERT_EQ(ended.status, 0) << ended.output;
    expectHealed(ended, {{"frame", 20}, {"rank", 1}});
    EXPECT_EQ(summary()["state_hash"], json("undisturbed/summary.json")["state_hash"]);
    expectEqualPictures("undisturbed", "out");
}

// No step touches the sand, and each frame hashes one of 16 tiles again. Without a whole comparison at the end, the
// fault's tile 12 would have its next turn in frame 29.
TEST_F(Healing, FindsWhatIsWrongInTheLastFrames) {
    const Ended ended = runToEnd({"--wall", wall(1, 2), "--scene", scene(), "--pace", "fast", "--frames", "20", "--out",
                                  out(), "--no-pictures", "--inject", "diverge:rank=1,frame=19,column=5,row=120"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    expectHealed(ended, {{"rank", 1}, {"times", 1}});
    const nlohmann::json told = summary();
    EXPECT_EQ(told["divergences"], 1);
    EXPECT_EQ(told["healed"], 1);
    EXPECT_EQ(told["unhealed"], 0);
    EXPECT_TRUE(support::holds(told["compared"], {{"at_end", true}, {"last_whole", 20}, {"frames_since", 0}}))
        << told["compared"];
    EXPECT_GE(told["compared"]["first_difference"], 19);
    EXPECT_TRUE(told["journal"]["whole"]);
    EXPECT_EQ(told["state_hash"], replayedHash());
}

TEST_F(Healing, LetsTheJournalDecideATie) {
    // One render rank and the master disagree. First the rank is right, then the master, then neither.
    const Ended ended = dig(wall(1, 1),
                            {"diverge:rank=0,frame=2", "diverge:rank=1,frame=22", "diverge:rank=0,frame=42",
                             "diverge:rank=1,frame=42,column=64,row=64"},
                            "out");
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_TRUE(ended.has("divergence", {{"judge", "journal"}, {"agreeing", 0}})) << ended.output;
    expectHealed(ended, {{"rank", 0}, {"source", "rank"}, {"source_rank", 1}});
    expectHealed(ended, {{"rank", 1}, {"source", "rank"}, {"source_rank", 0}, {"times", 1}});
    expectHealed(ended, {{"rank", 0}, {"source", "journal"}, {"times", 2}});
    EXPECT_EQ(summary()["divergences"], 3);
    EXPECT_EQ(summary()["healed"], 4);
    EXPECT_EQ(summary()["state_hash"], replayedHash());
}

// The test flips one bit in two render ranks. With the master they are three ranks, so the wrong ranks are the
// majority.
TEST_F(Healing, LetsTheJournalOutvoteAMajority) {
    ASSERT_EQ(slide({"--steps", "120"}, "undisturbed").status, 0);
    const Ended ended = slide({"--steps", "120", "--inject", "diverge:rank=1,frame=10,column=40,row=64,bit=12",
                               "--inject", "diverge:rank=2,frame=10,column=40,row=64,bit=12"},
                              "out");
    EXPECT_EQ(ended.status, 0) << ended.output;
    expectHealed(ended, {{"rank", 0}, {"source", "rank"}, {"source_rank", 1}});
    const nlohmann::json undisturbed = json("undisturbed/summary.json");
    EXPECT_TRUE(ended.has("journal_check", {{"state", "begun"}})) << ended.output;
    EXPECT_TRUE(ended.has("journal_check", {{"state", "disagreed"}})) << ended.output;
    EXPECT_TRUE(ended.has("journal_check", {{"state", "outvoted"}})) << ended.output;
    for (const int rank : {0, 1, 2}) {
        expectHealed(ended, {{"rank", rank}, {"source", "journal"}, {"times", rank == 0 ? 0 : 1}});
    }
    const nlohmann::json told = summary();
    EXPECT_EQ(told["outvoted"], 1);
    EXPECT_EQ(told["state_hash"], undisturbed["state_hash"]);
    EXPECT_EQ(told["volume_final"], undisturbed["volume_final"]);
    EXPECT_EQ(json("out/incidents.json")["outvoted"], 1);
    EXPECT_EQ(told["state_hash"], replayedHash());
    expectEqualPictures("undisturbed", "out");
    const support::Ran verified = support::runProgram("sandwall-replay", out() + "/session.journal --verify");
    EXPECT_EQ(verified.status, 0) << verified.output;
}

// The sand of both render ranks is right.
TEST_F(Healing, LetsTheJournalOutvoteAMajorityWhoseMovementAloneIsWrong) {
    const std::string wallFile = wall(1, 2);
    ASSERT_EQ(dig(wallFile, {}, "undisturbed").status, 0);
    const Ended ended = dig(
        wallFile, {"movement:rank=1,frame=30,column=5,row=120", "movement:rank=2,frame=30,column=5,row=120"}, "out");
    EXPECT_EQ(ended.status, 0) << ended.output;
    expectHealed(ended, {{"frame", 30}, {"rank", 0}, {"source", "rank"}, {"source_rank", 1}});
    EXPECT_TRUE(ended.has("journal_check", {{"state", "disagreed"}})) << ended.output;
    EXPECT_NE(ended.output.find("it had other steps in which its sand moved last"), std::string::npos) << ended.output;
    for (const int rank : {0, 1, 2}) {
        expectHealed(ended, {{"rank", rank}, {"source", "journal"}, {"times", rank == 0 ? 0 : 1}});
    }
    EXPECT_EQ(summary()["outvoted"], 1);
    EXPECT_EQ(summary()["state_hash"], json("undisturbed/summary.json")["state_hash"]);
    expectEqualPictures("undisturbed", "out");
}

// The session is killed while the wall shows the sand of the wrong majority, and is resumed.
TEST_F(Healing, ResumesASessionThatWasKilledWithAWrongMajority) {
    std::vector<std::string> arguments{"--wall",
                                       wall(1, 2),
                                       "--scene",
                                       scene(),
                                       "--device",
                                       "script:gis",
                                       "--out",
                                       out(),
                                       "--no-pictures",
                                       "--inject",
                                       "diverge:rank=1,frame=60,bit=12",
                                       "--inject",
                                       "diverge:rank=2,frame=60,bit=12"};
    auto session = start(arguments);
    EXPECT_FALSE(session->waitForEvent("journal_check", {{"state", "begun"}}).is_null()) << session->output();
    const std::filesystem::path journal = folder_ / "out/session.journal";
    EXPECT_TRUE(session->waitUntil([&] { return test::lengthWithDoubt(journal).has_value(); }))
        << "the next step notes the majority";
    kill(support::findProgram(session->family(), "sandwall-master").value(), SIGKILL);
    EXPECT_NE(session->wait(kLong).value_or(0), 0) << session->output();
    // The journal may have outvoted the majority before the kill, and written a checkpoint. So they are cut to
    // what a kill a little earlier would have left.
    const std::optional<std::uintmax_t> length = test::lengthWithDoubt(journal);
    ASSERT_TRUE(length.has_value());
    std::filesystem::resize_file(journal, *length);
    std::filesystem::remove_all(folder_ / "out/checkpoints");
    const int before = outvotedSoFar();
    const Ended ended = runToEnd(
        {"--wall", wall(1, 2), "--out", out(), "--no-pictures", "--resume", "--steps", "400", "--pace", "fast"});
    EXPECT_EQ(ended.status, 0) << ended.output;
    const nlohmann::json told = summary();
    EXPECT_EQ(told["steps"], 400);
    EXPECT_EQ(told["volume_final"], told["volume_initial"]);
    EXPECT_EQ(told["state_hash"], replayedHash());
    EXPECT_EQ(told["outvoted"], before + 1);
}

TEST_F(Healing, GivesUpARankThatNeedsItAThirdTime) {
    const Ended ended = dig(wall(1, 2),
                            {"diverge:rank=2,frame=2,column=5,row=120", "diverge:rank=2,frame=22,column=5,row=120",
                             "diverge:rank=2,frame=42,column=5,row=120"},
                            "out");
    EXPECT_EQ(ended.status, 1) << ended.output;
    EXPECT_EQ(summary()["divergences"], 3);
    EXPECT_EQ(summary()["healed"], 2);
    const nlohmann::json failure = json("out/failure.json");
    EXPECT_TRUE(support::holds(failure, {{"what", "broken"}, {"rank", 2}, {"tile", "r1c2"}, {"host", host()}}))
        << failure;
    EXPECT_TRUE(ended.has("failure", {{"failure", failure}})) << ended.output;
    EXPECT_EQ(summary()["unhealed"], 1);
    EXPECT_EQ(summary()["journal"]["whole"], false) << "it has no end";
    const nlohmann::json compared = summary()["compared"];
    EXPECT_EQ(compared["at_end"], false);
    EXPECT_GT(compared["frames_since"], 0);
    EXPECT_LT(compared["first_difference"], 22) << "the first of the three faults";
    // Every step is in the journal, so a resumed session loses nothing.
    EXPECT_EQ(reproduced(ended).size(), 16U);
}

}  // namespace
