// SPDX-License-Identifier: Apache-2.0
#include "host/memory.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/mpirun.hpp"

namespace {

/// A user's mistakes. Each is reported in one line, without a banner of mpirun, and with exit status 2. There is one
/// input per program that reads it. The tests beside each program's code test the other inputs that the program
/// refuses.
class BadInput : public SessionTest {
protected:
    void expectRefusal(const std::vector<std::string>& arguments, const std::string& named) {
        expectOneLine(runToEnd(arguments), named);
    }
};

TEST_F(BadInput, OfTheLauncherIsNamed) {
    expectRefusal({"--wall", "nowhere.toml", "--scene", scene(), "--out", out()}, "nowhere.toml");
    expectRefusal({"--wall", wall(1, 1), "--scene", "nowhere.toml", "--out", out()}, "nowhere.toml");
}

TEST_F(BadInput, OfTheHapticServerIsNamed) {
    const std::string trace = write("t.csv", "time,x,y,z\n0.0,1,2,3\n0.001,1,zwei,3\n");
    expectRefusal({"--wall", wall(1, 1), "--scene", scene(), "--out", out(), "--device", "trace:" + trace},
                  "t.csv:3: ");
    const std::vector<std::string> driver{"--wall", wall(1, 1), "--scene",  scene(),
                                          "--out",  out(),      "--device", "driver:/nowhere/my.so"};
    for (const std::vector<std::string>& unsafe :
         {std::vector<std::string>{"--pace", "fast"}, {"--guards", "literal"}}) {
        std::vector<std::string> all = driver;
        all.insert(all.end(), unsafe.begin(), unsafe.end());
        expectRefusal(all, "sandwall-haptic-server: " + unsafe[0] + " " + unsafe[1] + ": ");
    }
    expectRefusal({"--wall", wall(1, 1), "--scene", scene(), "--out", out(), "--device", "glove"}, "glove");
}

TEST_F(BadInput, OfTheMasterIsNamed) {
    const std::string broken = write("broken.toml", "name = \"x\"\n[grid\n");
    expectRefusal({"--wall", wall(1, 1), "--scene", broken, "--out", out()}, "broken.toml:2: ");
    const std::string file = write("file", "");
    expectRefusal({"--wall", wall(1, 1), "--scene", scene(), "--out", file + "/out"}, file + "/out");
    expectRefusal({"--wall", wall(1, 1), "--scene", scene(), "--out", file, "--resume"}, file + ": ");
    expectRefusal({"--wall", wall(1, 1), "--scene", scene(), "--out", out(), "--inject", "slow:rank=9,ms=30"},
                  "--inject slow:rank=9,ms=30");
}

// "SWJL" and format 5: a journal written before release 0.2.0. No program reads such a journal.
TEST_F(BadInput, AJournalThatNoReleaseReadsIsRefusedByTheMaster) {
    std::filesystem::create_directories(out());
    const std::string journal = write("out/session.journal", {'S', 'W', 'J', 'L', 5, 0, 0, 0, 1, 0, 0, 0});
    expectRefusal({"--wall", wall(1, 1), "--out", out(), "--resume"}, journal + ": ");
}

TEST_F(BadInput, AFieldThatDoesNotFitTheMemoryIsRefused) {
    // The launcher refuses it before mpirun starts. A replica of this field needs 4 GiB. On a machine with more memory
    // the test asks for more ranks.
    const std::int64_t free = host::freeMemory();
    if (free > std::int64_t{48} << 30) {
        GTEST_SKIP() << "this machine has more memory than the largest field takes";
    }
    const int ranks = static_cast<int>(free >> 32) + 1;
    const std::string huge =
        write("huge.toml",
              "[field]\ncolumns = 16384\nrows = 16384\n[terrain]\nheight = 0.2\n[material]\n[tool]\nradius = 0.04\n");
    expectRefusal({"--wall", wall(1, ranks), "--scene", huge, "--out", out()}, "huge.toml: needs ");
}

TEST_F(BadInput, AWallThatDoesNotFitTheRanksIsRefusedByTheMaster) {
    const std::string bin = SANDWALL_BIN_DIR;
    const std::string wallFile = wall(2, 2);
    const std::string command =
        support::mpirunHere() + support::programsByRank({{1, bin + "/sandwall-master --scene " + scene() + " --wall " +
                                                                 wallFile + " --out " + out()},
                                                         {3, bin + "/sandwall-render-node"}});
    support::ChildProcess job({"/bin/sh", "-c", command}, folder_ / "output.txt");
    const int status = job.wait(support::ChildProcess::kPatience).value_or(-1);
    expectOneLine({status, support::withoutBanner(job.output())}, wallFile + ": 4 ");
}

}  // namespace
