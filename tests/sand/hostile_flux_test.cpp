// SPDX-License-Identifier: Apache-2.0
// Fluxes in sand from outside. A state holds those of the last sweep, and only a sweep replaces them.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <random>
#include <string>

#include "sand/grid/snapshot.hpp"
#include "sand/replica.hpp"
#include "tests/support/sand/hostile_sand.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_of.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::CellArray;
using sand::Replica;
using sand::Rim;

constexpr std::int32_t kMostFlux = sand::kMaxHeight / 2;  // the largest flux of square cells
constexpr std::array kFluxRims{Rim::closed, Rim::open};

/// A face to the east or to the north of a cell, which may lie one cell beside the field.
struct Face {
    bool east;
    int column, row;
};

scene::Scene sceneOf(int columns, int rows, Rim rim) {
    scene::Scene scene = samples::flatScene(columns, rows);
    scene.rules.rim = rim;
    return scene;
}

/// Returns the sand of `field` with the fluxes of two grids.
base::Bytes sandWith(const sand::HeightField& field, const CellArray& east, const CellArray& north) {
    sand::grid::Inertia inertia(3);
    inertia.keep(east, north, {-1, -1, field.columns(), field.rows()});
    return sand::grid::Snapshot(field, inertia, 0).encode();
}

base::Bytes sandWith(const sand::HeightField& field, const Face& face, std::int32_t flux) {
    CellArray east(field.columns(), field.rows()), north(field.columns(), field.rows());
    (face.east ? east : north).row(face.row)[face.column] = flux;
    return sandWith(field, east, north);
}

/// Returns why a replica of `scene` refuses a state with such a flux, or an empty text.
std::string refusal(const scene::Scene& scene, const Face& face, std::int32_t flux) {
    Replica replica(scene);
    const base::Bytes sand = sandWith(scene.terrain, face, flux);
    try {
        replica.decodeState(hostile_sand::stateWith(replica, sand));
    } catch (const base::FormatError& error) {
        replica.apply({.number = 1, .edit = sand::Edit::loaded(sand)});
        EXPECT_EQ(replica.leftOut(), std::string("its load was ignored: ") + error.what());
        return error.what();
    }
    replica.apply({.number = 1, .edit = sand::Edit::loaded(sand)});
    EXPECT_EQ(replica.leftOut(), "");
    return "";
}

TEST(HostileFlux, OverAFaceThatNoSweepComputesIsRefusedByName) {
    struct Case {
        Face face;
        bool ofOpen, ofClosed;  // whether fluxes of such a rim are accepted
    };
    const std::array<Case, 10> cases{{{{true, -1, 5}, true, false},   // over the western rim
                                      {{true, 23, 5}, true, false},   // over the eastern rim
                                      {{false, 7, -1}, true, false},  // over the southern rim
                                      {{false, 7, 15}, true, false},  // over the northern rim
                                      {{true, 7, -1}, false, false},  // beyond the field
                                      {{false, -1, 5}, false, false},
                                      {{true, -1, -1}, false, false},
                                      {{true, 22, 15}, true, true},
                                      {{false, 0, 0}, true, true},
                                      {{true, 7, 5}, true, true}}};
    for (const auto& [face, ofOpen, ofClosed] : cases) {
        for (const Rim rim : kFluxRims) {
            const scene::Scene scene = sceneOf(24, 16, rim);
            for (const std::int32_t flux : {1, -1, kMostFlux, -kMostFlux}) {
                const std::string found = refusal(scene, face, flux);
                const std::string place = "sand with a flux of " + std::to_string(flux) + " to the " +
                                          (face.east ? "east" : "north") + " from column " +
                                          std::to_string(face.column) + ", row " + std::to_string(face.row) + ": ";
                EXPECT_EQ(found.empty(), rim == Rim::open ? ofOpen : ofClosed) << place << found;
                EXPECT_EQ(found.find(place), found.empty() ? std::string::npos : 0) << found;
            }
        }
    }
}

TEST(HostileFlux, LargerThanASweepCanMakeIsRefused) {
    const scene::Scene scene = sceneOf(24, 16, Rim::closed);
    for (const std::int32_t flux : {kMostFlux + 1, -kMostFlux - 1, sand::kMaxHeight, -sand::kMaxHeight}) {
        EXPECT_NE(refusal(scene, {true, 7, 5}, flux).find(": the most is 134217728"), std::string::npos) << flux;
    }
}

/// All faces of one cell, and of one row of cells, are at a rim.
TEST(HostileFlux, OfAFieldOfOneCellIsRefusedUnlessItsRimIsOpen) {
    for (const Rim rim : kFluxRims) {
        for (const Face& face : {Face{true, -1, 0}, {true, 0, 0}, {false, 0, -1}, {false, 0, 0}}) {
            EXPECT_EQ(refusal(sceneOf(1, 1, rim), face, 9).empty(), rim == Rim::open);
        }
        EXPECT_EQ(refusal(sceneOf(3, 1, rim), {false, 1, 0}, 9).empty(), rim == Rim::open);
        EXPECT_EQ(refusal(sceneOf(3, 1, rim), {true, 1, 0}, 9), "");
    }
}

