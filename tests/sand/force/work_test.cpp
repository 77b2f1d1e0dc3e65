// SPDX-License-Identifier: Apache-2.0
// The direction of the force, and its work on closed paths that are so slow that no other effect counts.
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "sand/force/law.hpp"
#include "tests/sand/force/force_samples.hpp"

namespace {

using namespace sand::force;
using namespace samples;

constexpr std::array kWorkedLaws{sand::ForceLaw::repulse, sand::ForceLaw::controlPoints};

sand::ForceConstants workedConstants(sand::ForceLaw law) {
    sand::ForceConstants constants;
    constants.law = law;
    constants.unitLength = kSide * kCell;
    return constants;
}

/// Closed path around a depth of half a radius: three waves in every direction.
class Loop {
public:
    explicit Loop(std::uint32_t seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> phase(0, 2 * std::numbers::pi), size(0.1, 0.3);
        for (Wave& wave : waves_) {
            wave = {phase(random), size(random)};
        }
    }
    [[nodiscard]] Vec3 at(double turn /* 0 to 1 */) const {
        std::array<double, 3> sum{};
        for (std::size_t i = 0; i < waves_.size(); ++i) {
            const auto [phase, size] = waves_[i];
            const std::size_t harmonic = i / 3 + 1;
            const double angle = 2 * std::numbers::pi * turn * static_cast<double>(harmonic);
            sum[i % 3] += kRadius * size * (std::sin(angle + phase) - std::sin(phase));
        }
        return placeAt(0.5 * kRadius + sum[2], sum[0], sum[1]);
    }

private:
    struct Wave {
        double phase = 0, size = 0;
    };
    std::array<Wave, 9> waves_;
};

struct Work {
    double net = 0, exchanged = 0;  // [N · scene unit] along the path; exchanged: sum of both signs
};

/// Returns the model's work along a loop. The loop is so slow that each new tangent takes over completely.
Work around(const sand::ForceConstants& constants, const SurfacePatch& patch, std::uint32_t seed) {
    constexpr int kTicks = 20000;
    const Contour tool = Contour::sphere(kRadius);
    ForceModel model(constants);
    const Loop loop(seed);
    Work work;
    Vec3 from = loop.at(0), before = model.at(patch, 1, tool, from, 0).push;
    for (int tick = 1; tick <= kTicks; ++tick) {
        const Vec3 to = loop.at(static_cast<double>(tick) / kTicks);
        const Vec3 now = model.at(patch, 1, tool, to, tick * kTick).push;
        const double part = dot(0.5 * (before + now), to - from);
        work.net += part;
        work.exchanged += std::abs(part);
        from = to;
        before = now;
    }
    return work;
}

TEST(Work, IsNothingOverAClosedPathOnLevelSand) {
    const SurfacePatch level = levelPatch();
    for (const auto law : kWorkedLaws) {
        for (std::uint32_t seed = 1; seed <= 10; ++seed) {
            const Work work = around(workedConstants(law), level, seed);
            EXPECT_GT(work.exchanged, 1e-4) << "seed " << seed << ": the path misses the sand";
            EXPECT_LT(std::abs(work.net), 1e-6 * work.exchanged) << "seed " << seed;
        }
    }
}

// On a slope, the force of neither law has a potential. The law of Dorjgotov et al. 2007 turns its force with the
// depth. The law of Purchart et al. 2012 pushes sideways in proportion to the depth. The exchanged work bounds the work
// that a loop gives or takes; `sandwall-bench force-work` reports it.
TEST(Work, StaysAPartOfWhatIsExchangedOnSlopes) {
    const SurfacePatch slope = slopePatch(0.5);
    for (const auto law : kWorkedLaws) {
        double most = 0;
        for (std::uint32_t seed = 1; seed <= 10; ++seed) {
            const Work work = around(workedConstants(law), slope, seed);
            most = std::max(most, std::abs(work.net) / work.exchanged);
        }
        std::printf("on a slope of a half: at most %.3g of the exchanged work\n", most);
        EXPECT_GT(most, 1e-4) << "the law seems to be conservative; docs/forces.md must then state that";
        EXPECT_LT(most, 0.5);
    }
}

TEST(Push, PointsOutOfTheSandAndIsNothingOutsideIt) {
    const Contour tool = Contour::sphere(kRadius);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> aside(-kRadius, kRadius), depth(-2 * kRadius, 2 * kRadius);
    for (const auto law : kWorkedLaws) {
        const sand::ForceConstants constants = workedConstants(law);
        int inside = 0, outside = 0;
        for (std::uint32_t seed = 1; seed <= 10; ++seed) {
            const SurfacePatch rough = roughPatch(seed);
            for (int i = 0; i < 200; ++i) {
                const Vec3 place = placeAt(depth(random), aside(random), aside(random));
                const Vec3 push = ForceModel(constants).at(rough, 1, tool, place, 0).push;
                double highest = -1;  // highest sand within two radii
                for (int k = 0; k < 400; ++k) {
                    const double angle = 0.1 * k, reach = 2 * kRadius * std::sqrt(k / 400.0);
                    highest = std::max(
                        highest, rough.height(place.x + reach * std::cos(angle), place.y + reach * std::sin(angle)));
                }
                if (place.z - kRadius > highest + kCell) {
                    EXPECT_EQ(norm(push), 0) << "seed " << seed;
                    ++outside;
                }
                if (norm(push) > 0) {
                    const Vec3 out = contactForce({}, tool, measureContact(rough, place, tool)).normal;
                    EXPECT_GT(dot(push, out), 0) << "seed " << seed;
                    EXPECT_GT(push.z, 0) << "never down";
                    ++inside;
                }
            }
        }
        EXPECT_GT(inside, 200);
        EXPECT_GT(outside, 200);
    }
}

TEST(Push, GrowsFromNothingAndFallsToNothingAlongAnyPath) {
    const Contour tool = Contour::sphere(kRadius);
    for (const auto law : kWorkedLaws) {
        const sand::ForceConstants constants = workedConstants(law);
        const SurfacePatch rough = roughPatch(11);
        ForceModel model(constants);
        double last = 0, steepest = 0;
        bool touched = false;
        // The tool moves down two radii and up again at one radius per 20 ms, and sideways at a tenth of that speed.
        for (int tick = 0; tick <= 160; ++tick) {
            const double down = kRadius * (2 - std::abs(tick - 80) / 20.0);
            const Response felt = model.at(rough, 1, tool, placeAt(down, kRadius * tick / 200), tick * kTick);
            EXPECT_LE(std::abs(norm(felt.push) - last), 1.1 * std::max(felt.stiffness, steepest) * kRadius / 19)
                << tick;
            steepest = felt.stiffness;
            last = norm(felt.push);
            touched = touched || last > 0;
        }
        EXPECT_TRUE(touched);
        EXPECT_EQ(last, 0);
    }
}

}  // namespace
