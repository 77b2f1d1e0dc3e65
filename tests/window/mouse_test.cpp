// SPDX-License-Identifier: Apache-2.0
// The mouse as a hand, in a window on the test's own X server.
#include "haptic_bridge/devices/mouse.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "haptic_bridge/devices/device_module.hpp"
#include "pictures/png_file.hpp"
#include "scene/scene.hpp"
#include "tests/support/folder_test.hpp"
#include "tests/support/sand_samples.hpp"
#include "tests/support/x_screen.hpp"
#include "tests/support/x_server.hpp"

namespace {

using namespace haptic_bridge;

constexpr int kSide = 240;  // [pixel], side of the window

pictures::Image imageOf(const Picture& picture) {
    pictures::Image image(picture.width, picture.height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        for (unsigned channel = 0; channel < 3; ++channel) {
            image.rgb[3 * i + channel] = static_cast<std::uint8_t>(picture.pixels[i] >> (8 * channel));
        }
    }
    return image;
}

/// Returns sand with a furrow from west to east, a little north of the middle.
sand::Replica furrowed(const scene::Scene& scene) {
    sand::Replica terrain(scene);
    sand::Step step;
    step.number = 1;
    step.engaged = true;
    for (int i = 0; i <= 40; ++i) {
        step.path.push_back({(20 + i) * sand::kProbePerCell, 56 * sand::kProbePerCell, 0});
    }
    terrain.apply(step);
    return terrain;
}

Picture painted(const sand::Replica& terrain, const SketchedHand& hand) {
    SandSketch sketch;
    sketch.take(terrain);
    Picture picture{kSide, kSide, {}};
    paint(sketch, hand, picture);
    return picture;
}

class Mouse : public test::FolderTest {
protected:
    void SetUp() override {
        server_ = std::make_unique<support::XServer>(folder_, std::vector<std::string>{"640x480x24"});
        setenv("DISPLAY", server_->display().c_str(), 1);
        mouse_ = std::make_unique<MouseDevice>([] { return openPictureWindow("sand", kSide, kSide); });
        mouse_->stepped(terrain_);
        screen_ = std::make_unique<support::XScreen>(server_->display());
        ASSERT_TRUE(eventually([&] { return screen_->windows().size() == 1; }));
        window_ = screen_->windows().front();
    }
    void TearDown() override {
        screen_.reset();
        mouse_.reset();
        server_.reset();
        unsetenv("DISPLAY");
    }
    template <class Done>
    static bool eventually(const Done& done) {
        for (int i = 0; i < 6000; ++i) {
            if (done()) {
                return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }
    Pose pose() { return mouse_->read(time_ += 1e-3); }

    const scene::Scene scene_ = samples::flatScene(96, 96);
    const sand::Replica terrain_ = furrowed(scene_);
    std::unique_ptr<support::XServer> server_;
    std::unique_ptr<MouseDevice> mouse_;
    std::unique_ptr<support::XScreen> screen_;
    unsigned long window_ = 0;
    double time_ = 0;
};

TEST_F(Mouse, TouchesWhereItPointsAndAsDeepAsTheWheelSays) {
    screen_->point(window_, 180, 60);
    ASSERT_TRUE(eventually([&] { return std::abs(pose().x - 0.5) < 1e-9; })) << pose().x;
    EXPECT_NEAR(pose().y, 0.5, 1e-9);
    EXPECT_FALSE(pose().engaged);
    EXPECT_GT(pose().z, 1) << "it hovers";
    screen_->button(window_, 1, true);
    ASSERT_TRUE(eventually([&] { return pose().engaged; }));
    EXPECT_NEAR(pose().z, 0.5, 1e-9);
    for (const bool down : {true, false}) {
        screen_->button(window_, 5, down);  // one notch of the wheel towards the person: deeper
    }
    ASSERT_TRUE(eventually([&] { return std::abs(pose().z - 0.4) < 1e-9; })) << pose().z;
    screen_->button(window_, 1, false);
    ASSERT_TRUE(eventually([&] { return !pose().engaged; }));
}

TEST_F(Mouse, ShowsTheSandTheToolAndTheForce) {
    SketchedHand hand{0.25, 0.25, true, 0.5, {1, -0.5, 1.5}};
    mouse_->sendForce(hand.force);
    screen_->point(window_, 150, 90);
    screen_->button(window_, 1, true);
    const pictures::Image expected = imageOf(painted(terrain_, hand));
    const bool shown = screen_->comesToShow(expected, 0, 0);
    if (const char* keep = getenv("SANDWALL_KEEP_PICTURES")) {
        pictures::writePng(std::filesystem::path(keep) / "mouse.png", screen_->picture(0, 0, kSide, kSide));
        pictures::writePng(std::filesystem::path(keep) / "mouse_expected.png", expected);
    }
    EXPECT_TRUE(shown);
    hand.force = {};
    EXPECT_NE(imageOf(painted(terrain_, hand)).rgb, expected.rgb) << "the arrow must be there";
    hand = {0.25, 0.25, true, 0.5, {1, -0.5, 1.5}};
    EXPECT_NE(imageOf(painted(sand::Replica(scene_), hand)).rgb, expected.rgb) << "and the furrow";
}

TEST_F(Mouse, AKeyTakesTheForceAway) {
    mouse_->sendForce({2, 0, 0});
    screen_->point(window_, 150, 90);
    screen_->button(window_, 1, true);
    screen_->type(window_, 'f');
    SketchedHand hand{0.25, 0.25, true, 0.5, {}};
    ASSERT_TRUE(eventually([&] {
        mouse_->sendForce({2, 0, 0});
        return screen_->picture(0, 0, kSide, kSide).rgb == imageOf(painted(terrain_, hand)).rgb;
    }));
}

TEST_F(Mouse, AWindowThatIsClosedIsADeviceThatIsAway) {
    screen_->button(window_, 1, true);
    ASSERT_TRUE(eventually([&] { return pose().engaged; }));
    EXPECT_EQ(mouse_->troubles()->of(Trouble::absent), 0U);
    screen_->askToClose(window_);
    ASSERT_TRUE(eventually([&] { return !pose().engaged; }));
    EXPECT_GT(mouse_->troubles()->of(Trouble::absent), 0U);
}

}  // namespace
