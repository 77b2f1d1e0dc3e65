// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "haptic_bridge/hand/hand_settings.hpp"
#include "scene/model/scene.hpp"
#include "tests/haptic_bridge/loop/dice.hpp"
#include "tests/support/sand/tin_scene.hpp"

namespace test {

inline std::int32_t talusOf(double degrees) {
    return static_cast<std::int32_t>(std::lround(std::tan(degrees * std::numbers::pi / 180) * sand::kUnitsPerCell));
}

/// Gives `tool` a random kind and size.
inline void randomTool(Dice& dice, sand::Tool& tool) {
    tool.kind = static_cast<sand::ToolKind>(dice.below(sand::kToolKinds));
    tool.radius = static_cast<std::int32_t>(dice.scaled(0.7, 10) * sand::kProbePerCell);
    const double width = sand::isRound(tool.kind) ? 0 : dice.between(0.2, 1);
    tool.halfWidth = static_cast<std::int32_t>(width * tool.radius);
}

/// Returns small sand with a random surface, tool, material and law: in cells, or rarely as a TIN.
inline scene::Scene randomScene(Dice& dice) {
    scene::Scene scene;
    if (dice.chance(0.07)) {
        scene = samples::tinScene();
    } else {
        const int columns = 48 + dice.below(49), rows = 48 + dice.below(49);
        scene.terrain = sand::HeightField(columns, rows, dice.scaled(0.05, 10) / columns);
        scene.rules.columns = columns;
        scene.rules.rows = rows;
        const double high = dice.oneOf({0.0, 1.0, 4.0}), waves = dice.between(0, 0.3), turn = dice.between(0, 6);
        for (int y = 0; y < rows; ++y) {
            for (int x = 0; x < columns; ++x) {
                const double height = high * std::sin(waves * x + turn) * std::cos(waves * y);  // [cell]
                scene.terrain.setHeight(x, y, static_cast<std::int32_t>(height * sand::kUnitsPerCell));
            }
        }
        randomTool(dice, scene.rules.tuning.tool);
        scene.rules.scheme = dice.oneOf({sand::Scheme::isotropic, sand::Scheme::plainIsotropic});
        scene.rules.rim = dice.oneOf({sand::Rim::closed, sand::Rim::open});
    }
    scene.rules.tuning.threshold = talusOf(dice.between(1, 55));
    scene.rules.tuning.startThreshold = scene.rules.tuning.threshold + (dice.chance(0.5) ? 0 : 3000);
    scene.rules.tuning.sweepsPerStep = 1 + dice.below(8);
    scene.rules.stepsPerSecond = dice.oneOf({1, 5, 19, 30, 60, 60, 60, 120, 240});
    sand::ForceConstants& force = scene.force;
    force.law = dice.oneOf({sand::ForceLaw::repulse, sand::ForceLaw::controlPoints});
    force.between = dice.oneOf({sand::Between::local, sand::Between::hold, sand::Between::interpolate});
    force.stiffness = dice.scaled(1, 1e5);
    force.depthExponent = dice.scaled(0.05, 5);
    force.friction = dice.scaled(0.1, 1000);
    force.maxForce = dice.scaled(0.1, 1e4);
    force.unitLength = scene.terrain.cellSize() * std::max(scene.rules.columns, scene.rules.rows);
    force.frictionCoefficient = dice.oneOf({0.0, 0.3, 3.0});
    force.literal = dice.chance(0.15);
    if (dice.chance(0.05)) {  // forces that are not finite
        force.stiffness = 1e9;
        force.depthExponent = dice.scaled(1, 1e6);
    }
    return scene;
}

inline haptic_bridge::HandSettings randomSettings(Dice& dice, const haptic_bridge::ArmPhysics& arm,
                                                  const scene::Scene& scene) {
    using haptic_bridge::HandSettings;
    HandSettings settings;
    const double side = std::min(scene.rules.columns, scene.rules.rows) * scene.terrain.cellSize();
    if (dice.chance(0.4)) {
        settings.scale = dice.scaled(0.3, 3) * 0.4 * side / arm.reach;
    }
    if (dice.chance(0.4)) {
        settings.verticalScale = dice.scaled(0.3, 3);
    }
    if (dice.chance(0.4)) {
        std::swap(settings.axes.at(0), settings.axes.at(static_cast<std::size_t>(1 + dice.below(2))));
        settings.axes.at(static_cast<std::size_t>(dice.below(3))).sign = -1;
    }
    settings.drift = dice.chance(0.3) ? dice.between(0, 0.2) : 0;
    settings.depth = dice.between(-0.5, 1);
    settings.engage = dice.oneOf({HandSettings::Engage::always, HandSettings::Engage::always,
                                  HandSettings::Engage::near, HandSettings::Engage::button});
    return settings;
}

/// A hand on an arm that strokes, rests, dips, jumps, presses buttons, and whose device fails now and then.
class RandomHand {
public:
    /// `trouble` is a factor on how often the device fails.
    RandomHand(Dice& dice, const haptic_bridge::HandSettings& settings, const haptic_bridge::ArmPhysics& arm,
               double toolInArm /* [m], radius of the tool */, double trouble)
        : dice_(dice), settings_(settings), reach_(arm.reach), tool_(toolInArm), trouble_(trouble) {
        first_ = dice.chance(0.7);
    }