/// Returns a scene with walls, holes of one cell, and rock below sand. A wall touches the rim.
scene::Scene walled(Rim rim) {
    scene::Scene scene = sceneOf(24, 16, rim);
    auto ground = std::make_shared<sand::Ground>(24, 16);
    for (int y = 0; y < 12; ++y) {
        ground->setWall(9, y);
    }
    ground->setWall(15, 8);
    ground->setWall(0, 14);
    for (int x = 12; x < 20; ++x) {
        ground->setBedrock(x, 4, -sand::kUnitsPerCell);
    }
    scene.rules.ground = ground->digest();
    scene.ground = std::move(ground);
    return scene;
}

// A sweep computes the faces of walls like all others: they let nothing through. So their fluxes are accepted.
TEST(HostileFlux, BesideWallsLosesNothing) {
    for (const Rim rim : kFluxRims) {
        const scene::Scene scene = walled(rim);
        for (const Face& face : {Face{true, 8, 5},
                                 {true, 9, 5},
                                 {false, 9, 11},
                                 {false, 9, 5},
                                 {true, 14, 8},
                                 {true, 15, 8},
                                 {false, 15, 7},
                                 {false, 15, 8},
                                 {true, 0, 14}}) {
            for (const std::int32_t flux : {kMostFlux, -kMostFlux, 1}) {
                Replica replica(scene);
                replica.decodeState(hostile_sand::stateWith(replica, sandWith(scene.terrain, face, flux)));
                replica.apply({.number = 1});
                EXPECT_TRUE(sameHeights(samples::fieldOf(replica), scene.terrain))
                    << face.east << ' ' << face.column << ' ' << face.row;
                EXPECT_TRUE(replica.settled());
            }
        }
    }
}

/// Returns sand with random heights and fluxes, as large as they can be, on every face that may have one.
base::Bytes wildSand(const scene::Scene& scene, std::mt19937& random) {
    const int columns = scene.rules.columns, rows = scene.rules.rows;
    sand::HeightField field(columns, rows, 1.0);
    CellArray east(columns, rows), north(columns, rows);
    const auto upTo = [&random](std::int32_t most) {
        const auto part = static_cast<std::int32_t>(random() % (2U * static_cast<std::uint32_t>(most) + 1));
        return random() % 3 == 0 ? most : random() % 2 == 0 ? -most : part - most;
    };
    const bool open = scene.rules.rim == Rim::open;
    for (int y = -1; y < rows; ++y) {
        for (int x = -1; x < columns; ++x) {
            if (x >= 0 && y >= 0) {
                const std::int32_t height = upTo(sand::kMaxHeight);
                const bool wall = scene.ground && scene.ground->isWall(x, y);
                const std::int32_t rock = scene.ground ? scene.ground->bedrock(x, y) : -sand::kMaxHeight;
                field.setHeight(x, y, wall ? height : std::max(height, rock));
            }
            east.row(y)[x] = y >= 0 && (open || (x >= 0 && x + 1 < columns)) ? upTo(kMostFlux) : 0;
            north.row(y)[x] = x >= 0 && (open || (y >= 0 && y + 1 < rows)) ? upTo(kMostFlux) : 0;
        }
    }
    return sandWith(field, east, north);
}

TEST(HostileFlux, ThatIsAcceptedMovesSandWithinTheOldExtremesAndLosesNone) {
    std::mt19937 random(7431);
    for (int i = 0; i < (samples::kSlowBuild ? 40 : 400); ++i) {
        const Rim rim = kFluxRims.at(random() % 2);
        scene::Scene scene = random() % 2 == 0 ? walled(rim) : sceneOf(1 + static_cast<int>(random() % 24), 16, rim);
        scene.rules.tuning.startThreshold += random() % 2 == 0 ? 0 : sand::kUnitsPerCell / 2;
        scene.rules.scheme = samples::kSchemes.at(random() % samples::kSchemes.size());
        Replica replica(scene);
        replica.decodeState(hostile_sand::stateWith(replica, wildSand(scene, random)));
        const std::int64_t volume = replica.volume();
        for (std::uint64_t number = 1; number <= 12; ++number) {
            replica.apply({.number = number});
            ASSERT_EQ(replica.volume() + replica.outflow(), volume) << "scene " << i << ", step " << number;
            const samples::Extremes found = samples::extremesOf(samples::fieldOf(replica));
            ASSERT_LE(found.highest, sand::kMaxHeight);
            ASSERT_GE(found.lowest, -sand::kMaxHeight);
        }
    }
}

}  // namespace
