// SPDX-License-Identifier: Apache-2.0
// Random fields, laws, grounds and tools, on which the solver is compared with a reference bit for bit.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/code_path.hpp"
#include "sand/grid/dunes.hpp"
#include "sand/grid/erosion.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace worlds {

using base::CodePath;
using sand::grid::Erosion;

inline constexpr std::array kBlocks{2, 8, 13, 32, 128};

/// Random case: a field, its laws, its ground and a tool.
class World {
public:
    /// With `lumpy`, the field has the largest size, and a few lumps on level ground. Most blocks between the lumps are
    /// at rest, so that runs of blocks are short and touch no rim.
    World(unsigned seed, int widest, int highest /* [cell] */, bool lumpy)
        : random(seed),
          field(lumpy ? widest : 1 + below(widest), lumpy ? highest : 1 + below(highest), 1.0),
          rules(samples::rulesFor(field)) {
        chooseRules();
        if (lumpy) {
            chooseLumps();
            return;
        }
        chooseHeights();
        chooseGround();
    }

    int below(int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); }

    /// Returns the tool at a random place, or nullopt in half of the cases.
    std::optional<sand::grid::Obstacle> tool() {
        if (below(2) == 0) {
            return std::nullopt;
        }
        const sand::Tool tool{sand::ToolKind::sphere, (2 + below(8)) * sand::kProbePerCell, 0};
        sand::ProbePoint place{below(field.columns() + 1) * sand::kProbePerCell,
                               below(field.rows() + 1) * sand::kProbePerCell, below(12) * sand::kProbePerCell};
        if (!lumps.empty()) {
            const auto& [x, y] = lumps.at(static_cast<std::size_t>(below(static_cast<int>(lumps.size()))));
            place.x = (x - 6 + below(20)) * sand::kProbePerCell;
            place.y = (y - 6 + below(20)) * sand::kProbePerCell;
        }
        return sand::grid::Displacement(tool).obstacle(field, place);
    }

    [[nodiscard]] std::string text() const {
        return fmt::format("{} x {} cells of aspect {}, {}, threshold {} to {}, rim {}, ground {}", rules.columns,
                           rules.rows, rules.aspect, samples::nameOf(samples::Law(rules.scheme)),
                           rules.tuning.threshold, rules.tuning.startThreshold,
                           rules.rim == sand::Rim::open ? "open" : "closed", ground != nullptr);
    }

    std::mt19937 random;
    sand::HeightField field;
    sand::Rules rules;
    std::unique_ptr<sand::Ground> ground;
    std::vector<std::pair<int, int>> lumps;  // south-western cell of each

private:
    void chooseRules() {
        constexpr std::array kThresholds{0, 100, sand::kUnitsPerCell / 2, sand::kUnitsPerCell, 4 * sand::kUnitsPerCell};
        constexpr std::array kAspects{1, 1, 1, 2, 7};  // divided by 2
        rules.tuning.threshold = kThresholds.at(random() % kThresholds.size());
        // The default of scenes, one unit, and bands that are clearly visible.
        const std::array bands{0, rules.tuning.threshold / 1000, 1, rules.tuning.threshold / 10,
                               rules.tuning.threshold};
        rules.tuning.startThreshold = rules.tuning.threshold + bands.at(random() % bands.size());
        rules.scheme = samples::kSchemes.at(random() % samples::kSchemes.size());
        rules.rim = random() % 2 == 0 ? sand::Rim::open : sand::Rim::closed;
        rules.aspect =
            random() % 2 == 0 ? sand::kUnitsPerCell : kAspects.at(random() % kAspects.size()) * sand::kUnitsPerCell / 2;
    }

    /// Chooses noise, a slope near the talus with a few heaps, or dunes.
    void chooseHeights() {
        const int kind = below(3);
        if (kind == 0) {
            field = samples::randomField(field.columns(), field.rows(), 1 << (8 + below(20)), random);
        } else if (kind == 1) {
            const std::int32_t east = below(rules.tuning.threshold + 2), north = below(rules.tuning.threshold + 2);
            for (int y = 0; y < field.rows(); ++y) {
                for (int x = 0; x < field.columns(); ++x) {
                    field.setHeight(x, y, east * x - north * y + below(16) + (below(30) == 0 ? below(200000) : 0));
                }
            }
        } else {
            sand::grid::makeDunes({.bed = 2, .height = 6, .length = 30, .seed = 5}, field);
        }
    }

    /// Lays lumps of noise, one per 50 x 50 cells.
    void chooseLumps() {
        const int count = std::max(1, field.columns() * field.rows() / 2500);
        for (int i = 0; i < count; ++i) {
            const int x = below(field.columns() - 8), y = below(field.rows() - 8);
            lumps.emplace_back(x, y);
            for (int cell = 0; cell < 64; ++cell) {
                field.setHeight(x + cell % 8, y + cell / 8, below(1 << 21));
            }
        }
    }

    /// Chooses rock and walls in two cases of three.
    void chooseGround() {
        const int kind = below(3);
        if (kind == 0) {
            return;
        }
        ground = std::make_unique<sand::Ground>(field.columns(), field.rows());
        for (int y = 0; y < field.rows(); ++y) {
            for (int x = 0; x < field.columns(); ++x) {
                if (below(kind == 1 ? 30 : 6) == 0) {
                    ground->setWall(x, y);
                } else if (kind == 2) {
                    ground->setBedrock(x, y, field.height(x, y) - below(1 << below(20)));
                }
            }
        }
        rules.ground = ground->digest();
    }
};

/// Ways of sweeping that a comparison prescribes.
struct Way {
    const base::Executor* executor = nullptr;     // null: the calling thread does all work
    std::optional<CodePath> path = std::nullopt;  // nullopt: one that this CPU has, at random in each world
    bool lumpy = false;  // whether all worlds are lumps on level ground, with the blocks that programs have
};

