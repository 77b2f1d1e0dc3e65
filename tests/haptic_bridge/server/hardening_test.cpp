// SPDX-License-Identifier: Apache-2.0
// Checks binaries with readelf: the flags of cmake/Hardening.cmake reach them, and only a few can open a socket.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>

namespace {

std::string outputOf(const std::string& command) {
    std::string text;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 4096> piece{};
    while (pipe != nullptr && fgets(piece.data(), piece.size(), pipe) != nullptr) {
        text += piece.data();
    }
    return pipe != nullptr && pclose(pipe) == 0 ? text : "";
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Hardening, EveryProgramAndModuleHasIt) {
    std::set<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(SANDWALL_BIN_DIR)) {
        const std::string name = entry.path().filename().string();
        if (name.rfind("sandwall-", 0) != 0 || name.find('.', 9) != name.find(".so", 9)) {
            continue;
        }
        SCOPED_TRACE(name);
        const std::string told = outputOf("readelf -hldW " + entry.path().string());
        if (told.empty()) {
            continue;  // a script
        }
        files.insert(name);
        EXPECT_TRUE(holds(told, "DYN (")) << "position-independent";
        EXPECT_TRUE(holds(told, "GNU_RELRO"));
        EXPECT_TRUE(holds(told, "BIND_NOW") || holds(told, "NOW"));
        const std::size_t stack = told.find("GNU_STACK");
        ASSERT_NE(stack, std::string::npos);
        EXPECT_FALSE(holds(told.substr(stack, told.find('\n', stack) - stack), "RWE"));
    }
    // This program depends on these binaries, so they are always built. A list without them means that the test looked
    // in the wrong place.
    for (const char* name : {"sandwall-haptic-server", "sandwall-watch", "sandwall-security.so"}) {
        EXPECT_TRUE(files.contains(name)) << name << " was not checked";
    }
    const std::string symbols = outputOf("readelf --dyn-syms -W " SANDWALL_BIN_DIR "/sandwall-haptic-server");
    EXPECT_TRUE(holds(symbols, "__stack_chk_fail"));
#ifdef SANDWALL_RELEASE
    EXPECT_TRUE(holds(symbols, "_chk@")) << "fortified calls";
#endif
}

/// Returns the socket calls that a binary imports from the C library, or from the library of a sanitizer.
std::set<std::string> networkCallsOf(const std::string& program) {
    std::set<std::string> calls;
    std::istringstream symbols(outputOf("readelf --dyn-syms -W " SANDWALL_BIN_DIR "/" + program));
    for (std::string line; std::getline(symbols, line);) {
        for (const char* call : {"socket", "connect", "bind", "listen", "accept", "accept4", "getaddrinfo"}) {
            const std::string undefined = " UND " + std::string(call);
            if (holds(line, undefined + "@") || line.ends_with(undefined)) {  // a sanitizer's library has no versions
                calls.insert(call);
            }
        }
    }
    return calls;
}

// sandwall-replay runs the force loop of a haptic server, on ticks from a journal.
TEST(Hardening, ReplayOpensNoSocket) {
    EXPECT_EQ(networkCallsOf("sandwall-replay"), std::set<std::string>{});
    EXPECT_TRUE(networkCallsOf("sandwall-haptic-server").contains("listen"))
        << "the check finds calls in a program that has them";
}

}  // namespace
