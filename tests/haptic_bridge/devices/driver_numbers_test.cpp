// SPDX-License-Identifier: Apache-2.0
// Numbers of a driver, of a simulated arm and of a recorded arm, at their bounds and outside of them.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "haptic_bridge/devices/device_module.hpp"
#include "haptic_bridge/devices/simulated_arm.hpp"
#include "haptic_bridge/hand/arm_numbers.hpp"
#include "haptic_bridge/hand/arm_presets.hpp"
#include "haptic_bridge/loop/guards/passivity_observer.hpp"
#include "haptic_bridge/loop/tick_track.hpp"
#include "tests/support/processes/server_process.hpp"
#include "tests/support/refusal.hpp"

namespace {

using namespace haptic_bridge;

/// The table of docs/devices.md: the name, what is allowed in words, values that are allowed, and values that are not.
struct NumberRow {
    std::string name, bounds, key;
    std::vector<std::string> good, bad;
};

const std::vector<NumberRow>& numberTable() {
    static const std::string denormal = "4.9406564584124654e-324", largest = "1.7976931348623157e308";
    static const std::vector<NumberRow> rows{
        {"mass", "0.005 to 10 kg", "mass", {"0.005", "10"}, {"0", "-1", "0.004999999999999999", "10.000000000000002"}},
        {"damping",
         "more than 0 and at most 100 N s/m",
         "damping",
         {denormal, "100"},
         {"0", "-1", "100.00000000000001"}},
        {"friction", "0 N or more", "friction", {"0", largest}, {"-1", "-" + denormal}},
        {"resolution", "0 m or more", "resolution", {"0", largest}, {"-1", "-" + denormal}},
        {"maxForce",
         "more than 0 and at most 200 N",
         "max_force",
         {denormal, "200"},
         {"0", "-1", "200.00000000000003"}},
        {"reach", "0.005 to 2 m", "", {"0.005", "2"}, {"0", "-1", "0.004999999999999999", "2.0000000000000004"}},
        {"maxStiffness",
         "more than 0 N/m, or infinity where the maker states none",
         "stiffness",
         {denormal, largest, "inf"},
         {"0", "-1", "-inf"}},
        {"delayTicks", "0 to 15 ticks", "delay", {"0", "15"}, {"16", "-2", "2147483647", "-2147483648"}}};
    return rows;
}

/// Returns the values of a row that a driver must not give. An int can hold neither NaN nor infinity.
std::vector<std::string> wrongValues(const NumberRow& row) {
    std::vector<std::string> values = row.bad;
    if (row.name != "delayTicks") {
        values.emplace_back("nan");
        values.emplace_back("-inf");
        if (row.name != "maxStiffness") {
            values.emplace_back("inf");
        }
    }
    values.emplace_back("forgotten");
    return values;
}

class DriverNumbers : public testing::Test {
protected:
    [[nodiscard]] std::string specOf(const std::string& name, const std::string& value) const {
        return SANDWALL_BIN_DIR "/bad-driver.so:number:" + name + "=" + value + ":" + folder_.file("pushes");
    }
    const test::Folder folder_{};
};

TEST_F(DriverNumbers, OutOfTheirBoundsAreRefusedByNameBeforeAnyPush) {
    const std::string scene = folder_.write("small.toml", test::kSmallScene);
    for (const NumberRow& row : numberTable()) {
        for (const std::string& value : wrongValues(row)) {
            const std::string spec = "driver:" + specOf(row.name, value);
            auto words = test::ServerProcess::usual(scene, folder_, 0, "realtime");
            words[3] = spec;
            test::ServerProcess server(folder_, words);
            EXPECT_EQ(server.wait(), 2) << spec;
            const std::string fault =
                value == "forgotten" || value == "nan" ? "does not state its " + row.name : row.name + " is ";
            const std::string errors = server.errors();
            EXPECT_TRUE(errors.starts_with(fmt::format("sandwall-haptic-server: --device {}: {}", spec, fault)))
                << errors;
            EXPECT_TRUE(errors.ends_with("; a driver must give " + row.bounds + "\n")) << errors;
            EXPECT_EQ(errors.find('\n'), errors.size() - 1) << errors;
            EXPECT_FALSE(std::filesystem::exists(folder_.file("pushes"))) << spec << ": it was pushed";
        }
    }
}

TEST_F(DriverNumbers, AtTheirBoundsAreTaken) {
    std::size_t taken = 0;
    for (const NumberRow& row : numberTable()) {
        for (const std::string& value : row.good) {
            const auto arm = openArmModule(specOf(row.name, value));
            for (const ArmNumber& number : kArmNumbers) {
                if (number.name == row.name) {
                    ++taken;
                    EXPECT_EQ(number.of(arm->physics()), std::strtod(value.c_str(), nullptr)) << row.name;
                }
            }
        }
    }
    EXPECT_EQ(taken, 2 * numberTable().size() + 1) << "each number is in both tables";
}

// The driver of this test adds a line to the file for each push.
TEST_F(DriverNumbers, ThatAreAllowedLetTheServerPush) {
    auto words = test::ServerProcess::usual(folder_.write("small.toml", test::kSmallScene), folder_, 0, "realtime");
    words[3] = "driver:" + specOf("delayTicks", "15");
    test::ServerProcess server(folder_, words);
    ASSERT_NE(server.port(), 0) << server.errors();
    EXPECT_TRUE(test::eventually([&] { return std::filesystem::exists(folder_.file("pushes")); })) << server.errors();
    EXPECT_EQ(server.stop(SIGTERM), 0) << server.errors();
}

TEST(ArmNumbers, OfEveryPresetAreAllowed) {
    for (const std::string_view name : kArmPresets) {
        EXPECT_EQ(complaintAbout(*armPreset(name), "an arm"), std::nullopt) << name;
    }
    EXPECT_EQ(complaintAbout({}, "an arm"), "does not state its mass; an arm must give 0.005 to 10 kg");
}

TEST(ArmNumbers, BoundTheKeysOfASimulatedArm) {
    for (const NumberRow& row : numberTable()) {
        if (row.key.empty()) {
            continue;
        }
        for (const std::string& value : row.good) {
            EXPECT_NO_THROW((void)openSimulatedArm("sim:touch," + row.key + "=" + value)) << row.key << " " << value;
        }
        std::vector<std::string> wrong = wrongValues(row);
        wrong.insert(wrong.end(), {"nan", "-inf", "1e999", ""});
        for (const std::string& value : wrong) {
            const std::string spec = "sim:touch," + row.key + "=" + value;
            EXPECT_EQ(test::refusalOf([&] { (void)openSimulatedArm(spec); }),
                      fmt::format("--device {}: {} needs {}, got '{}'", spec, row.key, row.bounds, value));
        }
    }
    for (const std::string key : {"grip", "grip_damping"}) {
        for (const std::string value : {"nan", "inf", "-inf", "-1", "100001"}) {
            EXPECT_THROW((void)openSimulatedArm(fmt::format("sim:touch,{}={}", key, value)), base::InputError)
                << key << value;
        }
    }
}

// A replay computes the limits of the forces from the header of a recording.
TEST(ArmNumbers, BoundTheArmOfARecording) {
    TrackPiece piece;
    piece.begins = true;
    EXPECT_NO_THROW((void)decodeTrackPiece(encode(piece))) << "a recording of a hand has no body and no numbers";
    piece.header.body = true;
    piece.header.physics = touchPreset();
    EXPECT_EQ(decodeTrackPiece(encode(piece)).header.physics.mass, touchPreset().mass);
    int tried = 0;
    for (const NumberRow& row : numberTable()) {
        for (const std::string& value : wrongValues(row)) {
            TrackPiece wrong = piece;
            for (const ArmNumber& number : kArmNumbers) {
                if (number.name != row.name) {
                    continue;
                }
                ++tried;
                if (number.member == nullptr) {
                    wrong.header.physics.delayTicks = value == "forgotten" ? -1 : std::stoi(value);
                } else {
                    wrong.header.physics.*number.member =
                        value == "forgotten" ? ArmPhysics{}.mass : std::strtod(value.c_str(), nullptr);
                }
            }
            EXPECT_THROW((void)decodeTrackPiece(encode(wrong)), base::FormatError) << row.name << " " << value;
        }
    }
    EXPECT_GE(tried, 40);
}

TEST(LongestDelay, OfASimulatedArmIsWholeWhateverTheLengthOfATick) {
    for (const double tick : {1e-3, 0.6e-3}) {
        ArmPhysics physics = touchPreset();
        physics.friction = physics.resolution = 0;
        physics.delayTicks = 15;
        SimulatedArm arm(physics);
        (void)arm.read(0);
        arm.push({1, 0, 0});
        for (int i = 1; i * tick < 0.015; ++i) {
            (void)arm.read(i * tick);
            EXPECT_EQ(arm.velocity().x, 0) << "after " << i * tick << " s";
            arm.push({});
        }
        (void)arm.read(0.0155);
        EXPECT_GT(arm.velocity().x, 0) << "after 15 ms";
    }
}

TEST(LongestDelay, OfTheObserverCountsAForceFifteenTicksLater) {
    ArmPhysics physics = touchPreset();
    physics.delayTicks = 15;
    PassivityObserver observer(ForceLimits::of(physics, 1, {}, 0));
    observer.observe({}, 0);
    observer.sent({2, 0, 0});
    for (int tick = 1; tick <= 15; ++tick) {
        observer.observe({tick * 1e-3, 0, 0}, 1e-3);
        EXPECT_EQ(observer.returned(), 0) << "tick " << tick;
        observer.sent({});
    }
    observer.observe({16e-3, 0, 0}, 1e-3);
    EXPECT_NEAR(observer.returned(), 2 * 1e-3, 1e-15) << "2 N over 1 mm";
    observer.sent({});
    observer.observe({17e-3, 0, 0}, 1e-3);
    EXPECT_NEAR(observer.returned(), 2 * 1e-3, 1e-15);
}

}  // namespace