/// The solver and a reference on one case. The field, the tool and the rules change in between. A reference has the
/// members of reference::Sand.
template <class Reference>
class Pair {
public:
    Pair(World world, const Way& way)
        : world_(std::move(world)),
          options_{.blockSize = way.lumpy ? Erosion::kDefaultBlock : kBlocks.at(world_.random() % kBlocks.size()),
                   .path = pathOf(way, world_.random()),
                   .ground = world_.ground.get(),
                   .executor = way.executor},
          field_(world_.field),
          erosion_(field_, world_.rules, options_),
          expected_(field_, world_.rules, world_.ground.get()) {}

    [[nodiscard]] std::string text() const {
        return fmt::format("{}; blocks of {}, {}", world_.text(), options_.blockSize, base::nameOf(options_.path));
    }

    /// Returns the number of sweeps.
    int sweep() {
        const std::int64_t before = erosion_.sweepsDone();
        // Sometimes sweeps so often that the momentum reaches its limit.
        const int sweeps = 1 + world_.below(world_.below(8) == 0 ? 400 : 24);
        outflow_ += erosion_.sweep(field_, sweeps, expected_.tool);
        expected_.sweep(sweeps);
        return static_cast<int>(erosion_.sweepsDone() - before);
    }

    /// Returns how the two sands differ, or an empty text if they are equal.
    [[nodiscard]] std::string difference() const {
        for (int y = 0; y < field_.rows(); ++y) {
            for (int x = 0; x < field_.columns(); ++x) {
                if (field_.height(x, y) != expected_.field.height(x, y)) {
                    return fmt::format("the height of cell {}, {} is {} and should be {}", x, y, field_.height(x, y),
                                       expected_.field.height(x, y));
                }
            }
        }
        if (outflow_ != expected_.outflow) {
            return fmt::format("the outflow is {} and should be {}", outflow_, expected_.outflow);
        }
        if (erosion_.undisturbed() != expected_.undisturbed) {
            return fmt::format("the age of the inertia is {} and should be {}", erosion_.undisturbed(),
                               expected_.undisturbed);
        }
        return "";
    }

    void change() {
        switch (world_.below(4)) {
            case 0:
                return lift();
            case 1:
                return moveTool();
            case 2:
                return changeRules();
            default:
                return saveAndResume();
        }
    }

private:
    static CodePath pathOf(const Way& way, std::mt19937::result_type random) {
        const std::vector<CodePath> here = base::codePathsHere();
        return way.path.value_or(here.at(random % here.size()));
    }

    /// Raises or lowers a few cells, but not below their rock.
    void lift() {
        const int x = world_.below(field_.columns()), y = world_.below(field_.rows());
        const sand::CellRect cells = sand::CellRect{x, y, x + 4, y + 3}.clippedTo(field_.bounds());
        for (int row = cells.y0; row < cells.y1; ++row) {
            for (int column = cells.x0; column < cells.x1; ++column) {
                const std::int32_t height = field_.height(column, row) + world_.below(1 << 18) - (1 << 16);
                const bool wall = options_.ground != nullptr && options_.ground->isWall(column, row);
                const std::int32_t least =
                    options_.ground != nullptr ? options_.ground->bedrock(column, row) : -sand::kMaxHeight;
                field_.setHeight(column, row, wall ? field_.height(column, row) : std::max(height, least));
                expected_.field.setHeight(column, row, field_.height(column, row));
            }
        }
        touch(cells);
    }

    void moveTool() {
        tool_ = world_.tool();
        expected_.tool = tool_ ? &*tool_ : nullptr;
        touch(field_.bounds());
    }

    void changeRules() {
        sand::Rules& rules = expected_.rules;
        rules.tuning.threshold = world_.below(2) == 0 ? rules.tuning.threshold : world_.below(2 * sand::kUnitsPerCell);
        rules.tuning.startThreshold =
            rules.tuning.threshold + (world_.below(2) == 0 ? 0 : world_.below(sand::kUnitsPerCell));
        erosion_.changeRules(rules);
        expected_.undisturbed = 0;
    }

    void saveAndResume() {
        base::ByteWriter writer;
        erosion_.inertia().encode(field_.columns(), field_.rows(), writer);
        base::ByteReader reader(writer.bytes());
        erosion_ = Erosion(field_, expected_.rules, options_);
        const sand::Rules& rules = expected_.rules;
        erosion_.resume(
            sand::grid::Inertia::decode(reader, {field_.columns(), field_.rows(), rules.rim, rules.aspect}));
    }

    void touch(const sand::CellRect& cells) {
        erosion_.touch(cells);
        expected_.undisturbed = 0;
    }

    World world_;
    Erosion::Options options_;
    sand::HeightField field_;
    Erosion erosion_;
    Reference expected_;
    std::optional<sand::grid::Obstacle> tool_;
    std::int64_t outflow_ = 0;
};

/// Compares at least `sweeps` sweeps in worlds of up to `widest` x `highest` cells, with numbers from `seed` on.
/// Returns the first difference, with the seed of its world, or an empty text.
template <class Reference>
std::string firstDifference(unsigned seed, int sweeps, int widest, int highest, const Way& way = {}) {
    for (int done = 0; done < sweeps; ++seed) {
        Pair<Reference> pair(World(seed, widest, highest, way.lumpy), way);
        for (int part = 0; part < 6; ++part) {
            done += pair.sweep();
            if (const std::string difference = pair.difference(); !difference.empty()) {
                return fmt::format("seed {}: {}, part {}: {}", seed, pair.text(), part, difference);
            }
            pair.change();
        }
    }
    return "";
}

}  // namespace worlds
