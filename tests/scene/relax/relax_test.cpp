// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <random>
#include <string>

#include "sand/grid/certificate.hpp"
#include "sand/grid/erosion.hpp"
#include "sand/grid/settle.hpp"
#include "scene/relax/steepness.hpp"
#include "tests/scene/relax/relax_fixture.hpp"
#include "tests/support/sand/reference_sweep.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/sand/tight_projection.hpp"

namespace {

constexpr double kUnit = 1.0 / sand::kUnitsPerCell;

std::vector<double> heightsOf(const sand::HeightField& field) {
    std::vector<double> heights;
    for (int y = field.rows() - 1; y >= 0; --y) {
        for (int x = 0; x < field.columns(); ++x) {
            heights.push_back(field.height(x, y) * kUnit);
        }
    }
    return heights;
}

void expectHeights(const std::string& file, const sand::HeightField& expected) {
    const scene::EsriGrid grid = scene::readEsriGrid(file);
    ASSERT_EQ(grid.columns, expected.columns());
    ASSERT_EQ(grid.rows, expected.rows());
    for (int y = 0; y < grid.rows; ++y) {
        for (int x = 0; x < grid.columns; ++x) {
            ASSERT_EQ(std::lround(grid.at(x, y) / kUnit), expected.height(x, y)) << x << ", " << y;
        }
    }
}

// The library runs in one call, the program sweep by sweep and with another datum. The result does not depend on
// either.
TEST_F(Relax, GivesWhatTheLibraryGives) {
    const sand::HeightField start = samples::cylinder(64, 16, 9.6);
    writeGrid("in.asc", 64, 64, heightsOf(start));
    sand::Rules rules = samples::flatScene(64, 64).rules;
    for (const auto& [scheme, name] : valuesOf(sand::Scheme{})) {
        rules.scheme = scheme;
        sand::HeightField expected = start;
        sand::grid::Erosion erosion(expected, rules);
        erosion.sweep(expected, 100000);
        const auto json = relax(fmt::format("in.asc out.asc --talus 45 --scheme {}", name));
        EXPECT_EQ(json["sweeps"], erosion.sweepsDone()) << name;
        EXPECT_EQ(json["volume_after"], expected.volume()) << name;
        expectHeights(path("out.asc"), expected);
    }
    rules.scheme = sand::Scheme::isotropic;
    sand::HeightField expected = start;
    const sand::grid::Settled settled = sand::grid::settle(expected, rules);
    const auto json = relax("in.asc out.asc --talus 45 --scheme settle");
    EXPECT_EQ(json["iterations"], settled.iterations);
    expectHeights(path("out.asc"), expected);
}

TEST_F(Relax, TellsWhatItDidInOneLine) {
    const sand::HeightField start = samples::cylinder(32, 8, 5);
    writeGrid("in.asc", 32, 32, heightsOf(start));
    const auto json = relax("in.asc out.asc --talus 45");
    EXPECT_EQ(json["scheme"], "g");
    EXPECT_EQ(json["unit"], kUnit);
    EXPECT_EQ(json["volume_unit"], kUnit);
    EXPECT_TRUE(json["volume_before"].is_number_integer());
    EXPECT_EQ(json["volume_before"], start.volume());
    EXPECT_EQ(json["volume_after"], start.volume());
    EXPECT_EQ(json["volume_above"], 0.0);
    EXPECT_EQ(json["at_rest"], true);
    EXPECT_GT(json["seconds"], 0.0);
    EXPECT_LE(json["steepest_over_talus"], 1.01)
        << "with a threshold of 4096 units or more, slopes rest within a percent";
    EXPECT_GT(json["steepest_over_talus"], 0.9) << "a pile lies at its talus";
    EXPECT_NEAR(json["steepest_deg"], 45, 0.3);
    EXPECT_GT(json["certificate"]["bound"], 0.0);
    EXPECT_EQ(json["state_hash"].get<std::string>().size(), 16U);
    const auto early = relax("in.asc out.asc --talus 45 --sweeps 1");
    EXPECT_GT(early["steepest_over_talus"], 1.2) << "after one sweep the pile is far from rest";
    EXPECT_EQ(early["at_rest"], false);
    EXPECT_NE(early["state_hash"], json["state_hash"]);
}

/// Returns the certificate of the sand that the library relaxes, or for g_plain the plain sweeps of the tests.
sand::grid::Certificate certificateOf(const std::string& scheme, const sand::HeightField& start,
                                      const sand::Rules& rules) {
    sand::HeightField rest = start;
    sand::grid::NetFlux flux(start.columns(), start.rows());
    if (scheme == "settle") {
        (void)sand::grid::settle(rest, rules, &flux);
    } else if (scheme == "g_plain") {
        flux = reference::relax(rest, rules.tuning.threshold, reference::Isotropic());
    } else {
        sand::grid::Erosion erosion(rest, rules);
        while (!erosion.settled()) {
            erosion.sweep(rest, 1);
            erosion.addFluxes(flux);
        }
    }
    return certify(start, rest, flux, rules);
}

// The right pile is that of a slow solver, which shares no code with the program.
TEST_F(Relax, CertifiesHowFarThePileIsFromTheRightOne) {
    const sand::HeightField start = samples::cylinder(24, 6, 4);
    writeGrid("in.asc", 24, 24, heightsOf(start));
    sand::Rules rules = samples::flatScene(24, 24).rules;
    rules.tuning.threshold = rules.tuning.startThreshold = sand::kUnitsPerCell;
    reference::TightProjection right(start, sand::kUnitsPerCell);
    ASSERT_TRUE(right.solve());
    for (const std::string scheme : {"g", "g_plain", "settle"}) {
        const auto json = relax("in.asc out.asc --talus 45 --scheme " + scheme);
        const scene::EsriGrid out = scene::readEsriGrid(path("out.asc"));
        sand::HeightField rest = start;
        double moved = 0;  // [unit²]
        for (int y = 0; y < 24; ++y) {
            for (int x = 0; x < 24; ++x) {
                rest.setHeight(x, y, static_cast<std::int32_t>(std::lround(out.at(x, y) / kUnit)));
                const double change = static_cast<double>(rest.height(x, y)) - start.height(x, y);
                moved += change * change;
            }
        }
        const double bound = json["certificate"]["bound"], away = right.squaredDistanceTo(rest) / moved;
        EXPECT_LE(away, bound) << scheme;
        EXPECT_GT(away, 0) << scheme;
        EXPECT_NEAR(bound, certificateOf(scheme, start, rules).relative(), 1e-12) << scheme;
        EXPECT_NEAR(json["certificate"]["bound_rms"].get<double>(), std::sqrt(bound * moved / (24 * 24)) * kUnit,
                    1e-9 * std::sqrt(bound * moved))
            << scheme;
    }
}

TEST_F(Relax, ThreadsChangeNothing) {
    writeGrid("in.asc", 96, 96, heightsOf(samples::cylinder(96, 24, 20)));
    const auto alone = relax("in.asc out.asc --talus 30");
    const std::string heights = read("out.asc");
    for (const int threads : {2, 3, 7}) {
        const auto json = relax(fmt::format("in.asc out.asc --talus 30 --threads {}", threads));
        EXPECT_EQ(json["state_hash"], alone["state_hash"]) << threads;
        EXPECT_EQ(json["certificate"], alone["certificate"]) << threads;
        EXPECT_EQ(read("out.asc"), heights) << threads;
    }
}

TEST_F(Relax, StableSandComesBackCharacterForCharacter) {
    const std::string text =
        "ncols 4\nnrows 4\nxllcorner 361015.59563119\nyllcorner 70223.434086869\ncellsize 10\nNODATA_value 0\n"
        "0 0 0 0\n480.123456789 481.2 0 482.3\n479.00001 480 481 482\n478.9 479.9 0 481.9\n";
    write("in.asc", text);
    const auto json = relax("in.asc out.asc --talus 20");
    EXPECT_EQ(read("out.asc"), text);
    EXPECT_EQ(json["sweeps"], 1);
    EXPECT_TRUE(json["certificate"].is_null()) << "there are walls";
}

TEST_F(Relax, NoDataIsAWallAndComesBack) {
    // A wall of cells without data, with a gap in the north, divides a high bank in the west from low ground in the
    // east.
    std::string cells;
    for (int row = 0; row < 12; ++row) {
        for (int column = 0; column < 12; ++column) {
            cells += column == 6 && row > 0 ? "-9999 " : column < 6 ? "8.5 " : "1.25 ";
        }
        cells += '\n';
    }
    const std::string head = "ncols 12\nnrows 12\nxllcorner 5\nyllcorner 6\ncellsize 1\nNODATA_value -9999\n";
    write("in.asc", head + cells);
    const auto json = relax("in.asc out.asc --talus 35");
    EXPECT_EQ(json["volume_after"], json["volume_before"]);
    EXPECT_LE(json["steepest_over_talus"], 1.01);
    const scene::EsriGrid before = scene::readEsriGrid(path("in.asc"));
    const scene::EsriGrid after = scene::readEsriGrid(path("out.asc"));
    EXPECT_EQ(read("out.asc").substr(0, head.size()), head);
    for (std::size_t i = 0; i < before.heights.size(); ++i) {
        EXPECT_EQ(std::isnan(before.heights[i]), std::isnan(after.heights[i])) << i;
    }
    EXPECT_GT(after.at(7, 11), 2) << "sand came through the gap";
    EXPECT_EQ(after.at(7, 0), 1.25) << "and not through the wall";
    EXPECT_EQ(after.at(5, 0), 8.5);
}

TEST_F(Relax, EmptyEdgesAreNoWallsForSettle) {
    const std::string head = "ncols 5\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -1\n";
    write("edge.asc", head + "5 0 0 0 -1\n5 0 0 0 -1\n-1 -1 -1 -1 -1\n");
    EXPECT_EQ(relax("edge.asc out.asc --talus 30 --scheme settle")["scheme"], "settle");
    write("wall.asc", head + "5 0 0 0 -1\n5 0 0 0 -1\n-1 0 0 0 0\n");
    const auto json = relax("wall.asc out.asc --talus 30 --scheme settle");
    EXPECT_EQ(json["scheme"], "g");
    EXPECT_TRUE(json.contains("note"));
    EXPECT_EQ(json["at_rest"], true);
}

TEST_F(Relax, RestIsAFixedPoint) {
    constexpr unsigned kSeed = 47;
    std::mt19937 random(kSeed);
    const sand::HeightField start = samples::randomField(40, 30, 40 * sand::kUnitsPerCell, random);
    writeGrid("in.asc", 40, 30, heightsOf(start));
    // Such slopes on cells of 1 near the origin could be degrees that are taken for lengths.
    (void)relax("in.asc out.asc --talus 33 --lengths");
    const auto again = relax("out.asc out2.asc --talus 33");
    EXPECT_EQ(again["sweeps"], 1) << "seed " << kSeed;
    EXPECT_EQ(read("out2.asc"), read("out.asc")) << "seed " << kSeed;
}

TEST_F(Relax, AGridMayBeReplacedByItself) {
    writeGrid("a.asc", 32, 32, heightsOf(samples::cylinder(32, 8, 5)));
    (void)relax("a.asc b.asc --talus 40");
    (void)relax("a.asc a.asc --talus 40");
    EXPECT_EQ(read("a.asc"), read("b.asc"));
}

TEST_F(Relax, StopsAfterAsManySweepsAsItIsTold) {
    const sand::HeightField start = samples::cylinder(64, 16, 12);
    writeGrid("in.asc", 64, 64, heightsOf(start));
    const auto json = relax("in.asc out.asc --talus 45 --sweeps 7");
    EXPECT_EQ(json["sweeps"], 7);
    EXPECT_EQ(json["at_rest"], false);
    EXPECT_EQ(json["volume_after"], start.volume());
}

// A ramp at 0.9 of the talus along a bare cliff is stable, although the step down the cliff is as steep as possible.
TEST_F(Relax, StableSandBesideBareRockStays) {
    std::vector<double> surface, rock;
    for (int row = 0; row < 20; ++row) {
        for (int column = 0; column < 20; ++column) {
            const double ramp = 0.9 * (20 - row);
            const bool cliff = column >= 10;
            surface.push_back(cliff ? 60 : ramp);
            rock.push_back(cliff ? 60 : -5);
        }
    }
    writeGrid("in.asc", 20, 20, surface);
    writeGrid("rock.asc", 20, 20, rock);
    const auto json = relax("in.asc out.asc --talus 45 --bedrock rock.asc");
    EXPECT_EQ(read("out.asc"), read("in.asc"));
    EXPECT_EQ(json["volume_above"], "bedrock");
    EXPECT_LT(json["steepest_over_talus"], 1.0) << "bare rock does not count as sand";
    EXPECT_GT(json["steepest_over_talus"], 0.8);
}

TEST_F(Relax, ALayerNeverBecomesThinnerThanNothing) {
    constexpr unsigned kSeed = 53;
    std::mt19937 random(kSeed);
    std::vector<double> surface, rock;
    for (int i = 0; i < 30 * 30; ++i) {
        rock.push_back(static_cast<double>(random() % 1000) / 100);
        surface.push_back(rock.back() + static_cast<double>(random() % 100) / 100);
    }
    writeGrid("in.asc", 30, 30, surface);
    writeGrid("rock.asc", 30, 30, rock);
    const auto json = relax("in.asc out.asc --talus 30 --bedrock rock.asc");
    EXPECT_EQ(json["volume_after"], json["volume_before"]);
    EXPECT_GT(json["volume_before"], 0);
    const scene::EsriGrid out = scene::readEsriGrid(path("out.asc"));
    for (std::size_t i = 0; i < rock.size(); ++i) {
        ASSERT_GE(out.heights[i], rock[i] - kUnit / 2) << i << ", seed " << kSeed;
    }
}

TEST_F(Relax, CellsThatAreNotSquareRestAtTheSameAngle) {
    std::string east = "ncols 40\nnrows 1\nxllcorner 0\nyllcorner 0\ndx 1\ndy 4\n";
    std::string north = "ncols 1\nnrows 40\nxllcorner 0\nyllcorner 0\ndx 4\ndy 1\n";
    for (int i = 0; i < 40; ++i) {
        east += i < 10 ? "8 " : "0 ";
        north += i < 10 ? "8\n" : "0\n";
    }
    write("east.asc", east);
    write("north.asc", north);
    EXPECT_EQ(relax("east.asc east_out.asc --talus 40")["unit"], kUnit);
    EXPECT_EQ(relax("north.asc north_out.asc --talus 40")["unit"], kUnit) << "the shorter side tells";
    const scene::EsriGrid alongX = scene::readEsriGrid(path("east_out.asc"));
    const scene::EsriGrid alongY = scene::readEsriGrid(path("north_out.asc"));
    EXPECT_EQ(alongY.aspect(), 0.25);
    const double step = std::tan(40 * 3.14159265358979 / 180);
    double steepestX = 0;
    double steepestY = 0;
    for (std::size_t i = 1; i < 40; ++i) {
        steepestX = std::max(steepestX, alongX.heights[i - 1] - alongX.heights[i]);
        steepestY = std::max(steepestY, alongY.heights[i - 1] - alongY.heights[i]);
    }
    // The slope runs across the faces: 1 / 0.45 units (docs/relax.md), and half a unit for each of two heights.
    EXPECT_NEAR(steepestX, step, 3.3 * kUnit);
    EXPECT_NEAR(steepestY, step, 3.3 * kUnit);
}

/// Returns the bound of docs/relax.md for a face across cells `ratio` times as long as along it, as a share of the
/// talus.
double statedExcess(double talusUnits, double ratio, const std::string& scheme) {
    const double k = scheme == "g_plain" ? 0.4998 / (1 + ratio * ratio) : 0.45 / std::max(1.0, ratio * ratio);
    return (std::cbrt(talusUnits / (2 * k * k)) + 1 / k) / talusUnits;
}

/// Returns cones and cylinders of sand at random places, on cells of dx by dy.
std::string hills(double dx, double dy, std::uint32_t seed) {
    constexpr int kSide = 40;
    std::mt19937 random(seed);
    const auto within = [&](double least, double most) {
        return least + (most - least) * static_cast<double>(random() % 1000) / 1000;
    };
    std::vector<double> heights(kSide * kSide);
    for (int hill = 0; hill < 10; ++hill) {
        const double x = within(0, kSide), y = within(0, kSide), radius = within(2, 10), height = within(2, 40);
        for (int i = 0; i < kSide * kSide; ++i) {
            const int column = i % kSide, row = i / kSide;
            const double distance = std::hypot((column - x) * dx, (row - y) * dy) / std::max(dx, dy);
            const double share = hill % 2 == 0 ? 1 : 1 - distance / radius;
            heights[static_cast<std::size_t>(i)] += distance < radius ? height * share : 0;
        }
    }
    std::string text = fmt::format("ncols {0}\nnrows {0}\nxllcorner 0\nyllcorner 0\ndx {1}\ndy {2}\n", kSide, dx, dy);
    for (const double height : heights) {
        text += fmt::format("{:.4f}\n", height);
    }
    return text;
}

TEST_F(Relax, NoFaceRestsSteeperThanTheStatedBound) {
    for (const auto& [dx, dy] : {std::pair{1.0, 1.0}, {1.0, 2.0}, {4.0, 1.0}, {1.0, 20.0}}) {
        for (const std::uint32_t seed : {1U, 2U}) {
            write("hills.asc", hills(dx, dy, seed));
            for (const std::string scheme : {"g", "g_plain", "settle"}) {
                for (const int talus : {10, 30}) {
                    const nlohmann::json json =
                        relax(fmt::format("hills.asc out.asc --talus {} --scheme {}", talus, scheme));
                    const double units = std::tan(talus * 3.14159265358979 / 180) / json["unit"].get<double>();
                    const double bound =
                        std::max(statedExcess(units * dx, dx / dy, scheme), statedExcess(units * dy, dy / dx, scheme));
                    EXPECT_LE(json["steepest_over_talus"].get<double>(), 1 + bound)
                        << scheme << ", " << talus << " degrees, cells of " << dx << " by " << dy << ", seed " << seed;
                }
            }
        }
    }
}

TEST_F(Relax, TheSmallestGridsWork) {
    for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 7}, {7, 1}, {2, 2}}) {
        std::vector<double> heights(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0);
        heights[0] = 3;
        writeGrid("in.asc", columns, rows, heights);
        for (const char* scheme : {"g", "g_plain", "settle"}) {
            const auto json = relax(fmt::format("in.asc out.asc --talus 30 --scheme {}", scheme));
            const int highest = columns * rows == 1 ? 0 : 3;  // above the lowest cell
            EXPECT_EQ(json["volume_after"], highest * sand::kUnitsPerCell) << columns << " x " << rows << ' ' << scheme;
            EXPECT_EQ(json["at_rest"], true);
        }
    }
}

