// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "sand/replica.hpp"
#include "tests/sand/grid/random_worlds.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

/// Random sessions whose steps run as wholes and in parts.
namespace spread {

/// Two replicas that apply the same parts of steps. They are swept in different ways, and the second is sometimes
/// healed.
class Parts {
public:
    Parts(const scene::Scene& scene, int most, const sand::grid::Erosion::Options& how,
          const sand::grid::Erosion::Options& otherHow)
        : most_(most), sand_(samples::replicaSwept(scene, how)), other_(samples::replicaSwept(scene, otherHow)) {}

    /// Applies `step` and all that is owed after it. Returns what was wrong, or an empty text.
    std::string apply(sand::Step step, std::mt19937& random) {
        do {
            step.number = sand_.stepNumber() + 1;
            step.sweeps = std::min(most_, sand_.mostSweeps(step));
            if (random() % 50 == 0) {
                other_.decodeState(sand_.encodeState());
            }
            sand_.apply(step);
            other_.apply(step);
            if (sand_.refusedStep()) {
                return "step " + std::to_string(step.number) + " was left out: " + sand_.leftOut();
            }
            if (sand_.stateHash() != other_.stateHash()) {
                return "the state after step " + std::to_string(step.number) + " depends on how it was swept";
            }
            step = {1, 0, sand_.engaged(), {}};
        } while (sand_.owed().any());
        return "";
    }
    [[nodiscard]] const sand::Replica& sand() const { return sand_; }
    [[nodiscard]] int most() const { return most_; }

private:
    int most_;  // [sweep] in a part
    sand::Replica sand_, other_;
};

/// Applies `step` and, after a settle, steps until all sand is at rest.
inline void applyWhole(sand::Replica& sand, sand::Step step) {
    do {
        step.number = sand.stepNumber() + 1;
        step.sweeps = 0;
        sand.apply(step);
        step = {1, 0, sand.engaged(), {}};
    } while (sand.owed().any());
}

/// Returns a random tool and material.
inline sand::Tuning randomTuning(const sand::Rules& rules, std::mt19937& random) {
    sand::Tuning tuning = rules.tuning;
    tuning.sweepsPerStep = 1 + static_cast<std::int32_t>(random() % 120);  // with each damping
    tuning.tool.kind = static_cast<sand::ToolKind>(random() % sand::kToolKinds);
    tuning.tool.radius = static_cast<std::int32_t>(random() % (12 * sand::kProbePerCell));
    tuning.tool.halfWidth = sand::isRound(tuning.tool.kind) ? 0 : tuning.tool.radius / 3;
    return tuning;
}

/// Returns a random step, which sometimes holds an edit of any kind. `saved` is sand that a load may restore.
inline sand::Step randomStep(const sand::Rules& rules, const sand::Replica& saved, std::mt19937& random) {
    sand::Step step = samples::wildStep(0, rules, random);
    switch (random() % 24) {
        case 0:
            step.edit = sand::Edit::undo;
            break;
        case 1:
            step.edit = sand::Edit::reset;
            break;
        case 2:
            step.edit = sand::Edit::loaded(random() % 3 == 0 ? base::Bytes{1, 2, 3} : saved.copySand()->encode());
            break;
        case 3:  // without a threshold, sand slides for too long
            step.edit = rules.tuning.threshold > 1000 ? sand::Edit::settle : sand::Edit::none;
            break;
        case 4:
        case 5:
            step.edit = sand::Edit::tuned(randomTuning(rules, random));
            break;
        default:
            break;
    }
    return step;
}

/// Returns the sand of a replica and the sand that it keeps for an undo: heights, fluxes, age and outflow.
inline std::array<base::Bytes, 2> sandOf(const sand::Replica& replica) {
    base::ByteWriter kept;
    if (replica.canUndo()) {
        replica.surface().encodeKept(kept);
    }
    return {replica.copySand()->encode(), kept.take()};
}

/// Plays `steps` random steps of a hand over a random field, as wholes and in parts of 1, 7, 16 and 64 sweeps. Returns
/// the first difference, or an empty text. `executor` shares out the sweeps of one replica for each size of parts.
inline std::string firstDifference(unsigned seed, int steps, const base::Executor* executor = nullptr) {
    worlds::World world(seed, 48, 36, false);
    scene::Scene scene = samples::flatScene(world.field.columns(), world.field.rows());
    world.rules.tuning.tool.kind = sand::ToolKind::sphere;
    world.rules.stepsPerSecond = 60;
    scene.terrain = world.field;
    scene.rules = world.rules;
    scene.rules.tuning = randomTuning(world.rules, world.random);
    scene.ground = std::move(world.ground);
    const auto how = [&] {
        const std::vector<base::CodePath> paths = base::codePathsHere();
        return sand::grid::Erosion::Options{.blockSize = worlds::kBlocks.at(world.random() % worlds::kBlocks.size()),
                                            .path = paths.at(world.random() % paths.size())};
    };
    sand::Replica whole(scene);
    std::vector<Parts> parts;
    for (const int most : {1, 7, 16, 64}) {
        sand::grid::Erosion::Options otherHow = how();
        otherHow.executor = executor;
        parts.emplace_back(scene, most, how(), otherHow);
    }
    for (int i = 0; i < steps; ++i) {
        const sand::Step step = randomStep(scene.rules, whole, world.random);
        applyWhole(whole, step);
        for (Parts& each : parts) {
            std::string wrong = each.apply(step, world.random);
            if (wrong.empty() && sandOf(each.sand()) != sandOf(whole)) {
                wrong = "the sand differs from that of whole steps";
            }
            if (!wrong.empty()) {
                return fmt::format("seed {}, step {} of the hand, parts of {}: {}", seed, i + 1, each.most(), wrong);
            }
        }
    }
    return "";
}

}  // namespace spread
