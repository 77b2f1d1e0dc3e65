// SPDX-License-Identifier: Apache-2.0
// Every part of a replica's state shows in its hash.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "sand/grid/snapshot.hpp"
#include "sand/replica.hpp"
#include "tests/support/sand/distinct_hashes.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace state_hash {
namespace {

using sand::Edit;
using sand::Replica;
using sand::Step;
using sand::Tuning;
using test::DistinctHashes;

constexpr int kSide = 40;  // [cell]

/// Returns a replica after one step that leaves the level sand as it is.
Replica after(const std::function<void(Step&)>& change, const scene::Scene& scene = samples::flatScene(kSide, kSide)) {
    Replica replica(scene);
    Step step{1, 1, false, {{100, 200, 300}}};
    change(step);
    replica.apply(step);
    return replica;
}

std::uint64_t hashAfter(const std::function<void(Step&)>& change) { return after(change).stateHash(); }

/// Returns a load of level sand with inertia of this age and this outflow. The step with the load runs no sweeps.
Edit loadOf(int age, std::int64_t outflow) {
    const sand::HeightField field(kSide, kSide, 1.0);
    return Edit::loaded(sand::grid::Snapshot(field, sand::grid::Inertia(age), outflow).encode());
}

TEST(StateHash, TellsThePlaceOfTheToolAndWhetherItIsEngaged) {
    DistinctHashes hashes;
    const std::uint64_t plain = hashAfter([](Step&) {});
    hashes.add("plain", plain);
    EXPECT_EQ(hashAfter([](Step& step) { step.epoch = 7; }), plain) << "the state does not hold the epoch";
    const auto reset = [](std::uint64_t number) {
        return after([number](Step& step) { step.edit = samples::withNumber(number, Edit::reset); });
    };
    EXPECT_EQ(reset(7).stateHash(), reset(8).stateHash()) << "the state does not hold the number of an edit";
    EXPECT_EQ(reset(7).encodeState(), reset(8).encodeState());
    hashes.add("x", hashAfter([](Step& step) { step.path[0].x ^= 1; }));
    hashes.add("y", hashAfter([](Step& step) { step.path[0].y ^= 1; }));
    hashes.add("z", hashAfter([](Step& step) { step.path[0].z ^= 1; }));
    const auto above = [](bool engaged) {
        return hashAfter([engaged](Step& step) {
            step.engaged = engaged;
            step.path = {{100, 200, 20 * sand::kProbePerCell}};
        });
    };
    hashes.add("above the sand", above(false));
    hashes.add("engaged above the sand", above(true));
    Replica later = after([](Step&) {});
    later.apply({1, 2, false, {}});
    hashes.add("a step later", later.stateHash());
}

TEST(StateHash, TellsTheAgeOfTheInertiaAndTheOutflow) {
    DistinctHashes hashes;
    for (const int age : {0, 1, 2, 1000}) {
        const Replica replica = after([age](Step& step) { step.edit = loadOf(age, 0); });
        ASSERT_EQ(replica.leftOut(), "");
        ASSERT_EQ(samples::erosionOf(replica).undisturbed(), age);
        ASSERT_TRUE(sameHeights(samples::fieldOf(replica), sand::HeightField(kSide, kSide, 1.0)));
        hashes.add("age " + std::to_string(age), Replica(replica).stateHash());
    }
    hashes.add("outflow 1", hashAfter([](Step& step) { step.edit = loadOf(0, 1); }));
    hashes.add("outflow -1", hashAfter([](Step& step) { step.edit = loadOf(0, -1); }));
}

TEST(StateHash, TellsTheHeadingThatAHandHasTurnedTheToolTo) {
    DistinctHashes hashes;
    hashes.add("not turned", hashAfter([](Step&) {}));
    for (const double degrees : {90.0, -90.0, 180.0, 0.01}) {
        for (const bool mirrored : {false, true}) {
            hashes.add(std::to_string(degrees) + (mirrored ? " mirrored" : ""),
                       hashAfter([&](Step& step) { step.heading = *sand::headingOf(degrees, mirrored); }));
        }
    }
    EXPECT_EQ(hashAfter([](Step& step) { step.heading = sand::Heading{}; }), hashAfter([](Step&) {}))
        << "the heading of the scene";
}

TEST(StateHash, TellsEveryRuleThatAnOperatorHasTuned) {
    DistinctHashes hashes;
    hashes.add("not tuned", hashAfter([](Step&) {}));
    const auto tuned = [](const std::function<void(Tuning&)>& change) {
        return hashAfter([&](Step& step) {
            Tuning tuning = samples::flatScene(kSide, kSide).rules.tuning;
            tuning.startThreshold += 100;
            change(tuning);
            step.edit = Edit::tuned(tuning);
        });
    };
    hashes.add("start threshold", tuned([](Tuning&) {}));
    hashes.add("threshold", tuned([](Tuning& tuning) { ++tuning.threshold; }));
    hashes.add("sweeps per step", tuned([](Tuning& tuning) { ++tuning.sweepsPerStep; }));
    hashes.add("tool's radius", tuned([](Tuning& tuning) { ++tuning.tool.radius; }));
    hashes.add("circle", tuned([](Tuning& tuning) { tuning.tool.kind = sand::ToolKind::circle; }));
    hashes.add("tool's heading", tuned([](Tuning& tuning) { tuning.tool.heading = *sand::headingOf(1); }));
    const auto ellipse = [](Tuning& tuning) {
        tuning.tool.kind = sand::ToolKind::ellipse;
        tuning.tool.halfWidth = 200;
    };
    hashes.add("ellipse", tuned(ellipse));
    for (const sand::ToolKind kind :
         {sand::ToolKind::rectangle, sand::ToolKind::ellipsoid, sand::ToolKind::footprint}) {
        hashes.add(std::string(base::nameOf(kind)), tuned([&](Tuning& tuning) {
                       ellipse(tuning);
                       tuning.tool.kind = kind;
                   }));
    }
    hashes.add("wider ellipse", tuned([&](Tuning& tuning) {
                   ellipse(tuning);
                   ++tuning.tool.halfWidth;
               }));
}

// The operator turns the tool, and a hand turns it back. The rules have another heading than the hand.
TEST(StateHash, TellsTheHeadingOfTheRulesFromThatOfTheHand) {
    DistinctHashes hashes;
    for (const double ofRules : {0.0, 90.0}) {
        for (const double ofHand : {0.0, 45.0, 90.0}) {
            Replica replica(samples::flatScene(kSide, kSide));
            Tuning tuning = replica.rules().tuning;
            tuning.tool.kind = sand::ToolKind::circle;
            tuning.tool.heading = *sand::headingOf(ofRules);
            replica.apply({1, 1, false, {}, Edit::tuned(tuning)});
            Step turned{1, 2, false, {}};
            turned.heading = *sand::headingOf(ofHand);
            replica.apply(turned);
            hashes.add(std::to_string(ofRules) + " and " + std::to_string(ofHand), replica.stateHash());
        }
    }
}

}  // namespace
}  // namespace state_hash
