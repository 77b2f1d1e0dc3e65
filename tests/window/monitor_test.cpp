// SPDX-License-Identifier: Apache-2.0
// Windows whose monitors go, come back, move and change their modes while the session runs.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/support/screens/x_monitors.hpp"
#include "tests/support/screens/x_screen.hpp"
#include "tests/support/screens/x_server.hpp"
#include "tests/window/probe_fixture.hpp"

namespace {

using support::XMonitors;
using support::XScreen;

class MonitorTest : public ProbeTest {
protected:
    void TearDown() override {
        probe_.reset();
        screen_.reset();
        monitors_.reset();
        server_.reset();
    }
    /// Opens full screens of `size` on monitors.
    void open(const std::vector<std::string>& monitors, glm::ivec2 size) {
        std::vector<std::string> words{"--display", server_->display(),    "--width", std::to_string(size.x),
                                       "--height",  std::to_string(size.y)};
        for (const std::string& monitor : monitors) {
            words.insert(words.end(), {"--at", monitor});
        }
        (void)startAndShow(words);
        screen_ = std::make_unique<XScreen>(server_->display());
        windows_ = screen_->windows();
        ASSERT_EQ(windows_.size(), monitors.size());
    }
    /// Shows frames until the states of the monitors are these, and the windows are at these places. A hidden window
    /// has the size 0.
    [[nodiscard]] testing::AssertionResult become(const std::string& states,
                                                  const std::vector<XMonitors::Place>& places) {
        const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        std::string found;
        while (std::chrono::steady_clock::now() < until) {
            const std::size_t before = probe_->output().size();
            probe_->type("monitors");
            if (!probe_->waitUntil([&] { return probe_->output().find("monitors ", before) != std::string::npos; },
                                   kLong)) {
                return testing::AssertionFailure() << "no frame: " << probe_->output();
            }
            found = probe_->output().substr(before);
            bool there = found.find("monitors " + states) != std::string::npos;
            for (std::size_t i = 0; i < places.size(); ++i) {
                const XMonitors::Place place = monitors_->placeOf(windows_[i]);
                there = there && place.size == places[i].size && (place.size.x == 0 || place.low == places[i].low);
                found += " (" + std::to_string(place.low.x) + ", " + std::to_string(place.low.y) + ") " +
                         std::to_string(place.size.x) + " x " + std::to_string(place.size.y);
            }
            if (there) {
                return testing::AssertionSuccess();
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        return testing::AssertionFailure() << found;
    }

    /// Shows frames until the screen has an eye's whole picture at this place.
    [[nodiscard]] bool shows(const std::string& eye, glm::ivec2 at) {
        const pictures::Image expected = picture(eye);
        const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (screen_->picture(at.x, at.y, expected.width, expected.height).rgb != expected.rgb) {
            if (std::chrono::steady_clock::now() > until) {
                return false;
            }
            probe_->type("monitors");
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        return true;
    }

    std::unique_ptr<support::XServer> server_;
    std::unique_ptr<XMonitors> monitors_;
    std::unique_ptr<XScreen> screen_;
    std::vector<unsigned long> windows_;  // the lowest one first, as they were opened
};

/// A screen of Xvfb. Its only monitor shows a part of it.
class OneMonitor : public MonitorTest {
protected:
    static constexpr glm::ivec2 kSize{400, 300};

    void SetUp() override {
        server_ = std::make_unique<support::XServer>(folder_, std::vector<std::string>{"1000x700x24"});
        monitors_ = std::make_unique<XMonitors>(server_->display());
        monitors_->addMode("screen", kSize);
        monitors_->addMode("screen", {320, 240});
        monitors_->show({{"screen", {0, 0}, kSize}});
        open({"screen"}, kSize);
    }
};

TEST_F(OneMonitor, HidesItsWindowWhileItIsOffAndShowsItWhenItIsBack) {
    EXPECT_TRUE(become("on", {{"", {0, 0}, kSize}}));
    monitors_->switchOff("screen");
    EXPECT_TRUE(become("off", {{}}));
    monitors_->show({{"screen", {0, 0}, kSize}});
    EXPECT_TRUE(become("on", {{"", {0, 0}, kSize}}));
    EXPECT_TRUE(shows("left", {0, 0})) << "with all pixels of its picture";
    monitors_->switchOff("screen");
    EXPECT_TRUE(become("off", {{}})) << "a second time";
    monitors_->show({{"screen", {100, 50}, kSize}});
    EXPECT_TRUE(become("on", {{"", {100, 50}, kSize}})) << "at another place";
    EXPECT_TRUE(shows("left", {100, 50}));
}

TEST_F(OneMonitor, TakesItsWindowAlongWhenItMoves) {
    for (const glm::ivec2 corner : {glm::ivec2(300, 200), {600, 400}, {0, 0}, {1, 0}}) {
        monitors_->show({{"screen", corner, kSize}});
        EXPECT_TRUE(become("on", {{"", corner, kSize}}));
    }
    EXPECT_TRUE(shows("left", {1, 0}));
}

TEST_F(OneMonitor, IsSetToTheSizeOfItsOutputAgain) {
    monitors_->show({{"screen", {200, 100}, {320, 240}}});
    EXPECT_TRUE(become("on", {{"", {200, 100}, kSize}}));
    monitors_->switchOff("screen");
    EXPECT_TRUE(become("off", {{}}));
    monitors_->show({{"screen", {0, 0}, {320, 240}}});
    EXPECT_TRUE(become("on", {{"", {0, 0}, kSize}})) << "it has come back with another size";
    EXPECT_TRUE(shows("left", {0, 0}));
}

TEST_F(OneMonitor, IsDarkUntilItHasAModeOfItsOutput) {
    monitors_->switchOff("screen");
    EXPECT_TRUE(become("off", {{}}));
    monitors_->removeMode("screen", kSize);
    monitors_->show({{"screen", {0, 0}, {320, 240}}});
    EXPECT_TRUE(become("other_size", {{}}));
    monitors_->addMode("screen", kSize);
    monitors_->show({{"screen", {0, 0}, kSize}});
    EXPECT_TRUE(become("on", {{"", {0, 0}, kSize}}));
}

/// A card of several monitors. Two of them stand side by side.
class TwoMonitors : public MonitorTest {
protected:
    static constexpr glm::ivec2 kSize{640, 360}, kLeft{0, 0}, kRight{640, 0};

    void SetUp() override {
        server_ = support::XServer::withMonitors(folder_);
        if (server_ == nullptr) {
            GTEST_SKIP() << "no Xorg with the dummy driver; install xserver-xorg-core and xserver-xorg-video-dummy";
        }
        monitors_ = std::make_unique<XMonitors>(server_->display());
        monitors_->setScreen({1280, 720});
        monitors_->addMode("DUMMY1", kSize);
        monitors_->show({{"DUMMY1", kRight, kSize}});
        open({"DUMMY0", "DUMMY1"}, kSize);
        EXPECT_TRUE(become("on on", {{"", kLeft, kSize}, {"", kRight, kSize}}));
    }
};

TEST_F(TwoMonitors, TakeTheirWindowsAlongWhenTheyAreExchanged) {
    monitors_->show({{"DUMMY0", kRight, kSize}, {"DUMMY1", kLeft, kSize}});
    EXPECT_TRUE(become("on on", {{"", kRight, kSize}, {"", kLeft, kSize}}));
    EXPECT_TRUE(shows("left", {kRight.x, 0}));
    EXPECT_TRUE(shows("right", {kLeft.x, 0}));
}

TEST_F(TwoMonitors, OfWhichOneGoesLeaveTheOtherAlone) {
    monitors_->switchOff("DUMMY1");
    EXPECT_TRUE(become("on off", {{"", kLeft, kSize}, {}}));
    EXPECT_TRUE(shows("left", {0, 0})) << "no other window lies over it";
    monitors_->show({{"DUMMY1", {640, 360}, kSize}});
    EXPECT_TRUE(become("on on", {{"", kLeft, kSize}, {"", {640, 360}, kSize}}));
    EXPECT_TRUE(shows("right", {640, 360}));
}

// Both are off, and the second one takes the controller of the card that the first one had.
TEST_F(TwoMonitors, ComeBackInTheOtherOrder) {
    monitors_->switchOff("DUMMY0");
    monitors_->switchOff("DUMMY1");
    EXPECT_TRUE(become("off off", {{}, {}}));
    monitors_->show({{"DUMMY1", kLeft, kSize}});
    EXPECT_TRUE(become("off on", {{}, {"", kLeft, kSize}}));
    monitors_->addMode("DUMMY0", kSize);
    monitors_->show({{"DUMMY0", kRight, kSize}});
    EXPECT_TRUE(become("on on", {{"", kRight, kSize}, {"", kLeft, kSize}}));
}

}  // namespace
