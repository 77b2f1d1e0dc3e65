// SPDX-License-Identifier: Apache-2.0
// Sand at rims, walls, rock faces and holes, and under tools that are held there. Each result is compared with a closed
// form or with the mirrored experiment. scripts/checks/borders.sh measures the same on larger fields.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sand/grid/settle.hpp"
#include "sand/tin/flow/settle.hpp"
#include "tests/support/borders/border_experiments.hpp"
#include "tests/support/borders/tool_kinds.hpp"

namespace {

using borders::Case;
using borders::Hand;
using borders::kCoarse;
using borders::kGrid;
using borders::kGrounds;
using borders::kSide;
using borders::kTin;
using enum sand::ToolKind;

constexpr auto kTools = support::everyTool();

std::string nameOf(const borders::Ground& ground) { return ground.tin ? "TIN" : "grid"; }

// The whole pile has an error of its own, from cells of finite size. Half of the pile must have half of it, up to a
// tenth: the meshes of half and whole are not mirror images.
TEST(Border, HalfAPileAtAClosedRimIsHalfOfTheWhole) {
    for (const borders::Ground& ground : kGrounds) {
        for (const bool settles : {false, true}) {
            const double whole = borders::rimPile(ground, kSide, true, settles);
            EXPECT_LE(borders::rimPile(ground, kSide, false, settles), 0.55 * whole) << nameOf(ground) << settles;
        }
    }
}

// The piles start from heights at the middles of cells. At this size, up to 1.2 % of the cylinder's sand is missing or
// too much, and nothing of the prism's. A TIN takes a slope of up to 1.001 of the talus for the talus. Without vertices
// at a border of a TIN, 9 % is misplaced.
TEST(Border, PilesLeanAgainstRimsCornersWallsAndRockAsInAMirror) {
    using enum borders::Face;
    for (const borders::Ground& ground : kGrounds) {
        for (const borders::Face face : {rim, corner, wall, rock}) {
            for (const bool prism : {false, true}) {
                if ((ground.tin && face == rock) || (prism && face == corner)) {
                    continue;  // a TIN has no rock, and a prism no corner
                }
                const double most = !prism ? 0.012 : ground.tin ? 1e-3 : 1e-4;
                for (const double band : {0.0, 0.3}) {
                    EXPECT_LE(borders::leaningPile(ground, kSide, face, prism, band), most)
                        << nameOf(ground) << ", " << borders::nameOf(face) << ", prism " << prism << ", band " << band;
                }
            }
        }
    }
}

// A mesh differs from its mirror image, so that a drag in the middle leaves two different halves. Half a field may
// differ from its mirror by as much.
TEST(Border, ADragAlongAClosedRimLeavesHalfOfItsMirror) {
    for (const borders::Ground& ground : {kTin, kCoarse}) {
        const borders::Drag drag = borders::rimDrag(ground, kSide);
        EXPECT_LE(drag.misplaced, borders::mirrorError(ground, kSide)) << ground.widest;
        EXPECT_LE(drag.largest, ground.widest == 1 ? 0.25 : 1) << ground.widest;
    }
    // The ground beyond a grid's closed rim continues with the same slope.
    EXPECT_LE(borders::rimDrag(kGrid, kSide).misplaced, 5);
}

// A TIN takes a slope of up to 1.001 of the talus for the talus.
TEST(Border, ABankOfATinThatSlidesStopsAtTheTalusInHoweverManySteps) {
    for (const double start : {0.81 * 1.2, 1.62}) {
        const borders::Steepness bank = borders::wetBank(kSide, start);
        EXPECT_LE(bank.largest, 1.002) << start;
        EXPECT_GE(bank.largest, 0.999) << start;
    }
}

TEST(Border, NoToolPushesSandThroughAWallOrOverHigherRock) {
    for (const sand::ToolKind kind : kTools) {
        EXPECT_EQ(borders::throughWalls(kGrid, kSide, kind), 0) << base::nameOf(kind);
        EXPECT_EQ(borders::throughWalls(kTin, kSide, kind), 0) << base::nameOf(kind);
        EXPECT_EQ(borders::overRidge(kSide, kind), 0) << base::nameOf(kind);
    }
}

TEST(Border, NoToolCarriesSandAcrossAThinWallAtAnyAngle) {
    for (const sand::ToolKind kind : kTools) {
        for (const double degrees : {0.0, 20.0, 45.0, 80.0}) {
            for (const borders::Ground& ground : {kGrid, kTin, kCoarse}) {
                EXPECT_EQ(borders::acrossWall(ground, kSide, kind, degrees), 0)
                    << base::nameOf(kind) << ' ' << degrees << ' ' << nameOf(ground) << ground.widest;
            }
        }
    }
}

// Rock that is lower than the sand which is pushed does not hold it back.
TEST(Border, SandPassesOverRockThatIsLowerThanIt) {
    Case given = borders::caseOf(kGrid, kSide);
    given.rock = [](double x, double) { return x > 32 && x < 33 ? 7.0 : 0.0; };
    sand::Replica sand(borders::sceneOf(given));
    Hand(sand).drag(20, 32, 31, 32, 8);
    double east = 0;
    for (int x = 33; x < kSide; ++x) {
        east += borders::heightAt(sand, x + 0.5, 32.5) - 8;
    }
    EXPECT_GT(east, 1);
}

// A bowl in a mesh is made of triangles, which stand above it by less than a fifteenth of the radius. On a finer mesh a
// tool has more triangles.
TEST(Border, NoSandStandsAboveTheUndersideOfATool) {
    using enum borders::Where;
    EXPECT_LE(borders::underTool(kTin, 2 * kSide, sphere, hole), 0.4);
    EXPECT_LE(borders::underTool(kTin, 2 * kSide, ellipsoid, middle), 0.4);
    for (const borders::Where where : {middle, rim, hole}) {
        for (const sand::ToolKind kind : {sphere, ellipsoid}) {
            EXPECT_LE(borders::underTool(kTin, kSide, kind, where), 0.4)
                << base::nameOf(kind) << static_cast<int>(where);
        }
        for (const sand::ToolKind kind : {circle, rectangle, ellipse}) {
            EXPECT_LE(borders::underTool(kTin, kSide, kind, where), 1e-3)
                << base::nameOf(kind) << static_cast<int>(where);
        }
    }
}

TEST(Border, SettleLetsNoSandFlowIntoAToolThatIsHeld) {
    for (const borders::Ground& ground : kGrounds) {
        for (const bool atRest : {false, true}) {
            const borders::Held held = borders::heldSettle(ground, kSide, atRest);
            EXPECT_LE(held.largest, ground.tin ? 0.4 : 0) << nameOf(ground) << atRest;
            EXPECT_TRUE(held.still) << nameOf(ground) << atRest;
        }
    }
}

/// Returns a scene whose settle takes several steps: a wide field, or one with a wall.
Case slowCase(bool tin) {
    Case given;
    given.tin = tin;
    given.columns = given.rows = tin ? 64 : 512;
    given.sweeps = 4;
    given.radius = 6;
    given.maxError = 0;
    const double middle = given.columns / 2.0;
    given.height = [middle, tin](double x, double y) {
        return std::hypot(x - middle, y - middle) < (tin ? 12 : 200) ? (tin ? 8.0 : 150.0) : 0.0;
    };
    return given;
}

TEST(Settle, WithAToolHeldGoesOnInTheStepsAfter) {
    sand::Replica sand(borders::sceneOf(slowCase(false)));
    Hand hand(sand);
    hand.press(256, 256, 148);
    hand.hold(sand::Edit::settle);
    ASSERT_TRUE(sand.settling()) << "one step must not be enough, or the test proves nothing";
    sand::Replica other(borders::sceneOf(slowCase(false)));
    other.decodeState(sand.encodeState());
    EXPECT_TRUE(other.settling());
    EXPECT_EQ(other.stateHash(), sand.stateHash());
    hand.hold();
    Hand(other).hold();
    EXPECT_EQ(other.stateHash(), sand.stateHash()) << "a replica that loads the state must continue alike";
    sand::Replica plain = sand;
    plain.decodeState([&] {  // the same state, but without the settle
        const base::Bytes state = sand.encodeState();
        base::ByteReader reader(state);
        auto head = base::read<sand::StateHead>(reader);
        head.owed = {};
        base::Bytes changed = base::encoded(head);
        changed.insert(changed.end(), reader.rest().begin(), reader.rest().end());
        return changed;
    }());
    EXPECT_FALSE(plain.settling());
    EXPECT_NE(plain.stateHash(), sand.stateHash()) << "the hash must show that a settle continues";
    for (const sand::Edit::Kind edit : {sand::Edit::undo, sand::Edit::reset}) {
        sand::Replica ended = sand;
        Hand(ended).hold(edit);
        EXPECT_FALSE(ended.settling()) << static_cast<int>(edit);
    }
    sand::Replica loaded = sand;
    Hand(loaded).hold(sand::Edit::loaded(sand.copySand()->encode()));
    EXPECT_FALSE(loaded.settling());
    sand::Replica again = sand;
    Hand(again).hover(sand::Edit::settle);
    for (int i = 0; i < 1000 && again.settling(); ++i) {
        Hand(again).hover();
    }
    EXPECT_TRUE(again.settled()) << "a settle without a tool takes the place of the other";
}

// Such sand took two minutes in its step, and no wall has a frame meanwhile.
TEST(Settle, ThatIsNotDoneAfterTheWorkOfAStepGoesOnInTheStepsAfter) {
    Case given;
    given.columns = given.rows = 512;
    given.sweeps = 4;
    given.height = [](double x, double) { return x < 256 ? 4096.0 : -4096.0; };
    const scene::Scene scene = borders::sceneOf(given);
    sand::Replica sand(scene);
    const std::int64_t volume = sand.volume();
    sand::HeightField field = scene.terrain;
    sand::WorkLimit limit(sand.surface().mostSettlingWork());
    EXPECT_FALSE(sand::grid::settle(field, scene.rules, nullptr, base::fastestCodePath(), &limit).atRest);
    EXPECT_TRUE(limit.reached());
    Hand hand(sand);
    hand.hover(sand::Edit::settle);
    ASSERT_TRUE(sand.settling());
    EXPECT_EQ(sand.volume(), volume);
    EXPECT_LE(sand.lastWork().sweeps, sand.settlingSweeps());
    EXPECT_FALSE(sand.holdsTool());
    EXPECT_EQ(sand.mostSweeps({}), sand::kMostSweeps) << "a program that numbers steps divides the rest";
    sand::Replica other(scene);
    other.decodeState(sand.encodeState());
    hand.hover();
    Hand(other).hover();
    EXPECT_EQ(other.stateHash(), sand.stateHash()) << "a replica that loads the state must continue alike";
    EXPECT_TRUE(sand.settling());
    EXPECT_EQ(sand.volume(), volume);
    Hand(other).press(256, 256, 0);
    EXPECT_FALSE(other.settling()) << "the first movement of a tool in the sand ends it";
}

// 2^27 cells in a step, at least 16 and at most 4096 sweeps. A vertex of a TIN takes as long as 16 cells.
TEST(Settle, RunsAtMostAsManySweepsInAStepAsTheFieldAllows) {
    const auto sweepsOf = [](int side, bool tin) {
        Case given;
        given.columns = given.rows = side;
        given.tin = tin;
        return sand::Replica(borders::sceneOf(given)).settlingSweeps();
    };
    EXPECT_EQ(sweepsOf(64, false), 4096);
    EXPECT_EQ(sweepsOf(512, false), 512);
    EXPECT_EQ(sweepsOf(2048, false), 32);
    EXPECT_EQ(sweepsOf(128, true), (1 << 27) / (16 * (128 * 128 + 4 * 127 + 4)));
}

/// Returns a damp bank that slides from a slope of 1.62 and stops at the talus of 0.81.
Case bankCase() {
    Case given = borders::caseOf(kTin, 32);
    given.talus = 0.81;
    given.start = 1.62;
    given.height = [](double x, double) { return std::clamp(10 - 2.5 * (x - 16), 0.0, 20.0); };
    return given;
}

// The state of a TIN records which sand moves. Another replica that loads the state continues alike. A load and an undo
// restore it, and a reset forgets it.
TEST(MovingSand, OfATinIsPartOfTheState) {
    const Case given = bankCase();
    sand::Replica sand(borders::sceneOf(given));
    const auto moving = [](const sand::Replica& replica) {
        const auto& bits = dynamic_cast<const sand::tin::TinSurface&>(replica.surface()).layer().moving();
        return std::count(bits.begin(), bits.end(), 1);
    };
    Hand hand(sand);
    for (int i = 0; i < 5; ++i) {
        hand.hover();
    }
    ASSERT_GT(moving(sand), 50);
    sand::Replica other(borders::sceneOf(given));
    other.decodeState(sand.encodeState());
    sand::Replica copy = sand;
    for (int i = 0; i < 10; ++i) {
        hand.hover();
        Hand(other).hover();
        Hand(copy).hover();
        ASSERT_EQ(other.stateHash(), sand.stateHash()) << i;
        ASSERT_EQ(copy.stateHash(), sand.stateHash()) << i;
    }
    sand::Replica undone = sand;
    Hand(undone).press(16, 16, 20);
    Hand(undone).hover();
    Hand(undone).hover(sand::Edit::undo);
    EXPECT_EQ(moving(undone), moving(sand)) << "an undo restores it";
    sand::Replica loaded(borders::sceneOf(given));
    Hand(loaded).hover(sand::Edit::loaded(sand.copySand()->encode()));
    EXPECT_EQ(moving(loaded), moving(sand)) << "a load restores it";
    sand::Replica forgotten = sand;
    Hand(forgotten).hover(sand::Edit::reset);
    EXPECT_EQ(moving(forgotten), 0) << "a reset forgets it";
    ASSERT_TRUE(hand.rest());
    EXPECT_EQ(moving(sand), 0) << "sand at rest does not move";
}

// A settle that runs out of sweeps leaves sand that still slides. No sand may count as moving afterwards. Without
// that, the next step would let sand slide at slopes at which sand at rest stays.
TEST(MovingSand, OfATinStopsAtASettleThatRunsOutOfSweeps) {
    const Case given = bankCase();
    sand::Replica sand(borders::sceneOf(given));
    Hand hand(sand);
    for (int i = 0; i < 5; ++i) {
        hand.hover();
    }
    sand::tin::VertexSand layer = dynamic_cast<const sand::tin::Snapshot&>(*sand.copySand()).layer();
    const std::vector<std::uint8_t> before = layer.moving();
    ASSERT_GT(std::count(before.begin(), before.end(), 1), 50);
    const auto settled =
        sand::tin::settle(layer, borders::units(given.talus), borders::units(given.start), 2, given.rim);
    ASSERT_FALSE(settled.atRest) << "two sweeps must not be enough, or the test proves nothing";
    EXPECT_EQ(std::count(layer.moving().begin(), layer.moving().end(), 1), 0);
    for (std::size_t i = 0; i < before.size(); ++i) {
        const auto vertex = static_cast<sand::tin::Vertex>(i);
        EXPECT_TRUE(before[i] == 0 || std::binary_search(settled.moved.begin(), settled.moved.end(), vertex))
            << "the hash of vertex " << vertex << " must be computed again";
    }
}

// A tool that is held presses once on sand that has come back, so that no sand is above its underside.
TEST(HeldTool, PressesOnceAfterUndoResetAndLoad) {
    for (const borders::Ground& ground : kGrounds) {
        Case given = borders::caseOf(ground, kSide);
        given.tool = circle;
        given.height = [](double, double) { return 20.0; };
        sand::Replica sand(borders::sceneOf(given));
        const auto saved = sand.copySand()->encode();
        Hand hand(sand);
        hand.press(32.2, 31.4, 20);
        for (const sand::Edit& edit :
             {sand::Edit(sand::Edit::undo), sand::Edit(sand::Edit::reset), sand::Edit::loaded(saved)}) {
            hand.hold(edit);
            EXPECT_LE(borders::overUnderside(sand, sand.probe()), 1e-3)
                << nameOf(ground) << static_cast<int>(edit.kind);
        }
        hand.hover();
        hand.hover(sand::Edit::undo);
        EXPECT_EQ(borders::heightAt(sand, 32.2, 31.4), 20) << "the stroke begins with the sand that came back";
    }
}

// Walls that enclose the tool, tools wider than a pocket, and holes that leave single triangles.
TEST(Border, AToolThatAPocketCannotHoldPassesThroughItsSand) {
    for (const borders::Ground& ground : kGrounds) {
        for (const int inside : {1, 2, 5}) {
            Case given = borders::caseOf(ground, kSide);
            given.wall = [inside](int x, int y) {
                const bool in = x >= 30 && x < 30 + inside && y >= 30 && y < 30 + inside;
                return x >= 29 && x <= 30 + inside && y >= 29 && y <= 30 + inside && !in;
            };
            for (const sand::ToolKind kind : kTools) {
                given.tool = kind;
                sand::Replica sand(borders::sceneOf(given));
                const sand::Replica before = sand;
                Hand hand(sand);
                hand.press(30 + inside / 2.0, 30 + inside / 2.0, 8);
                hand.drag(30, 30, 40, 33, 7);
                hand.hover();
                EXPECT_EQ(borders::exchanged(before, sand), 0) << nameOf(ground) << inside << base::nameOf(kind);
                EXPECT_EQ(sand.volume(), before.volume());
            }
        }
    }
}

}  // namespace
