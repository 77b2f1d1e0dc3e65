// SPDX-License-Identifier: Apache-2.0
#include "tests/cluster/session_fixture.hpp"

namespace {

/// Ranks whose memory goes wrong while the wall runs.
class Healing : public SessionTest {
protected:
    /// A fast session of 75 frames or more, with faults. A flip lies idle until its hash tile is read again from
    /// memory, 16 frames at most: two that lie further apart are found one by one.
    Ended dig(const std::string& wallFile, const std::vector<std::string>& faults, const std::string& folder) {
        std::vector<std::string> arguments{"--wall",   wallFile,     "--scene", scene(),
                                           "--device", "script:gis", "--pace",  "fast",
                                           "--steps",  "300",        "--out",   (folder_ / folder).string()};
        for (const std::string& fault : faults) {
            arguments.insert(arguments.end(), {"--inject", fault});
        }
        return runToEnd(arguments);
    }
    [[nodiscard]] nlohmann::json json(const std::string& file) const { return nlohmann::json::parse(read(file)); }

    /// What the command that a session prints says.
    std::string reproduced(const std::string& output) {
        const std::string before = "reproduce the right hash with: ";
        const auto at = output.find(before);
        EXPECT_NE(at, std::string::npos) << output;
        const std::string command = output.substr(at + before.size(), output.find('\n', at) - at - before.size());
        support::ChildProcess replay({"/bin/sh", "-c", command}, folder_ / "replay.txt");
        EXPECT_EQ(replay.wait(60), 0);
        const std::string printed = replay.output();
        return printed.size() < 17 ? "" : printed.substr(printed.size() - 17, 16);
    }

    void expectEqualPictures(const std::string& one, const std::string& other) {
        int pictures = 0;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / one)) {
            const std::string name = entry.path().filename().string();
            if (entry.path().extension() == ".png") {
                ++pictures;
                EXPECT_EQ(read(one + "/" + name) == read(other + "/" + name), true) << name;
            }
        }
        EXPECT_EQ(pictures, 7) << "two eyes of two tiles, of the wall, and for red-cyan glasses";
    }
};

TEST_F(Healing, LeavesNoTraceInPicturesAndSand) {
    const std::string wallFile = wall(1, 2);
    ASSERT_EQ(dig(wallFile, {}, "undisturbed").status, 0);
    // A render rank early on, the master, and the render rank again with a cell that is dug by then.
    const Ended ended = dig(wallFile,
                            {"diverge:rank=2,frame=2,column=5,row=120", "diverge:rank=0,frame=22",
                             "diverge:rank=2,frame=42,column=64,row=64"},
                            "out");
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("rank 2 (tile r1c2) on " + host() + " holds other sand than 2 of 3 ranks"),
              std::string::npos)
        << ended.output;
    EXPECT_NE(ended.output.find("first in hash tile 12 (columns 0..31, rows 96..127), 1 cells of it"),
              std::string::npos)
        << ended.output;
    EXPECT_NE(ended.output.find("rank 2 (tile r1c2) on " + host() + " takes the sand of the master; healed 1 of"),
              std::string::npos)
        << ended.output;
    EXPECT_NE(ended.output.find("the master takes the sand of rank 1 (tile r1c1) on " + host()), std::string::npos)
        << ended.output;
    EXPECT_NE(ended.output.find("and not " + reproduced(ended.output)), std::string::npos) << ended.output;

    const nlohmann::json healed = summary();
    EXPECT_EQ(healed["divergences"], 3);
    EXPECT_EQ(healed["healed"], 3);
    EXPECT_EQ(healed["master_healed"], 1);
    EXPECT_EQ(healed["per_rank"][0]["healed"], 0);
    EXPECT_EQ(healed["per_rank"][1]["healed"], 2);
    EXPECT_EQ(healed["per_rank"][1]["frames_differed"], 2);
    EXPECT_EQ(healed["server_divergences"], 0) << "the haptic server was right all along";
    EXPECT_EQ(healed["state_hash"], json("undisturbed/summary.json")["state_hash"]);
    expectEqualPictures("undisturbed", "out");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/failure.json"));
}

