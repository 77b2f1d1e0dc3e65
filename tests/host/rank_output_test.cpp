// SPDX-License-Identifier: Apache-2.0
#include "host/rank_output.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <utility>

#include "host/event.hpp"
#include "host/print_line.hpp"
#include "tests/support/files/folder_test.hpp"

namespace {

class RankOutput : public test::FolderTest {
protected:
    /// Runs `work` in a process whose standard error and way to the launcher are files. Returns (error, relayed).
    std::pair<std::string, std::string> ran(const std::function<void()>& work) {
        const pid_t child = fork();
        if (child == 0) {
            const auto open = [&](const char* name, int descriptor) {
                return dup2(::open((folder_ / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600),
                            descriptor);
            };
            if (open("error", STDERR_FILENO) < 0 || open("relayed", 9) < 0) {
                _exit(77);
            }
            setenv("SANDWALL_RELAY", "9", 1);
            setenv("PMIX_RANK", "3", 1);
            work();
            _exit(0);
        }
        int status = -1;
        EXPECT_EQ(waitpid(child, &status, 0), child);
        EXPECT_EQ(status, 0);
        return {read("error"), read("relayed")};
    }
    [[nodiscard]] std::string read(const char* name) const {
        std::ifstream stream(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
};

// zlib.crc32(b"3 hello") of Python; open_mpi_test.py reads such lines.
TEST_F(RankOutput, ARelayedLineHasRankLengthAndChecksum) {
    EXPECT_EQ(host::relayedLine(3, "hello"), "@rank 3 5 f379341c hello");
}

TEST_F(RankOutput, LinesAndEventsGoToStandardErrorAndToTheLauncher) {
    const auto [error, relayed] = ran([] {
        host::printLine("{} words", 2);
        host::writeLine(host::eventLine("drill", {{"frame", 30}}) + "\n");
    });
    const std::string line = std::string(program_invocation_short_name) + ": 2 words";
    const std::string event = R"(@sandwall {"event":"drill","frame":30})";
    EXPECT_EQ(error, line + "\n" + event + "\n");
    EXPECT_EQ(relayed, host::relayedLine(3, line) + "\n" + host::relayedLine(3, event) + "\n");
}

TEST_F(RankOutput, TheRanksFileIsToldAndRemovedAtAGoodEnd) {
    const std::string path = (folder_ / "log").string();
    const auto [error, relayed] = ran([&] {
        setenv("SANDWALL_RANK_LOG", path.c_str(), 1);
        close(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
        host::sendRankLog();
        host::removeRankLog();
    });
    EXPECT_EQ(error, "");
    std::array<char, 256> name{};
    gethostname(name.data(), name.size() - 1);
    EXPECT_EQ(relayed, host::relayedLine(3, "@log " + std::string(name.data()) + ":" + path) + "\n");
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(RankOutput, ALineThatTheFileDoesNotTakeGoesToTheLauncher) {
    const auto [error, relayed] = ran([] {
        unsetenv("SANDWALL_RELAY");
        setenv("SANDWALL_RELAY_LOST", "9", 1);
        host::writeLine("kept\n");
        close(STDERR_FILENO);
        host::writeLine("lost\n");
    });
    EXPECT_EQ(error, "kept\n");
    EXPECT_EQ(relayed, host::relayedLine(3, "lost") + "\n");
}

TEST_F(RankOutput, WithoutAWayToTheLauncherALineGoesToStandardErrorAlone) {
    const auto [error, relayed] = ran([] {
        unsetenv("SANDWALL_RELAY");
        host::writeLine("text\n");
        host::sendRankLog();
    });
    EXPECT_EQ(error, "text\n");
    EXPECT_EQ(relayed, "");
}

}  // namespace