TEST_F(Relax, SaysItsResultInOneSentence) {
    const auto expect = [&](const std::string& arguments, const std::string& words) {
        const support::Ran ran = run(arguments);
        EXPECT_NE(ran.output.find("sandwall-relax: " + words), std::string::npos) << ran.output;
    };
    writeGrid("in.asc", 3, 1, {0, 0.1, 0.2});
    expect("in.asc out.asc --talus 30",
           "no sand moved: no slope of in.asc is steep enough to slide at a talus of 30 degrees; out.asc has the same "
           "heights\n");
    writeGrid("in.asc", 3, 1, {0, 4, 0});
    expect("in.asc out.asc --talus 45",
           "the sand of out.asc rests after 3 sweeps; its steepest slope is 40.0 degrees\n");
    expect("in.asc out.asc --talus 1 --sweeps 2", "the sand of out.asc still moves after 2 sweeps; ");
    write("in.csv", "0 0 0\n9 0 0\n0 9 0\n9 9 1\n");
    expect("in.csv out.ply --talus 30", "no sand moved: no slope of in.csv is steep enough to slide");
    expect("in.csv out.ply --talus 1", "the sand of out.ply rests after ");
}

TEST_F(Relax, AngleZeroLevelsTheSand) {
    writeGrid("in.asc", 8, 1, {4, 0, 0, 0, 0, 0, 0, 0});
    const auto json = relax("in.asc out.asc --talus 0");
    EXPECT_TRUE(json["steepest_over_talus"].is_null());
    const scene::EsriGrid out = scene::readEsriGrid(path("out.asc"));
    for (int x = 1; x < 8; ++x) {
        EXPECT_LE(std::abs(out.at(x, 0) - out.at(x - 1, 0)), 5 * kUnit) << "a talus of 0 rests within 4 units per cell";
    }
}

}  // namespace
