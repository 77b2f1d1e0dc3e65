// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "lockstep/host_memory.hpp"
#include "tests/cluster/session_fixture.hpp"

namespace {

/// What a user gets wrong: one line, no banner of mpirun around it, exit status 2.
class BadInput : public SessionTest {
protected:
    void expectOneLine(const std::vector<std::string>& arguments, const std::string& part) {
        const Ended ended = runToEnd(arguments, 60);
        EXPECT_EQ(ended.status, 2) << ended.output;
        EXPECT_EQ(std::count(ended.output.begin(), ended.output.end(), '\n'), 1) << ended.output;
        EXPECT_NE(ended.output.find(part), std::string::npos) << ended.output;
    }
};

TEST_F(BadInput, MissingFilesAreNamed) {
    expectOneLine({"--wall", "nowhere.toml", "--scene", scene(), "--out", out()}, "nowhere.toml: cannot be read");
    expectOneLine({"--wall", wall(1, 1), "--scene", "nowhere.toml", "--out", out()}, "nowhere.toml: cannot be read");
    expectOneLine({"--wall", wall(1, 1), "--scene", scene(), "--out", out(), "--device", "trace:nowhere.csv"},
                  "nowhere.csv");
}

TEST_F(BadInput, MalformedFilesAreNamedWithTheirLine) {
    const std::string broken = write("broken.toml", "name = \"x\"\n[grid\n");
    expectOneLine({"--wall", broken, "--scene", scene(), "--out", out()}, "broken.toml:2: ");
    expectOneLine({"--wall", wall(1, 1), "--scene", broken, "--out", out()}, "broken.toml:2: ");
    const std::string trace = write("t.csv", "time,x,y,z\n0.0,1,2,3\n0.001,1,zwei,3\n");
    expectOneLine({"--wall", wall(1, 1), "--scene", scene(), "--out", out(), "--device", "trace:" + trace},
                  "t.csv:3: ");
    write("dem.asc", "ncols 2\nnrows 1\ncellsize 1\n5 x\n");
    const std::string dem = write("dem.toml", "[terrain]\nkind = \"esri_ascii\"\nfile = \"dem.asc\"\n[material]\n");
    expectOneLine({"--wall", wall(1, 1), "--scene", dem, "--out", out()}, "dem.asc:4: ");
}

TEST_F(BadInput, AnUnknownDeviceAndAFolderThatCannotBeAreNamed) {
    expectOneLine({"--wall", wall(1, 1), "--scene", scene(), "--out", out(), "--device", "glove"}, "glove");
    const std::string file = write("file", "");
    expectOneLine({"--wall", wall(1, 1), "--scene", scene(), "--out", file + "/out"}, "choose another --out");
}

TEST_F(BadInput, AFieldThatDoesNotFitTheMemoryIsRefused) {
    // Three replicas of it are 12 GiB, and a machine that has that for a test is asked for more.
    const std::int64_t free = lockstep::freeMemory();
    if (free > std::int64_t{48} << 30) {
        GTEST_SKIP() << "this machine has more memory than the largest field takes";
    }
    const int ranks = static_cast<int>(free >> 32) + 1;
    const std::string huge =
        write("huge.toml",
              "[field]\ncolumns = 16384\nrows = 16384\n[terrain]\nheight = 0.2\n[material]\n[tool]\nradius = 0.04\n");
    expectOneLine({"--wall", wall(1, ranks), "--scene", huge, "--out", out()},
                  "huge.toml: 16384 x 16384 cells need at least");
}

TEST_F(BadInput, AWallThatDoesNotFitTheRanksIsRefusedByTheMaster) {
    const std::string bin = SANDWALL_BIN_DIR;
    const std::string command =
        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 HWLOC_COMPONENTS=-gl exec mpirun -q "
        "--oversubscribe --bind-to none"
        " --mca btl self,vader -n 1 " +
        bin + "/sandwall-master --scene " + scene() + " --wall " + wall(2, 2) + " --out " + out() + " : -n 3 " + bin +
        "/sandwall-render-node";
    support::ChildProcess job({"/bin/sh", "-c", command}, folder_ / "output.txt");
    EXPECT_EQ(job.wait(60), 2) << job.output();
    const std::string output = job.output();
    EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
    EXPECT_NE(output.find("4 tiles need 4 render ranks, but the job has 3"), std::string::npos) << output;
}

}  // namespace
