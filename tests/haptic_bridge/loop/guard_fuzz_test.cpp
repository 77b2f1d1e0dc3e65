// SPDX-License-Identifier: Apache-2.0
// Feeds random ticks to the last gate and to all guards, and checks every force that they let through.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "haptic_bridge/hand/arm_numbers.hpp"
#include "haptic_bridge/loop/guards/guards.hpp"
#include "tests/haptic_bridge/loop/fuzz_count.hpp"
#include "tests/haptic_bridge/loop/push_check.hpp"
#include "tests/haptic_bridge/loop/push_oracle.hpp"
#include "tests/haptic_bridge/loop/random_ticks.hpp"
#include "tests/support/seed.hpp"

namespace {

using namespace haptic_bridge;
using sand::force::Vec3;
using test::Dice;

constexpr const char* kGateCount = "SANDWALL_FUZZ_GATE";
constexpr unsigned kSequences = 10'000;
constexpr int kTicksEach = 60;
/// Runs `sequence(dice, number)` for as many seeds as the environment asks for. A failure prints the seed of its
/// sequence. Each of `guards` must have acted, so that the sequences try them all.
template <class Sequence>
void runSequences(const char* fuzzer, const std::vector<Guard>& guards, const Sequence& sequence) {
    const unsigned seed = test::randomSeed(), count = test::sequences(kGateCount, kSequences);
    test::ActedCounts counts;
    for (unsigned i = 0; i < count; ++i) {
        Dice dice(seed + i);
        sequence(dice, i, counts);
        ASSERT_FALSE(testing::Test::HasFailure()) << test::again(seed + i);
    }
    for (const Guard guard : guards) {
        EXPECT_TRUE(counts.of(guard) > 0 || count < kSequences) << base::nameOf(guard);
    }
    counts.print(kGateCount, fuzzer, count, seed);
}

TEST(GateFuzz, EveryForceThatPassesKeepsTheBounds) {
    const std::vector<Guard> guards{Guard::notANumber, Guard::clamp, Guard::ramp, Guard::contact, Guard::gate};
    runSequences("gate", guards, [](Dice& dice, unsigned, test::ActedCounts& counts) {
        const ForceLimits limits = test::randomLimits(dice);
        ASSERT_EQ(complaintAbout(limits.arm, "the test"), std::nullopt);
        test::GateTicks ticks(dice, limits);
        ForceGate gate(limits);
        test::PushCheck check(limits);
        gate.restart(ticks.time());
        check.start(ticks.time());
        for (int tick = 0; tick < kTicksEach; ++tick) {
            const ForceGate::Wanted wanted = ticks.next();
            if (dice.chance(0.03)) {
                gate.restart(wanted.time);
                check.start(wanted.time);
                continue;
            }
            std::uint32_t acted = 0;
            const Vec3 passed = gate.pass(wanted, acted);
            counts.add(acted);
            const bool finite =
                std::isfinite(norm(wanted.force)) && std::isfinite(wanted.whole) && std::isfinite(wanted.time);
            ASSERT_EQ((acted & bit(Guard::notANumber)) != 0, !finite) << "tick " << tick;
            test::PushCheck::Asked asked;
            asked.time = wanted.time;
            asked.fault = !finite;
            asked.contact = wanted.contact;
            asked.edited = wanted.edited;
            asked.whole = wanted.whole;
            asked.damped = true;  // the gate lets a force fall
            ASSERT_EQ(check.wrong(passed, asked), "") << "tick " << tick;
            if (acted == 0) {
                ASSERT_LE(norm(passed - wanted.force), 1e-12) << "no guard acted at tick " << tick;
            }
        }
    });
}

/// Guards, and the check of each of their ticks.
class CheckedGuards {
public:
    explicit CheckedGuards(const ForceLimits& limits) : guards_(limits), oracle_(limits), check_(limits) {}

    void forget() {
        guards_.forget();
        oracle_.forget();
        begun_ = false;
    }
    /// Returns what is wrong with this tick; empty if it keeps all rules.
    [[nodiscard]] std::string wrong(const Guards::Reading& reading) {
        const Guards::Forces forces = guards_.tick(reading);
        if (!std::exchange(begun_, true)) {
            check_.start(reading.time);
        }
        acted = forces.acted;
        sent = forces.sent;
        test::PushCheck::Asked asked = oracle_.next(reading);
        if (asked.fault && (acted & kFaults) == 0 && reading.engaged) {
            return "no guard has acted at a fault";
        }
        // Numbers that are finite one by one may not be so together. A tick may then send 0, and begins a ramp.
        if (!asked.fault && (acted & kFaults & ~bit(Guard::notANumber)) != 0) {
            return "a guard has acted without a fault";
        }
        asked.fault = asked.fault || (acted & bit(Guard::notANumber)) != 0;
        asked.damped = (acted & bit(Guard::passivity)) != 0;
        return check_.wrong(sent, asked);
    }
    /// Returns the force that a hand gets which rests there for long.
    [[nodiscard]] double limited(const Guards::Reading& reading) const { return norm(oracle_.limitedAt(reading, 1)); }

    std::uint32_t acted = 0;
    Vec3 sent;

private:
    Guards guards_;
    test::PushOracle oracle_;
    test::PushCheck check_;
    bool begun_ = false;
};

TEST(GuardsFuzz, EveryForceOfTheGuardsKeepsTheRulesWhateverTheyRead) {
    std::vector<Guard> all;
    for (std::size_t i = 0; i < kGuards; ++i) {
        all.push_back(static_cast<Guard>(i));
    }
    int rested = 0;
    runSequences("guards", all, [&rested](Dice& dice, unsigned sequence, test::ActedCounts& counts) {
        const ForceLimits limits = test::randomLimits(dice);
        CheckedGuards guards(limits);
        test::HandTicks hand(dice, limits);
        const int warm = dice.chance(0.3) ? 230 : 0;  // [tick] of 9 ms, longer than the ramp of a start
        for (int tick = -warm; tick < kTicksEach; ++tick) {
            if (dice.chance(0.01)) {
                guards.forget();
            }
            ASSERT_EQ(guards.wrong(tick < 0 ? hand.resting() : hand.next()), "") << "tick " << tick;
            counts.add(guards.acted);
        }
        if (sequence % 16 != 0) {
            return;
        }
        // After any readings, an honest hand must get its whole force again. The longest silence is that of
        // frozen sand: a second of steps and half a second to grow, beside the ramp of two seconds.
        Guards::Reading reading;
        for (int tick = 0; tick < 400; ++tick) {
            reading = hand.resting();
            ASSERT_EQ(guards.wrong(reading), "") << "resting, tick " << tick;
            counts.add(guards.acted);
        }
        const double whole = guards.limited(reading);
        if (whole < 100 * limits.slew) {
            ASSERT_NEAR(norm(guards.sent), std::min(whole, limits.maxForce), 1e-9 + 1e-6 * whole);
            rested += whole > 0 ? 1 : 0;
        }
    });
    EXPECT_TRUE(rested > 0 || test::sequences(kGateCount, kSequences) < kSequences);
}

}  // namespace
