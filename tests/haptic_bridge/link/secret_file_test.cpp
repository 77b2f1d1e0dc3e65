// SPDX-License-Identifier: Apache-2.0
// Tests of accepted secret files, and of the messages about all others.
#include "haptic_bridge/link/secret_file.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "base/input_error.hpp"
#include "tests/haptic_bridge/link/link_security_fixture.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;

std::string complaintOf(const std::string& text) {
    try {
        (void)parseSecrets(text, "secrets");
    } catch (const base::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(SecretFile, NamesTheLineAndNeverTheSecret) {
    const Secrets secrets = parseSecrets("# ours\n\n move 0123456789abcdef\r\nwatch\t0123456789abcdeg", "secrets");
    EXPECT_EQ(secrets.move, "0123456789abcdef");
    EXPECT_EQ(secrets.watch, "0123456789abcdeg");
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"move 0123456789abcde", "secrets:1: a secret of 15 characters"},
        {"\nmove", "secrets:2: a secret of 0 characters"},
        {"0123456789abcdef", "secrets:1: does not begin with move or watch"},
        {"move 0123456789abcdef 0123456789abcdef", "secrets:1: holds more"},
        {"move 0123456789abcdef\nmove 0123456789abcdeg", "secrets:2: a second secret of role move"},
        {"move 0123456789abcdef\nwatch 0123456789abcdef", "secrets: has the same secret for both roles"},
        {"move 0123456789\001"
         "bcdef",
         "secrets:1: a secret with characters"},
        {"# nothing", "secrets: holds no secret"},
    };
    for (const auto& [text, complaint] : wrong) {
        EXPECT_EQ(complaintOf(text).find(complaint), 0U) << complaintOf(text);
        EXPECT_EQ(complaintOf(text).find("0123456789"), std::string::npos) << complaintOf(text);
    }
}

TEST_F(LinkSecurityTest, TakesASecretOnlyFromAFileOfItsOwnersAlone) {
    const std::string open = folder_.write("open", "move 0123456789abcdef\n");
    chmod(open.c_str(), 0640);
    const std::string pipe = folder_.file("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const std::string large = secretFile("large", std::string(kMaxSecretFile + 1, '#'));
    for (const auto& [file, word] : std::vector<std::pair<std::string, std::string>>{{open, "other users may read"},
                                                                                     {pipe, "is not a regular file"},
                                                                                     {folder_.file("none"), "cannot"},
                                                                                     {large, "larger than"}}) {
        try {
            (void)readSecrets(file);
            ADD_FAILURE() << file;
        } catch (const base::InputError& error) {
            EXPECT_EQ(std::string(error.what()).find(file), 0U) << error.what();
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
    }
}

TEST_F(LinkSecurityTest, TakesASecretOnlyFromAFileOfItsOwnUser) {
    if (geteuid() != 0) {
        GTEST_SKIP() << "only root can give a file to another user";
    }
    const std::string file = secretFile("theirs", "move 0123456789abcdef\n");
    ASSERT_EQ(chown(file.c_str(), 1, 1), 0);
    LinkOptions options;
    options.secretFile = file;
    EXPECT_THROW((void)options.forClient(Role::move), base::InputError);
    options.secretFile = secretFile("ours", "move 0123456789abcdef\n");
    options.tls = true;
    options.certificate = options.key = file;
    try {
        (void)options.forServer();
        ADD_FAILURE() << "the key of another user was read";
    } catch (const base::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("belongs to another user"), std::string::npos) << error.what();
    }
}

TEST_F(LinkSecurityTest, TakesACertificateOnlyFromAFileThatItMayTrust) {
    LinkOptions options;
    options.secretFile = secretFile("ours", "move 0123456789abcdef\n");
    options.tls = true;
    options.key = secretFile("key", "-----BEGIN PRIVATE KEY-----\n");
    const auto complaint = [&](const std::string& file) -> std::string {
        options.certificate = file;
        try {
            (void)options.forServer();
        } catch (const base::InputError& error) {
            return error.what();
        }
        return "";
    };
    const std::string none = folder_.file("none"), pipe = folder_.file("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(complaint(none),
              none + ": cannot be read (No such file or directory); give --tls-cert a file that you can read");
    EXPECT_EQ(complaint(pipe),
              pipe + ": cannot be read (is not a regular file); give --tls-cert a file that you can read");
    const std::string both = folder_.write("both", "-----BEGIN EC PRIVATE KEY-----\n");
    chmod(both.c_str(), 0644);
    EXPECT_EQ(complaint(both), both +
                                   ": other users may read or change it; make a new key in a file of your own, and run "
                                   "chmod 600 on it");
    const std::string certificate = folder_.write("certificate", "-----BEGIN CERTIFICATE-----\n");
    chmod(certificate.c_str(), 0644);
    EXPECT_EQ(complaint(certificate).find("--tls: "), 0U) << "everybody may read it, but it is no certificate";
}

/// Runs `work` in a child process that may dump core into `folder`, and crashes it. Returns whether it dumped core.
template <class Work>
bool dumpsCore(const std::string& folder, const Work& work) {
    const pid_t child = fork();
    if (child == 0) {
        const rlimit all{RLIM_INFINITY, RLIM_INFINITY};
        if (chdir(folder.c_str()) != 0 || setrlimit(RLIMIT_CORE, &all) != 0) {
            _exit(0);
        }
        work();
        signal(SIGABRT, SIG_DFL);
        abort();
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) && WCOREDUMP(status);
}

// Sanitizers allow no core dumps.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// A suite of its own, so that ctest runs it in a process of its own: after a test has read a secret, only a process
/// with CAP_SYS_RESOURCE can allow core dumps again.
class CoreDump : public LinkSecurityTest {};

TEST_F(CoreDump, HoldsNoSecret) {
    const std::string file = secretFile("secret", "move 0123456789abcdef\n");
    const std::string folder = std::filesystem::path(file).parent_path();
    if (!dumpsCore(folder, [] {})) {
        GTEST_SKIP() << "this machine allows no core dumps";
    }
    EXPECT_FALSE(dumpsCore(folder, [&] { (void)readSecrets(file); }));
}
#endif

}  // namespace
