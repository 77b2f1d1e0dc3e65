// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/sand/relaxations.hpp"
#include "sand/grid/coarse_level.hpp"
#include "sand/grid/displacement.hpp"
#include "sand/grid/erosion.hpp"

namespace bench {

/// Coarse levels and fine sweeps of a step.
struct DigLaw {
    std::string name;
    std::vector<std::pair<int, int>> levels;  // side [cell] and sweeps
    int moved, still;                         // [sweep]
    int nearer = 0;                           // by how much the patch is smaller on each side [cell]
};

/// Sand and borders in which a tool digs.
struct DigPlace {
    std::string name = "level";
    int side = 512;       // [cell]
    double middle = 0.5;  // of the circle, from west to east [field]
    sand::Rim rim = sand::Rim::closed;
    double rock = 0;    // depth [cell]; 0: none
    bool wall = false;  // across the circle
    double band = 1e-3;
};

struct DigCase {
    DigPlace place;
    sand::Tool tool;

    [[nodiscard]] int radius() const { return tool.radius / sand::kProbePerCell; }
    [[nodiscard]] int allSweeps() const { return (radius() * radius() + 5) / 6; }
    [[nodiscard]] sand::Rules rules(const sand::HeightField& field) const {
        sand::Rules rules = rulesFor(field, kTalus, place.band);
        rules.rim = place.rim;
        rules.tuning.tool = tool;
        rules.tuning.sweepsPerStep = allSweeps();
        return rules;
    }
    [[nodiscard]] std::unique_ptr<sand::Ground> ground() const {
        if (place.rock <= 0 && !place.wall) {
            return nullptr;
        }
        auto ground = std::make_unique<sand::Ground>(place.side, place.side);
        for (int y = 0; y < place.side; ++y) {
            for (int x = 0; x < place.side && place.rock > 0; ++x) {
                const double depth = place.rock * (1 + 0.5 * std::sin(x / 30.0) * std::cos(y / 23.0));
                ground->setBedrock(x, y, static_cast<std::int32_t>(-depth * sand::kUnitsPerCell));
            }
            if (place.wall) {
                ground->setWall(place.side * 3 / 5, y);
            }
        }
        return ground;
    }
};

/// Field in which a tool digs along a circle, and then is lifted.
class CircleDigger {
public:
    static constexpr int kMostStepsToRest = 4000;
    static constexpr int kHandSamples = 17;           // of the hand in a step
    static constexpr double kFieldSpeed = 9.4 / 512;  // [field per step], of script:gis
    static constexpr double kHandCircle = 0.2;        // [field], radius of the circle along which the hand moves

    explicit CircleDigger(const DigCase& given)
        : case_(given),
          field_(given.place.side, given.place.side, 1.0),
          rules_(given.rules(field_)),
          ground_(given.ground()),
          erosion_(field_, rules_, {.ground = ground_.get()}),
          displacement_(given.tool) {
        erosion_.sweep(field_, 1);
    }

    void dig(const DigLaw& law) {
        std::vector<sand::ProbePoint> path{at_};
        for (int sample = 0; sample < kHandSamples; ++sample) {
            path.push_back(handAt(steps_ + static_cast<double>(sample) / kHandSamples));
        }
        if (steps_++ == 0) {
            path.front() = path[1];
        }
        path = sand::pathInSubsteps(std::move(path), rules_.substepLength());
        for (std::size_t i = 1; i < path.size(); ++i) {
            erosion_.touch(displacement_.drag(field_, rules_.rim, ground_.get(), path[i - 1], path[i]).cells);
        }
        erosion_.touch(displacement_.cells(field_, path.front()));
        at_ = path.back();
        const sand::grid::Obstacle tool = displacement_.obstacle(field_, at_);
        slide(law, path, &tool);
        erosion_.sweep(field_, law.moved, &tool);
    }
    /// Lifts the tool and sweeps until all sand rests. Returns the number of steps.
    int lift(const DigLaw& law) {
        erosion_.touch(displacement_.cells(field_, at_));
        slide(law, {at_}, nullptr);
        erosion_.sweep(field_, law.moved);
        int steps = 1;
        for (; !erosion_.settled() && steps < kMostStepsToRest; ++steps) {
            erosion_.sweep(field_, law.still);
        }
        return steps;
    }
    [[nodiscard]] const sand::HeightField& field() const { return field_; }

private:
    [[nodiscard]] sand::ProbePoint handAt(double step) const {
        const double side = case_.place.side, turn = step * kFieldSpeed / kHandCircle;
        // Spheres and ellipsoids are 0.8 radii deep. The flat tools and the sole are 0.2 radii deep.
        const bool deep = case_.tool.kind == sand::ToolKind::sphere || case_.tool.kind == sand::ToolKind::ellipsoid;
        return sand::probePoint(side * (case_.place.middle + kHandCircle * std::cos(turn)),
                                side * (0.5 + kHandCircle * std::sin(turn)), case_.radius() * (deep ? 0.2 : 0.8));
    }
    void slide(const DigLaw& law, const std::vector<sand::ProbePoint>& path, const sand::grid::Obstacle* tool) {
        sand::CellRect way;
        for (const sand::ProbePoint& at : path) {
            const int x = at.x >> sand::kProbeBits, y = at.y >> sand::kProbeBits;
            way = way.joinedWith({x, y, x + 1, y + 1});
        }
        const sand::CellRect patch = way.grownBy(displacement_.reachOfCoarsePhase() - law.nearer);
        const sand::grid::CoarseLevel::Site site{field_, rules_, ground_.get(), tool, {}};
        for (const auto& [side, sweeps] : law.levels) {
            erosion_.touch(sand::grid::CoarseLevel(site, patch, side).sweep(sweeps).changed);
        }
    }

    DigCase case_;
    sand::HeightField field_;
    sand::Rules rules_;
    std::unique_ptr<sand::Ground> ground_;
    sand::grid::Erosion erosion_;
    sand::grid::Displacement displacement_;
    sand::ProbePoint at_;
    int steps_ = 0;
};

}  // namespace bench