// A column of sand four cells high stands in the midst of a dune that slides, in the frame whose pictures are kept.
TEST_F(Healing, DrawsTheFrameInWhichItHappensAnew) {
    const std::string dunes = write("dunes.toml",
                                    "name = \"dunes\"\n[field]\ncolumns = 128\nrows = 128\n[terrain]\nkind = "
                                    "\"dunes\"\ndune_height = 0.4\n[material]\ntalus_deg = 15\n[tool]\n");
    const auto slide = [&](const std::string& folder, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"--wall", wall(1, 2), "--scene", dunes,   "--pace",
                                           "fast",   "--frames", "20",      "--out", (folder_ / folder).string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runToEnd(arguments);
    };
    ASSERT_EQ(slide("undisturbed", {}).status, 0);
    const Ended ended = slide("out", {"--inject", "diverge:rank=1,frame=20,column=40,row=64,bit=18", "--inject",
                                      "diverge:rank=2,frame=20,column=40,row=64,bit=19"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("frame 20: rank 1 (tile r1c1) on " + host() + " takes the sand of the "),
              std::string::npos)
        << ended.output;
    EXPECT_EQ(summary()["state_hash"], json("undisturbed/summary.json")["state_hash"]);
    expectEqualPictures("undisturbed", "out");
}

TEST_F(Healing, LetsTheJournalDecideATie) {
    const std::string wallFile = wall(1, 1);
    ASSERT_EQ(dig(wallFile, {}, "undisturbed").status, 0);
    // One render rank against the master: first he is right, then the master, then neither.
    const Ended ended = dig(wallFile,
                            {"diverge:rank=0,frame=2", "diverge:rank=1,frame=22", "diverge:rank=0,frame=42",
                             "diverge:rank=1,frame=42,column=64,row=64"},
                            "out");
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("the master takes the sand of rank 1 (tile r1c1)"), std::string::npos) << ended.output;
    EXPECT_NE(ended.output.find("no hash has a majority; the journal says"), std::string::npos) << ended.output;
    EXPECT_NE(ended.output.find("rank 1 (tile r1c1) on " + host() + " takes the sand of the master; healed 1 of"),
              std::string::npos)
        << ended.output;
    EXPECT_NE(ended.output.find("the master takes the sand of the journal; healed 2 of"), std::string::npos)
        << ended.output;
    EXPECT_EQ(summary()["divergences"], 3);
    EXPECT_EQ(summary()["healed"], 4);
    EXPECT_EQ(summary()["state_hash"], json("undisturbed/summary.json")["state_hash"]);
}

TEST_F(Healing, GivesUpARankThatNeedsItAThirdTime) {
    const Ended ended = dig(wall(1, 2),
                            {"diverge:rank=2,frame=2,column=5,row=120", "diverge:rank=2,frame=22,column=5,row=120",
                             "diverge:rank=2,frame=42,column=5,row=120"},
                            "out");
    EXPECT_EQ(ended.status, 1) << ended.output;
    const std::string line = "rank 2 (tile r1c2) on " + host() + " needs to be healed a third time and is given up";
    EXPECT_NE(ended.output.find(line), std::string::npos) << ended.output;
    EXPECT_EQ(summary()["divergences"], 3);
    EXPECT_EQ(summary()["healed"], 2);
    const nlohmann::json failure = json("out/failure.json");
    EXPECT_EQ(failure["what"], "broken");
    EXPECT_EQ(failure["rank"], 2);
    EXPECT_EQ(failure["tile"], "r1c2");
    EXPECT_EQ(failure["host"], host());
    EXPECT_NE(failure["message"].get<std::string>().find(line), std::string::npos) << failure;
    // Every step is there, and no end: whoever takes the session up again loses nothing.
    EXPECT_NE(ended.output.find("and not " + reproduced(ended.output)), std::string::npos) << ended.output;
}

}  // namespace
