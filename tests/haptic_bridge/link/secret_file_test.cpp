// SPDX-License-Identifier: Apache-2.0
// Tests of accepted secret files, and of the messages about all others.
#include "haptic_bridge/link/secret_file.hpp"

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
                                                                                     {pipe, "not a regular file"},
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

}  // namespace
