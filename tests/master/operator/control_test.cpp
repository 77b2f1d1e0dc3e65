// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "base/input_error.hpp"
#include "master/operator/control_socket.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/noting_desk.hpp"

namespace {

using master::ControlSocket;
using support::noted;

std::string complaint(const std::string& line) {
    try {
        (void)noted(line);
    } catch (const base::InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(OperatorCommand, EveryVerbAsksTheDeskForItsDeed) {
    std::set<std::string> tried;
    const auto deedOf = [&](const std::string& line) {
        tried.insert(line.substr(0, line.find(' ')));
        return noted(line);
    };
    for (const std::string verb : {"status", "pause", "resume", "capture", "film", "stop"}) {
        EXPECT_EQ(deedOf(verb).did, verb);
    }
    EXPECT_EQ(deedOf("reset").edit, sand::Edit::reset);
    EXPECT_EQ(deedOf("undo").edit, sand::Edit::undo);
    EXPECT_EQ(deedOf("redo").did, "redo");
    EXPECT_EQ(deedOf("settle").edit, sand::Edit::settle);
    EXPECT_EQ(deedOf("pattern ramp").pattern, lockstep::Pattern::ramp);
    EXPECT_EQ(noted("pattern none").pattern, lockstep::Pattern::none);
    EXPECT_EQ(noted("pattern next").did, "pattern");
    EXPECT_FALSE(noted("pattern next").pattern.has_value());
    EXPECT_EQ(deedOf("show hill-shade").layer, lockstep::Overlay::hillShade);
    EXPECT_EQ(noted("show hill-shade").did, "show");
    EXPECT_EQ(deedOf("hide statistics").layer, lockstep::Overlay::statistics);
    EXPECT_EQ(noted("hide statistics").did, "hide");
    EXPECT_DOUBLE_EQ(deedOf("eye-separation 0.5").number, 0.5);
    EXPECT_DOUBLE_EQ(noted("eye-separation 0").number, 0);
    EXPECT_EQ(deedOf("stereo anaglyph").stereo, walls::Stereo::anaglyphColour);
    EXPECT_EQ(deedOf("swap-eyes on").did, "swap-eyes");
    EXPECT_EQ(noted("swap-eyes off").did, "swap-eyes back");
    EXPECT_EQ(deedOf("tool 0.02").tool.radius, 0.02);
    EXPECT_EQ(deedOf("material talus 30").word, "talus");
    EXPECT_DOUBLE_EQ(noted("material talus 30").number, 30);
    EXPECT_EQ(deedOf("save a-B_1").word, "a-B_1");
    EXPECT_EQ(deedOf("load a-B_1").did, "load");
    EXPECT_DOUBLE_EQ(deedOf("force off").number, 0);
    EXPECT_DOUBLE_EQ(noted("force on").number, 1);
    EXPECT_DOUBLE_EQ(noted("force scale 0.25").number, 0.25);
    for (const auto& verb : master::verbsOf<support::NotingDesk>()) {
        EXPECT_TRUE(tried.contains(std::string(verb.name))) << verb.name << " is not tried here";
    }
}

TEST(OperatorCommand, EveryEditWithoutDataIsTheVerbOfItsName) {
    std::set<std::string_view> edits, verbs;
    for (const auto& known : valuesOf(sand::Edit::Kind{})) {
        if (known.value != sand::Edit::tune && known.value != sand::Edit::load) {
            edits.insert(known.name);
        }
    }
    for (const auto& verb : master::verbsOf<support::NotingDesk>()) {
        if (verb.form.empty() && noted(std::string(verb.name)).did == "edit") {
            verbs.insert(verb.name);
            EXPECT_EQ(base::nameOf(noted(std::string(verb.name)).edit), verb.name);
        }
    }
    EXPECT_EQ(edits, verbs);
}

TEST(OperatorCommand, WhatIsNoneIsToldWithWhatThereIs) {
    EXPECT_EQ(
        complaint("dance"),
        "'dance' is not a command; the commands are: status, pause, resume, reset, undo, redo, settle, pattern "
        "NAME|none|next, "
        "show LAYER, hide LAYER, eye-separation METRES, stereo MODE, swap-eyes on|off, tool [SHAPE] [radius=R] "
        "[width=W] "
        "[heading=DEG] [foot=left|right], material KEY VALUE, save NAME, load NAME, capture, film, force on|off|scale "
        "SHARE, stop");
    EXPECT_EQ(complaint("").substr(0, 19), "'' is not a command");
    EXPECT_EQ(complaint("undo twice"), "undo takes no argument, got 'twice'");
    EXPECT_EQ(complaint("pattern"), "pattern needs NAME|none|next");
    EXPECT_EQ(complaint("material talus"), "material needs KEY VALUE");
    EXPECT_EQ(complaint("material talus steep"), "talus must be a number, got 'steep'");
    EXPECT_EQ(complaint("tool radius=1e999"), "a tool's radius must be a number, got '1e999'");
    EXPECT_EQ(complaint("tool heading=nan"), "a tool's heading must be a number, got 'nan'");
    for (const std::string number : {"nan", "inf", "-inf", "+25", "0x10"}) {
        EXPECT_EQ(complaint("material talus " + number), "talus must be a number, got '" + number + "'");
        EXPECT_EQ(complaint("tool radius=" + number), "a tool's radius must be a number, got '" + number + "'");
        EXPECT_EQ(complaint("tool width=" + number), "a tool's width must be a number, got '" + number + "'");
        EXPECT_NE(complaint("tool " + number).find("left or right, got '" + number + "'"), std::string::npos);
    }
    EXPECT_EQ(complaint("tool 1e999"),
              fmt::format("a tool is one of {}, or has radius=, width=, heading=, foot=left or right, got '1e999'",
                          fmt::join(base::namesOf<sand::ToolKind>(), ", ")));
    EXPECT_NE(complaint("tool footprint foot=both").find("got 'foot=both'"), std::string::npos);
    for (const std::string value : {"scale 1.5", "scale +1", "scale -1", "scale", "scale nan", "half"}) {
        EXPECT_EQ(complaint("force " + value),
                  "force needs on, off or scale SHARE with a share of 0 to 1, got '" + value + "'");
    }
    for (const std::string name : {"..", "../x", "/tmp/x", "a b", "a.sand"}) {
        EXPECT_EQ(complaint("save " + name), "a name has 1 to 64 letters, digits, - and _, got '" + name + "'");
        EXPECT_EQ(complaint("load " + name), complaint("save " + name));
    }
    EXPECT_EQ(complaint("stereo sideways").find("no stereo mode 'sideways'; there are mono, left"), 0U);
    EXPECT_EQ(complaint("swap-eyes"), "swap-eyes needs on|off");
    for (const std::string value : {"true", "1", "ON", "on off"}) {
        EXPECT_EQ(complaint("swap-eyes " + value), "swap-eyes needs on or off, got '" + value + "'");
    }
    EXPECT_EQ(complaint("show rain"), "no layer 'rain'; there are wireframe, hill-shade, force, statistics, help");
    EXPECT_EQ(complaint("pattern stripes"),
              "no test pattern 'stripes'; there are none, grid, tiles, eyes, flash, ramp, next");
    for (const std::string value : {"0.51", "-0.01", "nan", "inf", "wide", "0.1m", " 0.1", "+0.1"}) {
        EXPECT_EQ(complaint("eye-separation " + value), "eye-separation must be 0 to 0.5 metres, got '" + value + "'");
    }
}

/// A session's folder with its control socket, and functions of a client.
class Control : public test::FolderTest {
protected:
    [[nodiscard]] static int connectTo(const std::filesystem::path& path) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path.string().copy(address.sun_path, sizeof address.sun_path - 1);
        const int made = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (connect(made, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
            close(made);
            return -1;
        }
        return made;
    }
    [[nodiscard]] int connectHere() const { return connectTo(folder_ / "control"); }
    static void sendText(int peer, const std::string& text) {
        (void)send(peer, text.data(), text.size(), MSG_NOSIGNAL);
    }
    /// Returns all bytes that the client receives until the connection ends.
    static std::string hear(int peer) {
        std::string text;
        char piece[256];
        for (ssize_t count = 0; (count = recv(peer, piece, sizeof piece, 0)) > 0;) {
            text.append(piece, static_cast<std::size_t>(count));
        }
        close(peer);
        return text;
    }
    static ControlSocket::Asked await(ControlSocket& control) {
        while (true) {  // limited by the time-out of the test
            if (const auto asked = control.take(); !asked.empty()) {
                return asked.front();
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    /// Sends a line, answers it with `answer`, and returns the bytes that the client received.
    [[nodiscard]] std::string ask(ControlSocket& control, const std::string& line, const std::string& answer) const {
        const int peer = connectHere();
        sendText(peer, line + "\n");
        const ControlSocket::Asked asked = await(control);
        EXPECT_EQ(asked.line, line);
        control.answer(asked.client, answer);
        return hear(peer);
    }
};

TEST_F(Control, HandsALineOverAndItsAnswerBack) {
    ControlSocket control(folder_);
    EXPECT_EQ(ask(control, "status", "{}"), "{}\n");
    EXPECT_EQ(ask(control, "undo", "{\"ok\":true}"), "{\"ok\":true}\n");
}

TEST_F(Control, IsItsOwnersAlone) {
    const ControlSocket control(folder_);
    struct stat made {};
    ASSERT_EQ(stat((folder_ / "control").c_str(), &made), 0);
    EXPECT_TRUE(S_ISSOCK(made.st_mode));
    EXPECT_EQ(made.st_mode & 0777, 0600U);
    EXPECT_TRUE(master::mayCommand(1000, 1000));
    EXPECT_FALSE(master::mayCommand(1001, 1000));
    EXPECT_FALSE(master::mayCommand(0, 1000));
}

// Another user is refused even if folder and socket are open to all users.
TEST_F(Control, RefusesAnotherUser) {
    if (geteuid() != 0) {
        GTEST_SKIP() << "only root can become another user";
    }
    ControlSocket control(folder_);
    std::filesystem::permissions(folder_, std::filesystem::perms::all);
    std::filesystem::permissions(folder_ / "control", std::filesystem::perms::all);
    const pid_t child = fork();
    if (child == 0) {
        const bool other = setuid(65534) == 0;
        const int peer = other ? connectHere() : -1;
        _exit(peer >= 0 && hear(peer).find("belongs to another user") != std::string::npos ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    EXPECT_TRUE(control.take().empty());
}

TEST_F(Control, GoesWithTheSession) {
    { const ControlSocket control(folder_); }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "control"));
}

TEST_F(Control, ReplacesWhatAKilledSessionLeft) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    (folder_ / "control").string().copy(address.sun_path, sizeof address.sun_path - 1);
    const int left = socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(bind(left, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    close(left);
    ASSERT_LT(connectHere(), 0);
    ControlSocket control(folder_);
    EXPECT_EQ(ask(control, "status", "{}"), "{}\n");
}

TEST_F(Control, LeavesARunningSessionsSocketAndOtherFilesAlone) {
    ControlSocket first(folder_);
    { const ControlSocket second(folder_); }
    EXPECT_EQ(ask(first, "status", "{}"), "{}\n");
    const std::filesystem::path other = folder_ / "other";
    std::filesystem::create_directory(other);
    std::ofstream(other / "control") << "mine";
    { const ControlSocket third(other); }
    EXPECT_TRUE(std::filesystem::is_regular_file(other / "control"));
}

TEST_F(Control, WorksInFoldersDeeperThanASocketsPath) {
    const std::filesystem::path deep = folder_ / std::string(100, 'a') / std::string(100, 'b');
    std::filesystem::create_directories(deep);
    const ControlSocket control(deep);
    EXPECT_TRUE(std::filesystem::is_socket(deep / "control"));
}

TEST_F(Control, SendsAwayWhoTalksTooMuch) {
    ControlSocket control(folder_);
    const int peer = connectHere();
    sendText(peer, std::string(2000, 'x'));
    EXPECT_NE(hear(peer).find("more than 1024 bytes"), std::string::npos);
    EXPECT_TRUE(control.take().empty());
    EXPECT_EQ(ask(control, "status", "{}"), "{}\n");
}

TEST_F(Control, WhoSaysNothingIsSentAway) {
    ControlSocket control(folder_);
    EXPECT_EQ(hear(connectHere()), "");
    EXPECT_EQ(ask(control, "status", "{}"), "{}\n");
}

TEST_F(Control, DoesNothingWhileNobodyAsks) {
    ControlSocket control(folder_);
    EXPECT_EQ(ask(control, "status", "{}"), "{}\n");
    const auto waits = [] {
        rusage used{};
        getrusage(RUSAGE_SELF, &used);
        return used.ru_nvcsw;
    };
    // The thread must still see that its last client has gone. Then only this test itself waits.
    long fewest = std::numeric_limits<long>::max();
    for (int i = 0; i < 20 && fewest > 2; ++i) {
        const long before = waits();
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        fewest = std::min(fewest, waits() - before);
    }
    EXPECT_LE(fewest, 2);
}

TEST_F(Control, CrowdsHarmNobody) {
    ControlSocket control(folder_);
    std::vector<int> crowd;
    std::vector<ControlSocket::Asked> asked;
    for (std::size_t i = 0; i < ControlSocket::kMostClients; ++i) {
        crowd.push_back(connectHere());
        sendText(crowd.back(), "capture\n");
        asked.push_back(await(control));
    }
    EXPECT_NE(hear(connectHere()).find("too many clients"), std::string::npos);
    for (std::size_t i = 0; i < crowd.size(); ++i) {
        control.answer(asked[i].client, std::to_string(i));
    }
    for (std::size_t i = 0; i < crowd.size(); ++i) {
        EXPECT_EQ(hear(crowd[i]), std::to_string(i) + "\n");
    }
    EXPECT_EQ(ask(control, "status", "{}"), "{}\n");
}

TEST_F(Control, ForgetsWhoLeavesBeforeTheAnswer) {
    ControlSocket control(folder_);
    const int peer = connectHere();
    sendText(peer, "capture\n");
    const ControlSocket::Asked asked = await(control);
    close(peer);
    control.answer(asked.client, "{}");
    control.answer(asked.client + 100, "{}");
    EXPECT_EQ(ask(control, "status", "{}"), "{}\n");
}

TEST_F(Control, WhoWaitsWhenTheSessionEndsIsLetGo) {
    int peer = -1;
    {
        ControlSocket control(folder_);
        peer = connectHere();
        sendText(peer, "capture\n");
        (void)await(control);
    }
    EXPECT_EQ(hear(peer), "");
}

}  // namespace
