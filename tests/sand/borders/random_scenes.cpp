// SPDX-License-Identifier: Apache-2.0
#include "tests/sand/borders/random_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <random>
#include <string>
#include <vector>

#include "tests/support/borders/border_scenes.hpp"

namespace borders {
namespace {

/// A random number.
class Random {
public:
    explicit Random(std::uint32_t seed) : random_(seed) {}
    int below(int most) { return static_cast<int>(random_() % static_cast<std::uint32_t>(most)); }
    double within(double low, double high) { return low + (high - low) * below(4096) / 4096; }

private:
    std::mt19937 random_;
};

/// Returns a small scene with random walls, a random rim and a random tool.
Case randomCase(Random& random) {
    Case given;
    given.columns = 12 + random.below(28);
    given.rows = 12 + random.below(28);
    given.tin = random.below(2) == 0;
    given.widest = 1 + random.below(5);
    given.rim = random.below(3) == 0 ? sand::Rim::open : sand::Rim::closed;
    given.talus = random.within(0.1, 1.5);
    given.start = random.below(2) == 0 ? 0 : given.talus * random.within(1, 2);
    given.sweeps = 1 + random.below(16);
    given.tool = static_cast<sand::ToolKind>(random.below(sand::kToolKinds));
    given.radius = random.within(0.3, 6);
    struct Line {
        int x0, y0, x1, y1;
    };
    std::vector<Line> lines(static_cast<std::size_t>(1 + random.below(5)));
    for (Line& line : lines) {  // walls one cell thick, boxes, and the outlines of pockets
        line.x0 = random.below(given.columns);
        line.y0 = random.below(given.rows);
        line.x1 = random.below(2) == 0 ? line.x0 : line.x0 + random.below(given.columns);
        line.y1 = line.x1 == line.x0 ? line.y0 + random.below(given.rows) : line.y0 + random.below(4);
    }
    const int speckle = random.below(3) == 0 ? random.below(30) : 0;  // [%] of single cells
    std::vector<std::uint8_t> walls(static_cast<std::size_t>(given.columns) * static_cast<std::size_t>(given.rows));
    for (std::size_t i = 0; i < walls.size(); ++i) {
        const int x = static_cast<int>(i) % given.columns, y = static_cast<int>(i) / given.columns;
        const bool inLine = std::any_of(lines.begin(), lines.end(), [&](const Line& line) {
            return x >= line.x0 && x <= line.x1 && y >= line.y0 && y <= line.y1;
        });
        walls[i] = inLine || random.below(100) < speckle ? 1 : 0;
    }
    walls[static_cast<std::size_t>(random.below(static_cast<int>(walls.size())))] = 0;  // some ground is left
    given.wall = [walls, columns = given.columns](int x, int y) {
        return walls[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)] !=
               0;
    };
    const double bump = random.within(0, 6);
    given.height = [bump](double x, double y) { return 8 + bump * std::sin(x) * std::cos(1.3 * y); };
    return given;
}

/// Plays a random session. Returns why it is wrong, or an empty text.
std::string playRandom(std::uint32_t seed) {
    Random random(seed);
    const Case given = randomCase(random);
    sand::Replica sand(sceneOf(given));
    const auto before = volumesByPart(sand);
    const bool open = given.rim == sand::Rim::open;
    Hand hand(sand);
    for (int i = 0; i < 30; ++i) {
        const double x = random.within(-3, given.columns + 3), y = random.within(-3, given.rows + 3);
        const sand::Edit::Kind edit = random.below(12) == 0   ? sand::Edit::settle
                                      : random.below(15) == 0 ? sand::Edit::undo
                                                              : sand::Edit::none;
        if (random.below(4) == 0) {
            hand.hover(edit);
        } else if (random.below(4) == 0) {
            hand.hold(edit);
        } else {
            const double far = random.within(0, 9);
            hand.apply(true, {probeAt(x, y, random.within(4, 16)), probeAt(x + far, y - far / 2, random.within(2, 16))},
                       edit);
        }
        // Over an open rim, sand of every part may leave. All parts together then keep their sum with the outflow.
        const auto now = volumesByPart(sand);
        std::int64_t sum = sand.outflow();
        for (const auto& [place, volume] : before) {
            const auto found = now.find(place);
            const std::int64_t here = found == now.end() ? 0 : found->second;
            if (!open && here != volume) {
                return fmt::format("step {}: the part at {}, {} had {} and has {}", i, place.first, place.second,
                                   volume, here);
            }
            if (open && here > volume) {
                return fmt::format("step {}: the part at {}, {} has won {}", i, place.first, place.second,
                                   here - volume);
            }
            sum += here - volume;
        }
        if (sum != 0 || now.size() != before.size()) {
            return fmt::format("step {}: the volume has changed by {}", i, sum);
        }
    }
    sand::Replica other(sceneOf(given));
    other.decodeState(sand.encodeState());
    return other.stateHash() == sand.stateHash() ? "" : "a replica that loads the state has another hash";
}

}  // namespace

bool playRandomScenes(int scenes, std::uint32_t seed) {
    int wrong = 0;
    for (int i = 0; i < scenes; ++i) {
        std::string why;
        try {
            why = playRandom(seed + static_cast<std::uint32_t>(i));
        } catch (const std::exception& error) {
            why = error.what();
        }
        if (!why.empty()) {
            fmt::print("scene {}: {}\n", seed + static_cast<std::uint32_t>(i), why);
            std::fflush(stdout);
            ++wrong;
        }
    }
    fmt::print("{} of {} scenes are wrong\n", wrong, scenes);
    return wrong == 0;
}

}  // namespace borders
