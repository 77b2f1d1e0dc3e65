// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/spacenav.hpp"

#include <gtest/gtest.h>

#include <array>

#include "base/input_error.hpp"
#include "haptic_bridge/devices/device_module.hpp"
#include "haptic_bridge/devices/open_device.hpp"
#include "tests/haptic_bridge/devices/spacenav_daemon.hpp"
#include "tests/support/processes/server_process.hpp"

namespace {

using haptic_bridge::SpacenavDevice;

/// A daemon whose cap a test pushes, and the time of the hand.
class Spacenav : public testing::Test {
protected:
    test::Folder folder_;
    test::SpacenavDaemon daemon_{folder_.file("spnav")};
};

TEST_F(Spacenav, APushIsASpeed) {
    SpacenavDevice device(test::kSpnavLibrary);
    daemon_.push(175, -350, 700);  // half to the right, fully down, and farther away than the cap can go
    // Another thread polls the library. The test's time does not advance until the event has arrived.
    double x = 0, time = 0;
    ASSERT_TRUE(test::eventually([&] { return (x = device.read(time += 1e-6).x) > 0; }));
    const haptic_bridge::Pose from = device.read(time);
    for (int i = 0; i < 500; ++i) {
        (void)device.read(time += 1e-3);
    }
    const haptic_bridge::Pose to = device.read(time);
    EXPECT_NEAR(to.x - from.x, 0.5 * SpacenavDevice::kSpeed * 0.5, 1e-9);
    EXPECT_NEAR(to.y - from.y, 0.5 * SpacenavDevice::kSpeed, 1e-9) << "full speed is the most";
    EXPECT_NEAR(to.z - from.z, -0.5 * SpacenavDevice::kClimb, 1e-9);
    EXPECT_FALSE(to.engaged);
    // A released cap stops the hand, and a clock that does not advance also stops it.
    daemon_.push(0, 0, 0);
    daemon_.button(0, true);
    ASSERT_TRUE(test::eventually([&] { return device.read(time).engaged; }));
    EXPECT_DOUBLE_EQ(device.read(time += 0.05).x, to.x);
    daemon_.button(0, false);
    daemon_.button(1, true);
    ASSERT_TRUE(test::eventually([&] { return device.read(time).x == 0; }))
        << "the second button brings the hand back to the centre";
    EXPECT_FALSE(device.read(time).engaged);
}

// A pause is a server that was stopped, or a debugger. The hand would jump through the sand.
TEST_F(Spacenav, APauseMovesTheHandByATenthOfASecondAtMost) {
    SpacenavDevice device(test::kSpnavLibrary);
    daemon_.push(350, 350, 350);
    double time = 0;
    ASSERT_TRUE(test::eventually([&] {
        const haptic_bridge::Pose pose = device.read(time += 1e-6);
        return pose.x > 0 && pose.y > 0 && pose.z > 0;
    }));
    const haptic_bridge::Pose from = device.read(time), to = device.read(time += 5);
    constexpr double kMost = 0.1;  // [s]
    EXPECT_NEAR(to.x - from.x, SpacenavDevice::kSpeed * kMost, 1e-12);
    EXPECT_NEAR(to.y - from.y, SpacenavDevice::kSpeed * kMost, 1e-12);
    EXPECT_NEAR(to.z - from.z, SpacenavDevice::kClimb * kMost, 1e-12);
    const haptic_bridge::Pose back = device.read(time - 5), again = device.read(time);
    EXPECT_EQ(back.x, to.x) << "a clock that runs backwards does not move the hand";
    EXPECT_EQ(again.x, to.x) << "the time up to the pause is not counted twice";
    EXPECT_NEAR(device.read(time + 0.01).x - to.x, SpacenavDevice::kSpeed * 0.01, 1e-12) << "after the pause";
}

TEST_F(Spacenav, TheHandStaysInReachOfTheField) {
    SpacenavDevice device(test::kSpnavLibrary);
    const auto pushed = [&](int push, double& time) {
        daemon_.push(push, push, push);
        const haptic_bridge::Pose from = device.read(time);
        EXPECT_TRUE(test::eventually([&] {
            const haptic_bridge::Pose pose = device.read(time += 1e-6);
            return (pose.x - from.x) * push > 0 && (pose.y - from.y) * push > 0 && (pose.z - from.z) * push > 0;
        }));
        for (int i = 0; i < 300; ++i) {
            (void)device.read(time += 0.1);
        }
        return device.read(time);
    };
    double time = 0;
    const haptic_bridge::Pose most = pushed(350, time), least = pushed(-350, time);
    EXPECT_EQ((std::array{most.x, most.y, most.z}), (std::array{8.0, 8.0, 20.0}));
    EXPECT_EQ((std::array{least.x, least.y, least.z}), (std::array{-8.0, -8.0, -3.0}));
}

TEST_F(Spacenav, SaysWhatIsMissing) {
    const auto complaint = [](const std::string& library) {
        try {
            const SpacenavDevice device(library);
        } catch (const base::InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string advice = "; install Debian's libspnav0 and spacenavd, or name the file of libspnav";
    EXPECT_EQ(complaint("libnospnav.so"),
              "--device spacenav:libnospnav.so: libnospnav.so: cannot open shared object file: No such file or "
              "directory" +
                  advice);
    const std::string text = folder_.write("text.so", "no library\n");
    EXPECT_EQ(complaint(text), "--device spacenav:" + text + ": " + text + ": file too short" + advice);
    EXPECT_EQ(complaint(SANDWALL_BIN_DIR "/bad-driver.so"),
              "--device spacenav:" SANDWALL_BIN_DIR "/bad-driver.so: " SANDWALL_BIN_DIR
              "/bad-driver.so has no spnav_open; name the file of libspnav");
    daemon_.end();
    EXPECT_EQ(complaint(test::kSpnavLibrary), "--device spacenav: no daemon answers; start spacenavd");
}

TEST(RealDevice, IsADriverOrASixAxisMouseAndNothingElse) {
    for (const char* spec : {"driver:arm.so", "driver:/a/b.so:what", "driver:", "spacenav", "spacenav:lib.so"}) {
        EXPECT_TRUE(haptic_bridge::isRealDevice(spec)) << spec;
    }
    for (const char* spec : {"script:gis", "script:driver:a", "trace:spacenav", "sim:touch",
                             "sim:touch,path=driver:", "pointer", "none", "", "drivers:a.so", "spacenavd"}) {
        EXPECT_FALSE(haptic_bridge::isRealDevice(spec)) << spec;
    }
}

TEST(Driver, TheExampleOfTheDocumentIsAnArm) {
    const auto arm = haptic_bridge::openArmModule(SANDWALL_BIN_DIR "/example-driver.so:first");
    EXPECT_EQ(arm->physics().name, "my device");
    arm->push({0, 0, 1});
    EXPECT_TRUE(arm->read(0).present);
}

TEST(Driver, AFileThatIsNoneIsRefused) {
    const auto complaint = [](const std::string& spec) {
        try {
            (void)haptic_bridge::openArmModule(spec);
        } catch (const base::InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_TRUE(complaint("/nowhere/my.so").starts_with("--device driver:/nowhere/my.so: "));
    EXPECT_NE(complaint(SANDWALL_BIN_DIR "/fake-spnav.so").find("fake-spnav.so: defines no sandwallDriverInterface"),
              std::string::npos);
}

TEST(Driver, OfAnotherInterfaceVersionIsRefused) {
    const std::string file = SANDWALL_BIN_DIR "/old-driver.so";
    try {
        (void)haptic_bridge::openArmModule(file);
        ADD_FAILURE() << "opened";
    } catch (const base::InputError& error) {
        EXPECT_EQ(std::string(error.what()),
                  std::filesystem::absolute(file).string() +
                      ": is a driver of interface version 0, and this program takes version 2; build it with "
                      "haptic_bridge/devices/driver.hpp of this version of Sandwall (docs/devices.md)");
    }
}

TEST(HeadlessServer, MapsNoWindowLibrary) {
    const test::Folder folder{};
    const test::ServerProcess server(folder,
                                     test::ServerProcess::usual(folder.write("s.toml", test::kSmallScene), folder));
    ASSERT_NE(server.port(), 0) << server.errors();
    std::ifstream maps("/proc/" + std::to_string(server.pid()) + "/maps");
    const std::string mapped{std::istreambuf_iterator<char>(maps), {}};
    EXPECT_NE(mapped.find("libc.so"), std::string::npos);
    for (const char* library : {"glfw", "libGL", "libX11", "spnav"}) {
        EXPECT_EQ(mapped.find(library), std::string::npos) << library;
    }
}

TEST(HeadlessServer, SaysThatThePointerNeedsNoServer) {
    const test::Folder folder{};
    auto words = test::ServerProcess::usual(folder.write("s.toml", test::kSmallScene), folder);
    words[3] = "pointer";
    test::ServerProcess server(folder, words);
    EXPECT_EQ(server.wait(), 2);
    EXPECT_TRUE(server.errors().starts_with("sandwall-haptic-server: --device pointer: ")) << server.errors();
}

}  // namespace
