// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/refine/start_maker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "sand/tin/geometry/lattice.hpp"
#include "sand/tin/refine/simplify.hpp"

namespace sand::tin {
namespace {

constexpr int kCorners = 4;
constexpr std::size_t kPlacesPerReport = 4096;               // [place]
constexpr std::int32_t kUsualWidest = 16 * kLatticePerCell;  // distance of points on the rim if settings give none
constexpr double kAnyError = 4.0 * kMaxHeight;               // more than any difference of two heights [unit]

std::int32_t nearestHeight(double height) {
    return static_cast<std::int32_t>(
        std::clamp(std::floor(height + 0.5), -static_cast<double>(kMaxHeight), static_cast<double>(kMaxHeight)));
}

/// Receives the part of the work that is done, 0 to 1. It may be empty.
using Done = std::function<void(double share)>;

// Parts of the time of follow() and join(). The rest is the triangulation from which the mean height follows.
constexpr double kBorder = 0.1, kChosen = 0.9;  // the border, and then the choice of vertices
constexpr double kNumbered = 0.4;               // one number for each place

Done partOf(const Done& whole, double from, double to) {
    return [&whole, from, to](double share) {
        if (whole) {
            whole(from + (to - from) * share);
        }
    };
}

VertexSand layerOf(const TinStart& start, const Done& done) {
    Mesh mesh(start.width, start.depth, start.holes);
    mesh.insert(start.places, done);  // the corners exist already, as the first four vertices
    for (const auto& [a, b] : start.constraints) {
        mesh.constrain(a, b);
    }
    if (!mesh.hasOutline()) {  // possible if the start was received
        throw base::FormatError("a TIN with holes that have no outline");
    }
    VertexSand layer(std::move(mesh));
    for (std::size_t i = 0; i < start.heights.size(); ++i) {
        layer.setHeight(static_cast<Vertex>(i), start.heights[i]);
    }
    return layer;
}

std::int32_t meanHeight(const TinStart& start, const Done& done) {
    const VertexSand layer = layerOf(start, done);
    return nearestHeight(static_cast<double>(layer.volume()) / static_cast<double>(layer.ground()));
}

std::size_t nearest(const std::vector<LatticePoint>& places, const LatticePoint& to) {
    const auto squared = [&](const LatticePoint& place) {
        const std::int64_t x = std::int64_t{place.x} - to.x, y = std::int64_t{place.y} - to.y;
        return x * x + y * y;
    };
    const auto found =
        std::min_element(places.begin(), places.end(),
                         [&](const LatticePoint& a, const LatticePoint& b) { return squared(a) < squared(b); });
    return static_cast<std::size_t>(found - places.begin());
}

/// Adds the cell centres at distance settings.widest that lie on ground. Without them, level ground is two triangles.
/// Slivers would then connect the bank of a furrow with the field's far corners. Sand slides badly over slivers, and
/// light shows them as rays.
void addLattice(const HeightField& field, const Holes* holes, const Settings& settings, Border& given) {
    const std::int32_t every = Lattice(settings.widest).every;
    if (every == 0) {
        return;
    }
    for (int row = every / 2; row < field.rows(); row += every) {
        for (int column = every / 2; column < field.columns(); column += every) {
            if (holes == nullptr || !holes->isHole(column, row)) {
                given.places.push_back(
                    {column * kLatticePerCell + kLatticePerCell / 2, row * kLatticePerCell + kLatticePerCell / 2});
                given.heights.push_back(field.height(column, row));
            }
        }
    }
}

/// Returns the next spacing to try on a closed rim, if there is no room for vertices at `spacing`. 0 leaves only the
/// vertices that the heights require.
std::int32_t widerSpacing(std::int32_t spacing, std::int32_t width, std::int32_t depth) {
    return spacing < std::max(width, depth) ? 2 * spacing : 0;
}

/// Returns a border with error `maxError`, or with a larger one if it would otherwise exceed `most` vertices. Outlines
/// and a closed rim get fewer vertices first. Throws std::length_error if every border exceeds them.
Border borderWithin(std::size_t most, std::span<const double> heights, const Cells& cells, const Holes* holes,
                    LongestEdges longest, Rim rim, double maxError) {
    const auto within = [&](double error) { return borderOf(heights, cells, holes, error, longest); };
    Border border = within(maxError);
    while (border.places.size() > most && longest.onOutline < usualOnOutline(cells)) {
        longest.onOutline = std::min(2 * longest.onOutline, usualOnOutline(cells));
        border = within(maxError);
    }
    if (border.places.size() <= most) {
        return border;
    }
    Border least = within(kAnyError);
    while (rim == Rim::closed && longest.onRim > 0 && least.places.size() > most) {
        longest.onRim = widerSpacing(longest.onRim, cells.width, cells.depth);
        least = within(kAnyError);
    }
    border = within(maxError);
    if (least.places.size() > most) {
        const std::string what = holes == nullptr ? "the open rim" : "the outline of cells without data";
        throw std::length_error(what + (holes != nullptr && longest.onRim > 0 ? " and the open rim take " : " takes ") +
                                std::to_string(least.places.size()) + " vertices, and there is room for " +
                                std::to_string(most) + " beside corners and points at 'widest'; raise 'vertices'");
    }
    for (double error = std::max(2 * maxError, 1.0); border.places.size() > most; error *= 2) {
        border = within(error);
    }
    return border;
}

/// Returns whether all heights are equal. Level ground needs no raster for greedy insertion, which takes twice the
/// memory of the field.
bool isLevel(const HeightField& field) {
    for (int row = 0; row < field.rows(); ++row) {
        const std::int32_t* cells = field.row(row);
        if (std::any_of(cells, cells + field.columns(),
                        [&](std::int32_t cell) { return cell != field.height(0, 0); })) {
            return false;
        }
    }
    return true;
}

/// Returns the longest edge allowed on the rim [probe unit]. Sand falls over an open rim only at vertices. On a closed
/// rim, sand piles up as in a mirror only if there are vertices.
std::int32_t rimSpacing(const Settings& settings) {
    return settings.widest > 0 ? std::max(settings.widest, kLatticePerCell) : kUsualWidest;
}

/// Chooses the vertices that rim, holes, heights and settings.widest require, and adds them to `start`. Returns the
/// largest remaining error [unit].
double addChosen(const HeightField& field, const Ground* walls, Rim rim, TinStart& start, const Done& done) {
    std::vector<double> heights;
    heights.reserve(static_cast<std::size_t>(field.columns()) * static_cast<std::size_t>(field.rows()));
    for (int row = 0; row < field.rows(); ++row) {
        for (int column = 0; column < field.columns(); ++column) {
            const bool wall = walls != nullptr && walls->isWall(column, row);
            heights.push_back(wall ? std::numeric_limits<double>::quiet_NaN() : field.height(column, row));
        }
    }
    Raster raster;
    raster.heights = heights;
    raster.columns = field.columns();
    raster.rows = field.rows();
    raster.first = {kLatticePerCell / 2, kLatticePerCell / 2};  // the cell centres
    const Cells cells = nominalCells(start.width, start.depth);
    start.holes = holesOf(heights, cells);
    const Settings& settings = start.settings;
    const std::int64_t room = settings.mostVertices - Lattice(settings.widest).size(field.columns(), field.rows());
    const std::int32_t onRim = rimSpacing(settings);
    Border given =
        borderWithin(static_cast<std::size_t>(std::max<std::int64_t>(room - kCorners, 0)), heights, cells,
                     start.holes.get(), {std::min(onRim, usualOnOutline(cells)), onRim}, rim, settings.maxError);
    // Round as the start does, because the errors must be those of its surface.
    for (double& height : given.heights) {
        height = nearestHeight(height);
    }
    // Add them before anything is chosen, because each point changes the triangles around it and their errors.
    addLattice(field, start.holes.get(), settings, given);
    const Done choose = partOf(done, kBorder, kChosen);
    choose(0);
    const Simplified chosen =
        simplify(start.width, start.depth, raster,
                 {static_cast<double>(settings.maxError), settings.mostVertices, false}, given, choose);
    start.constraints = given.edges;
    start.places = chosen.places;
    for (const double height : chosen.heights) {
        start.heights.push_back(nearestHeight(height));
    }
    return chosen.maxError;
}

/// Places of a start with their heights [unit].
struct MorePoints {
    std::vector<LatticePoint> places;
    std::vector<std::int32_t> heights;
};

/// Returns vertices on the sides of the field that leave no edge along them longer than `longest` [probe unit]. Each
/// has the height of the edge there.
MorePoints rimDivision(std::int32_t longest, const TinStart& start) {
    MorePoints more;
    const std::array<std::function<bool(const LatticePoint&)>, 4> sides{
        [](const LatticePoint& place) { return place.y == 0; },
        [&](const LatticePoint& place) { return place.x == start.width; },
        [&](const LatticePoint& place) { return place.y == start.depth; },
        [](const LatticePoint& place) { return place.x == 0; }};
    for (const auto& isOnSide : sides) {
        std::map<LatticePoint, std::int32_t> along;  // heights by place
        for (std::size_t i = 0; i < start.places.size(); ++i) {
            if (isOnSide(start.places[i])) {
                along.emplace(start.places[i], start.heights[i]);
            }
        }
        for (auto from = along.begin(), to = std::next(from); to != along.end(); from = to++) {
            const std::int32_t x = to->first.x - from->first.x, y = to->first.y - from->first.y;  // one of them is 0
            const std::int32_t parts = (x + y + longest - 1) / longest;
            for (std::int32_t part = 1; part < parts; ++part) {
                const double share = static_cast<double>(part) / parts;
                const auto way = [share](std::int32_t whole) { return static_cast<std::int32_t>(share * whole); };
                more.places.push_back({from->first.x + way(x), from->first.y + way(y)});
                more.heights.push_back(nearestHeight(from->second + static_cast<double>(way(x + y)) / (x + y) *
                                                                        (to->second - from->second)));
            }
        }
    }
    return more;
}

/// Adds vertices on the rim. A closed rim gets at most as many as settings.mostVertices leaves room for. A start that
/// exceeds this number already has no such limit.
void divideRim(Rim rim, TinStart& start) {
    const auto most = static_cast<std::size_t>(start.settings.mostVertices);
    const std::size_t there = start.places.size();
    std::int32_t longest = rimSpacing(start.settings);
    MorePoints more = rimDivision(longest, start);
    while (rim == Rim::closed && there <= most && there + more.places.size() > most) {
        longest = widerSpacing(longest, start.width, start.depth);
        more = longest > 0 ? rimDivision(longest, start) : MorePoints{};
    }
    start.places.insert(start.places.end(), more.places.begin(), more.places.end());
    start.heights.insert(start.heights.end(), more.heights.begin(), more.heights.end());
}

}  // namespace

VertexSand layerOf(const TinStart& start) { return layerOf(start, {}); }

Followed follow(const HeightField& field, const Ground* walls, const Settings& settings, Rim rim, const Done& done) {
    Followed followed;
    TinStart& start = followed.start;
    start.width = field.columns() * kLatticePerCell;
    start.depth = field.rows() * kLatticePerCell;
    start.settings = settings;
    if (walls == nullptr && rim == Rim::closed && isLevel(field)) {
        Border given{{{0, 0}, {start.width, 0}, {start.width, start.depth}, {0, start.depth}}, {}, {}};
        addLattice(field, nullptr, settings, given);
        start.places = std::move(given.places);
        start.heights.assign(start.places.size(), field.height(0, 0));
        divideRim(rim, start);
    } else {
        followed.maxError = addChosen(field, walls, rim, start, done);
    }
    start.meanHeight = meanHeight(start, partOf(done, kChosen, 1));
    return followed;
}

TinStart join(const TinStart& given, Rim rim, const Done& done) {
    TinStart start;
    start.width = given.width;
    start.depth = given.depth;
    start.settings = given.settings;
    for (const LatticePoint& corner :
         std::array{LatticePoint{0, 0}, LatticePoint{given.width, 0}, LatticePoint{given.width, given.depth},
                    LatticePoint{0, given.depth}}) {
        start.places.push_back(corner);
        start.heights.push_back(given.heights[nearest(given.places, corner)]);
    }
    std::map<LatticePoint, Vertex> numbers;
    for (Vertex corner = 0; corner < 4; ++corner) {
        numbers.emplace(start.places[static_cast<std::size_t>(corner)], corner);
    }
    std::vector<Vertex> numberOf;
    for (std::size_t i = 0; i < given.places.size(); ++i) {
        const auto [found, fresh] = numbers.emplace(given.places[i], static_cast<Vertex>(start.places.size()));
        if (fresh) {
            start.places.push_back(given.places[i]);
            start.heights.push_back(given.heights[i]);
        }
        numberOf.push_back(found->second);
        if (done && i % kPlacesPerReport == 0) {
            done(kNumbered * static_cast<double>(i) / static_cast<double>(given.places.size()));
        }
    }
    for (const auto& [a, b] : given.constraints) {
        const auto ends = std::minmax(numberOf[static_cast<std::size_t>(a)], numberOf[static_cast<std::size_t>(b)]);
        if (ends.first != ends.second) {
            start.constraints.emplace_back(ends);
        }
    }
    divideRim(rim, start);
    start.meanHeight = meanHeight(start, partOf(done, kNumbered, 1));
    return start;
}

TinStart startOf(const VertexSand& layer, const Settings& settings) {
    const Triangles& mesh = layer.triangles();
    TinStart start;
    start.width = mesh.width;
    start.depth = mesh.depth;
    start.settings = settings;
    start.holes = layer.mesh().holes();
    std::vector<Vertex> numberOf(mesh.triangleAt.size(), kNoNumber);
    for (std::size_t i = 0; i < mesh.triangleAt.size(); ++i) {
        if (mesh.alive(static_cast<Vertex>(i))) {
            numberOf[i] = static_cast<Vertex>(start.places.size());
            start.places.push_back(mesh.places[i]);
            start.heights.push_back(nearestHeight(layer.heights()[i]));
        }
    }
    for (const auto& [a, b] : layer.mesh().constraints()) {
        start.constraints.emplace_back(
            std::minmax(numberOf[static_cast<std::size_t>(a)], numberOf[static_cast<std::size_t>(b)]));
    }
    start.meanHeight = meanHeight(start, {});
    return start;
}

}  // namespace sand::tin