    [[nodiscard]] haptic_bridge::ArmReading next() {
        if (left_-- <= 0) {
            decide();
        }
        if (dice_.chance(0.001 * trouble_)) {
            place_ = dice_.vector(1.5 * reach_);  // a jump
        }
        for (auto [at, way] : {std::pair{&place_.x, &way_.x}, {&place_.y, &way_.y}}) {
            *at += *way;
            *way = std::abs(*at) > reach_ ? -std::copysign(*way, *at) : *way;
        }
        place_.z += std::clamp(height_ - place_.z, -dive_, dive_);
        first_ = dice_.chance(0.003) ? !first_ : first_;
        clutch_ = dice_.chance(clutch_ ? 0.01 : 0.0005) ? !clutch_ : clutch_;
        const bool goes = dice_.chance(0.002 * trouble_);
        absent_ = goes ? 1 + dice_.below(dice_.oneOf({2, 10, 10, 50})) : std::max(absent_ - 1, 0);
        sand::force::Vec3 read = place_;
        if (dice_.chance(0.0005 * trouble_)) {
            read.y = dice_.odd();
        }
        return {alongItsAxes(read), first_, clutch_, absent_ == 0};
    }

private:
    /// Begins another motion.
    void decide() {
        left_ = 20 + dice_.below(500);
        const double speed = dice_.oneOf({0.0, 0.0, 0.1, 0.1, 0.4, 10.0}) * dice_.between(0, 1);  // [m/s]
        way_ = dice_.vector(1.7 * speed * 1e-3);
        height_ = -dice_.between(-1.5, 4) * tool_;
        dive_ = dice_.oneOf({0.01, 0.1, 1.0, 5.0}) * 1e-3;
    }
    [[nodiscard]] sand::force::Vec3 alongItsAxes(sand::force::Vec3 scene) const {
        const std::array<double, 3> from{scene.x, scene.y, scene.z};
        std::array<double, 3> to{};
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& axis = settings_.axes.at(i);
            to.at(static_cast<std::size_t>(axis.column)) = axis.sign * from.at(i);
        }
        return {to[0], to[1], to[2]};
    }

    Dice& dice_;
    const haptic_bridge::HandSettings& settings_;
    double reach_, tool_, trouble_;
    int left_ = 0, absent_ = 0;      // [tick]
    sand::force::Vec3 place_, way_;  // [m], [m/tick], east, north, up
    double height_ = 0, dive_ = 0;   // [m], [m/tick]
    bool first_ = false, clutch_ = false;
};

}  // namespace test
