// SPDX-License-Identifier: Apache-2.0
// Laws that are not finite, at the limits of a device. A scene file cannot give one, but an old journal can.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/input_error.hpp"
#include "haptic_bridge/devices/mapped_device.hpp"
#include "haptic_bridge/hand/arm_numbers.hpp"
#include "haptic_bridge/hand/arm_presets.hpp"
#include "haptic_bridge/loop/guards/guards.hpp"
#include "haptic_bridge/loop/haptic_tick.hpp"
#include "sand/force/finite_law.hpp"
#include "tests/haptic_bridge/loop/logging_arm.hpp"
#include "tests/support/hand/arm_on_sand.hpp"
#include "tests/support/seed.hpp"

namespace {

using namespace haptic_bridge;
using sand::force::LawRegion;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Returns the message with which a law is refused; "" if it gets limits.
std::string refusal(const LawAtRadius& law, double scale = test::kScale) {
    try {
        (void)ForceLimits::of(touchPreset(), scale, law, 0.67);
        return "";
    } catch (const base::InputError& error) {
        return error.what();
    }
}

TEST(FiniteLimits, RefuseALawThatIsNotFiniteInOneLine) {
    for (double LawAtRadius::*part : {&LawAtRadius::stiffness, &LawAtRadius::drag, &LawAtRadius::push}) {
        for (const double number : {kInfinite, std::nan("")}) {
            LawAtRadius law{500, 50, 5};
            EXPECT_EQ(refusal(law), "");
            law.*part = number;
            const std::string line = refusal(law);
            EXPECT_EQ(line.find("the force law at a depth of one tool radius is "), 0U) << line;
            EXPECT_EQ(line.find('\n'), std::string::npos);
        }
    }
    EXPECT_NE(refusal({500, 50, 5}, 1e306).find("at 1e+306 scene units per metre; all must be finite"),
              std::string::npos)
        << refusal({500, 50, 5}, 1e306);
}

TEST(FiniteLimits, HaveAGainFromZeroToOneAndAFiniteSlewForEveryOtherLaw) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponent(-320, 308);
    int limited = 0;
    for (int i = 0; i < 2000; ++i) {
        const LawAtRadius law{std::pow(10, exponent(random)), std::pow(10, exponent(random)),
                              std::pow(10, exponent(random))};
        const double scale = std::max(std::pow(10, exponent(random) / 2), 1e-150);
        if (!refusal(law, scale).empty()) {
            EXPECT_FALSE(std::isfinite(law.stiffness * scale) && std::isfinite(law.drag * scale));
            continue;
        }
        const ForceLimits limits = ForceLimits::of(touchPreset(), scale, law, 0.67, 1e-6);
        ASSERT_TRUE(limits.gain >= 0 && limits.gain <= 1) << limits.gain;
        ASSERT_TRUE(std::isfinite(limits.slew) && std::isfinite(limits.lawStiffness)) << limits.slew;
        limited += limits.gain < 1 ? 1 : 0;
    }
    EXPECT_GT(limited, 100);
}

TEST(FiniteLimits, AreNotNeededByALawAtTheBoundOfItsScene) {
    scene::Scene scene = test::levelSand();
    const LawRegion region = LawRegion::of(scene.grid().longerSide, scene.grid().cellSize);
    scene.force.depthExponent = 1e6;
    const auto fault = sand::force::faultOf(scene.force, region);
    ASSERT_TRUE(fault && fault->allowed);
    scene.force.depthExponent = *fault->allowed;
    EXPECT_EQ(refusal(lawAtRadius(scene), region.scale), "") << "even at the largest scale";
}

TEST(FiniteLimits, LetAnArmGoThatGetsNone) {
    scene::Scene scene = test::levelSand();
    scene.force.depthExponent = 1e6;
    std::vector<test::Push> pushes;
    const auto open = [&] {
        auto arm = std::make_unique<test::LoggingArm>(
            touchPreset(), [](double) { return ArmReading{}; }, pushes);
        const HapticTick hand(scene, std::make_unique<MappedDevice>(std::move(arm), HandSettings{}, scene),
                              HandSettings::Datum::level);
    };
    EXPECT_THROW(open(), base::InputError);
    ASSERT_EQ(pushes.size(), 1U) << "an arm holds its last force";
    EXPECT_EQ(norm(pushes[0].force), 0);
}

TEST(FiniteLimits, PushZeroWhereALawOverflowsFartherDown) {
    const ForceLimits limits = ForceLimits::of(touchPreset(), test::kScale, {500, 50, 5}, 0.67);
    Guards guards(limits, Guards::Mode::on);
    sand::ForceConstants constants;
    constants.depthExponent = 20000;
    const auto tool = sand::force::Contour::sphere(0.04);
    for (int tick = 0; tick < 3000; ++tick) {
        sand::force::Contact contact;
        contact.depth = {tick < 2900 ? 1e-4 : 0.04, {0, 0, -1}};
        contact.share = 1;
        Guards::Reading reading;
        reading.time = tick * ForceLimits::kTick;
        reading.felt = sand::force::contactForce(constants, tool, contact);
        reading.engaged = reading.present = true;
        const auto forces = guards.tick(reading);
        if (tick == 2899) {
            EXPECT_GT(norm(forces.sent), 0);
        }
        if (tick >= 2900) {
            ASSERT_EQ(norm(forces.sent), 0);
            ASSERT_NE(forces.acted & bit(Guard::notANumber), 0U);
        }
    }
}

TEST(FiniteLimits, TakeTheirReachAndSpeedFromTheSameNumbersAsTheLaw) {
    const auto reach = std::find_if(kArmNumbers.begin(), kArmNumbers.end(),
                                    [](const ArmNumber& number) { return number.name == "reach"; });
    ASSERT_NE(reach, kArmNumbers.end());
    EXPECT_EQ(LawRegion::kShortestReach, reach->lowest);
    EXPECT_EQ(LawRegion::kFastest, ForceLimits{}.fastestThing);
}

}  // namespace
