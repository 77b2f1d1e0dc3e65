// SPDX-License-Identifier: Apache-2.0
// The ports of a session on one host that other hosts can reach.
#include <cstdio>
#include <regex>
#include <set>
#include <sstream>

#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/mpirun.hpp"

namespace {

using Listening = SessionTest;

TEST_F(Listening, NothingButMpirunItselfListensBeyondThisMachine) {
    const auto session = start({"--wall", wall(1, 2), "--scene", scene(), "--device", "script:gis", "--out", out(),
                                "--no-pictures", "--steps", "100000"});
    expectHand(*session);
    const std::vector<pid_t> family = session->family();
    FILE* pipe = popen("ss -ltnpH", "r");
    ASSERT_NE(pipe, nullptr);
    std::string text;
    std::array<char, 4096> piece{};
    while (fgets(piece.data(), piece.size(), pipe) != nullptr) {
        text += piece.data();
    }
    ASSERT_EQ(pclose(pipe), 0) << "install ss: it is in Debian's package iproute2";
    session->type("stop");
    std::istringstream lines(text);
    std::set<std::string> local, elsewhere;
    const std::regex user("\\(\\(\"([^\"]+)\",pid=([0-9]+)");
    for (std::string line; std::getline(lines, line);) {
        std::smatch found;
        if (!std::regex_search(line, found, user) ||
            std::find(family.begin(), family.end(), std::stoi(found[2])) == family.end()) {
            continue;  // belongs to another process
        }
        std::istringstream columns(line);
        std::string address;
        columns >> address >> address >> address >> address;
        const bool loopback = address.rfind("127.", 0) == 0 || address.rfind("[::1]", 0) == 0;
        (loopback ? local : elsewhere).insert(found[1]);
    }
    elsewhere.erase(support::mpirunProcess());
    EXPECT_TRUE(elsewhere.empty()) << *elsewhere.begin() << " listens on an address that other hosts can reach:\n"
                                   << text;
    EXPECT_TRUE(local.contains("sandwall-haptic")) << "this test must see at least the haptic server's port\n" << text;
    expectInOrder(*session);
}

}  // namespace
