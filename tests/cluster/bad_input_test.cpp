// SPDX-License-Identifier: Apache-2.0
#include "host/memory.hpp"
#include "tests/cluster/session_fixture.hpp"

namespace {

/// What a user gets wrong: one line, no banner of mpirun around it, exit status 2. One input per program that reads it;
/// what each program refuses is tested beside its code.
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

// "SWJL" and format 5: a journal from before release 0.2.0, which no program reads.
TEST_F(BadInput, AJournalThatNoReleaseReadsIsRefusedByTheMaster) {
    std::filesystem::create_directories(out());
    const std::string journal = write("out/session.journal", {'S', 'W', 'J', 'L', 5, 0, 0, 0, 1, 0, 0, 0});
    expectRefusal({"--wall", wall(1, 1), "--out", out(), "--resume"}, journal + ": ");
}

TEST_F(BadInput, AFieldThatDoesNotFitTheMemoryIsRefused) {
    // Three replicas of it are 12 GiB, and a machine that has that for a test is asked for more.
    const std::int64_t free = host::freeMemory();
    if (free > std::int64_t{48} << 30) {
        GTEST_SKIP() << "this machine has more memory than the largest field takes";
    }
    const int ranks = static_cast<int>(free >> 32) + 1;
    const std::string huge =
        write("huge.toml",
              "[field]\ncolumns = 16384\nrows = 16384\n[terrain]\nheight = 0.2\n[material]\n[tool]\nradius = 0.04\n");
    expectRefusal({"--wall", wall(1, ranks), "--scene", huge, "--out", out()}, "huge.toml: 16384 x 16384 ");
}

TEST_F(BadInput, AWallThatDoesNotFitTheRanksIsRefusedByTheMaster) {
    const std::string bin = SANDWALL_BIN_DIR;
    const std::string wallFile = wall(2, 2);
    const std::string command =
        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 HWLOC_COMPONENTS=-gl exec mpirun -q "
        "--oversubscribe --bind-to none --mca odls_base_sigkill_timeout 0"
        " --mca btl self,vader -n 1 " +
        bin + "/sandwall-master --scene " + scene() + " --wall " + wallFile + " --out " + out() + " : -n 3 " + bin +
        "/sandwall-render-node";
    support::ChildProcess job({"/bin/sh", "-c", command}, folder_ / "output.txt");
    const int status = job.wait(support::ChildProcess::kPatience).value_or(-1);
    expectOneLine({status, job.output()}, wallFile + ": 4 ");
}

}  // namespace
