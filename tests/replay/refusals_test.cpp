// SPDX-License-Identifier: Apache-2.0
// Options, files and steps that sandwall-replay refuses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "host/version.hpp"
#include "tests/replay/replay_fixture.hpp"

namespace {

using test::Replay;

TEST_F(Replay, RefusesARasterOfAnUnknownEnding) {
    record();
    for (const char* option : {" --heights ", " --difference "}) {
        const support::Ran ran =
            support::runProgram("sandwall-replay", journal() + option + (folder_ / "x.foo").string());
        EXPECT_EQ(ran.status, 2);
        EXPECT_NE(ran.output.find("x.foo: no known ending; name it .tif for a GeoTIFF, .asc for an ESRI ASCII grid"),
                  std::string::npos)
            << ran.output;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "x.foo"));
        EXPECT_EQ(support::runProgram("sandwall-replay", journal() + option + "/dev/null").status, 0);
    }
}

TEST_F(Replay, RefusesWhatItWouldNotDoBesideAnother) {
    record();
    const std::string recover = "--recover " + path("new.journal");
    for (const std::string& alone : {std::string("--verify"), recover}) {
        for (const std::string& other :
             {std::string("--hash"), std::string("--volumes"), std::string("--until 10"), "--mesh " + path("z.ply"),
              "--heights " + path("z.asc"), "--difference " + path("z.asc"), "--forces " + path("z.csv"),
              "--export " + path("z.csv"), alone == recover ? std::string("--verify") : recover}) {
            expectRefused(fmt::format("{} {}", alone, other), "excludes");
        }
    }
    for (const char* option : {"--mesh", "--heights", "--difference", "--forces", "--export", "--recover"}) {
        expectRefused(std::string(option) + " ''", "name a file");
    }
}

TEST_F(Replay, RefusesToWriteOneFileOverAnother) {
    record();
    expectRefused("--heights " + path("a.asc") + " --difference " + path("./a.asc"),
                  "--heights and --difference: both name " + path("./a.asc"));
    const std::string before = read("s.journal");
    expectRefused("--export " + journal(), "FILE and --export: both name ");
    EXPECT_EQ(read("s.journal"), before);
    EXPECT_EQ(replay("--heights /dev/null --difference /dev/null").status, 0);
}

TEST_F(Replay, RefusesAFieldThatDoesNotFitItsMemoryBeforeItsHeightsAreMade) {
    sand::Rules rules;
    rules.columns = rules.rows = 16384;
    rules.stepsPerSecond = 60;
    rules.tuning.sweepsPerStep = 8;
    base::ByteWriter scene;
    scene.putText("huge");
    base::putMember(scene, rules);
    journal::JournalHeader header;
    header.session = 1;
    header.scene = scene.take();
    header.material = scene::Material();
    std::uint64_t chain = 0;
    const base::Bytes bytes = journal::encodeHeader(header, host::release(), chain);
    std::ofstream(journal(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    for (const auto& [question, gibibytes] :
         {std::pair("", "4.0"), std::pair("--hash", "4.0"), std::pair("--verify", "4.0"),
          std::pair("--export new", "1.0"), std::pair("--recover new", "1.0"),
          std::pair("--export new --hash", "4.0")}) {
        const support::Ran ran =
            support::runCommand(fmt::format("ulimit -v 1000000; bin=$PWD; cd {} && \"$bin/{}/sandwall-replay\" {} {}",
                                            folder_.string(), SANDWALL_BIN_DIR, journal(), question));
        EXPECT_EQ(ran.status, 2) << question << ": " << ran.output;
        EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
        EXPECT_NE(ran.output.find(fmt::format(" need at least {} GiB, and ", gibibytes)), std::string::npos)
            << question << ": " << ran.output;
        EXPECT_FALSE(std::filesystem::exists(path("new"))) << question;
    }
}

TEST_F(Replay, RefusesALinkInAFolderAndTakesOneThatIsNamed) {
    record();
    const std::filesystem::path session = folder_ / "session";
    std::filesystem::create_directory(session);
    std::filesystem::create_symlink(journal(), session / "session.journal");
    for (const char* question : {"", "--verify", "--hash", "--export /dev/null", "--recover new"}) {
        const support::Ran ran = support::runProgram("sandwall-replay", session.string() + " " + question);
        EXPECT_EQ(ran.status, 2) << question;
        EXPECT_EQ(ran.output, "sandwall-replay: " + (session / "session.journal").string() +
                                  ": is a link, which is not followed; name the journal itself\n")
            << question;
        EXPECT_FALSE(std::filesystem::exists(path("new")));
    }
    for (const char* question : {"", "--verify", "--hash", "--export /dev/null"}) {
        const std::string named = (session / "session.journal").string() + " " + question;
        EXPECT_EQ(support::runProgram("sandwall-replay", named).status, 0) << question;
    }
}

TEST_F(Replay, RefusesStepsBelowZero) {
    record();
    for (const char* number : {"-1", "-99999"}) {
        const support::Ran ran = support::runProgram("sandwall-replay", journal() + " --hash --until " + number);
        EXPECT_EQ(ran.status, 2);
        EXPECT_NE(ran.output.find(std::string("--until: a step's number is 0 or more, got ") + number),
                  std::string::npos)
            << ran.output;
    }
    const std::string start = fmt::format("{:016x}\n", sand::Replica(samples::flatScene(40, 30)).stateHash());
    EXPECT_EQ(support::runProgram("sandwall-replay", journal() + " --hash --until 0").output, start);
}

TEST_F(Replay, RefusesAStepThatIsNotThere) {
    record();
    const support::Ran ran = support::runProgram("sandwall-replay", journal() + " --until 41");
    EXPECT_EQ(ran.status, 2);
    EXPECT_NE(ran.output.find("ends at step 40, before --until 41"), std::string::npos) << ran.output;
}

}  // namespace
