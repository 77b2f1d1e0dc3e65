// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "base/not_yet_error.hpp"
#include "pictures/png_file.hpp"
#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/mpirun.hpp"

namespace {

/// Sessions over several hosts. The hosts are this machine under other names, reached by a script in place of ssh.
/// Ranks of different names talk over TCP, as ranks of different machines do.
class Hosts : public SessionTest {
protected:
    void SetUp() override { useAgent(support::hasOpenMpi5()); }
    /// Open MPI shares files within a machine. Its daemons would make the same folders and map the same files for both
    /// hosts, and sometimes a daemon fails because of that. So each host has a folder of its own. Open MPI 5 also needs
    /// hosts that have their `own names`.
    void useAgent(bool ownNames) {
        const std::string agent = write(
            "agent",
            "#!/bin/sh\nhost=$1; shift\n[ \"$host\" = away ] && exit 255\n"
            "export TMPDIR=\"${0%/*}/$host\"\n"
            "export OMPI_MCA_btl_vader_backing_directory=\"$TMPDIR\"\n"
            "mkdir -p \"$TMPDIR\"\n" +
                std::string(ownNames ? "exec unshare --uts sh -c \"hostname $host; $*\"\n" : "exec sh -c \"$*\"\n"));
        std::filesystem::permissions(agent, std::filesystem::perms::owner_all);
        setenv("OMPI_MCA_plm_rsh_agent", agent.c_str(), 1);
    }
    void TearDown() override { unsetenv("OMPI_MCA_plm_rsh_agent"); }

    /// Runs a session of 40 steps on the hosts that the arguments `where` name, and returns its summary.
    nlohmann::json show(std::vector<std::string> where) {
        where.insert(where.end(), {"--wall", wall(2, 2, "mono"), "--scene", scene(), "--device", "script:gis", "--pace",
                                   "fast", "--steps", "40", "--out", out()});
        std::filesystem::remove_all(out());
        const Ended ended = runToEnd(where);
        EXPECT_EQ(ended.status, 0) << ended.output;
        return summary();
    }
};

TEST_F(Hosts, ShowTheSameSandAndPictureAsOneMachine) {
    const nlohmann::json here = show({"--here"});
    const pictures::Image picture = pictures::readPng(out() + "/wall.png");
    const std::string hosts = write("hosts", "node1 slots=2\nlocalhost\nnode2\n");
    const nlohmann::json over = show({"--hosts", hosts, "--network", "127.0.0.0/8"});
    EXPECT_EQ(over["state_hash"], here["state_hash"]);
    EXPECT_EQ(over["divergences"], 0);
    EXPECT_TRUE(pictures::readPng(out() + "/wall.png").rgb == picture.rgb);
}

TEST_F(Hosts, EndWithTheLauncher) {
    const std::string hosts = write("hosts", "node1 slots=2\nlocalhost\nnode2\n");
    const auto session = start({"--wall", wall(2, 2, "mono"), "--scene", scene(), "--out", out(), "--hosts", hosts,
                                "--network", "127.0.0.0/8"});
    expectFrames(*session);
    const std::vector<pid_t> family = session->family();
    EXPECT_TRUE(support::findProgram(family, "sandwall-master").has_value())
        << "the master, which an Open MPI daemon has started, is missing";
    session->signal(SIGKILL);
    EXPECT_TRUE(support::waitUntilGone(family, kLong).empty()) << "processes are still running";
    EXPECT_EQ(summary()["divergences"], 0) << "the master must end in order when its input ends";
}

// A wrapper of mpirun exchanges two hosts, as another numbering of ranks would.
TEST_F(Hosts, AWrongPlacementIsRefused) {
    if (support::runCommand("unshare --uts hostname other").status != 0) {
        GTEST_SKIP() << "this user may not give a host a name of its own";
    }
    useAgent(true);
    const std::string real = support::runCommand("command -v mpirun").output;
    const std::string wrapper = write(
        "mpirun",
        "#!/bin/bash\nwords=() before=''\nfor word in \"$@\"; do\n"
        "  case $before in\n    --host) word=$(sed 's/node1/nodeX/; s/node2/node1/; s/nodeX/node2/' <<<\"$word\") ;;\n"
        "    --hostfile) sed 's/node1/nodeX/; s/node2/node1/; s/nodeX/node2/' \"$word\" >\"$word.other\"; "
        "word=$word.other ;;\n  esac\n"
        "  words+=(\"$word\") before=$word\ndone\nexec " +
            real.substr(0, real.find('\n')) + " \"${words[@]}\"\n");
    std::filesystem::permissions(wrapper, std::filesystem::perms::owner_all);
    environment_ = {"PATH=" + folder_.string() + ":" + std::getenv("PATH")};
    const Ended ended = runToEnd({"--wall", wall(1, 2, "mono"), "--scene", scene(), "--out", out(), "--steps", "5",
                                  "--hosts", write("hosts", "node1\nnode2\n"), "--network", "127.0.0.0/8"});
    expectOneLine(ended, "rank 1 (tile r1c1): mpirun has started it on node2, but its host is node1");
}

TEST_F(Hosts, AHostThatCannotBeReachedIsOneLine) {
    const Ended ended = runToEnd({"--wall", wall(2, 2, "mono"), "--scene", scene(), "--out", out(), "--hosts",
                                  write("hosts", "node1 slots=3\naway\n")});
    expectOneLine(ended, "away (rank 4): ", base::kExitNotYet);
}

}  // namespace
