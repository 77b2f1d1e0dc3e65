// SPDX-License-Identifier: Apache-2.0
// The cells around a tool take the sand that it displaces: their places and their shares.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "sand/grid/displacement.hpp"
#include "tests/support/borders/tool_kinds.hpp"

namespace receivers {
namespace {

using sand::Heading;
using sand::HeightField;
using sand::kProbePerCell;
using sand::Offset;
using sand::ProbePoint;
using sand::ToolKind;
using enum sand::ToolKind;

constexpr int kSide = 110;  // [cell]

std::int32_t probes(double cells) { return static_cast<std::int32_t>(std::floor(cells * kProbePerCell + 0.5)); }

sand::Tool toolOf(ToolKind kind, double radius /* [cell] */, const Heading& heading = {}) {
    return {kind, probes(radius), sand::isRound(kind) ? 0 : probes(radius * sand::usualWidth(kind)), heading};
}

/// Tool on level sand of height 0.
struct PlacedTool {
    sand::Tool tool;
    ProbePoint probe{probes(54.3), probes(55.6), 0};

    [[nodiscard]] Offset offsetOf(int column, int row) const {
        return {std::int64_t{column} * kProbePerCell + kProbePerCell / 2 - probe.x,
                std::int64_t{row} * kProbePerCell + kProbePerCell / 2 - probe.y};
    }
    /// Returns a place in the tool's own axes, along the heading and to the left of it [probe unit / Heading::kLength].
    [[nodiscard]] std::pair<std::int64_t, std::int64_t> placeOf(int column, int row) const {
        const auto [x, y] = offsetOf(column, row);
        const std::int64_t across = y * tool.heading.x - x * tool.heading.y;
        return {x * tool.heading.x + y * tool.heading.y, tool.heading.mirrored ? -across : across};
    }
    /// Returns how many pieces of the sole lie within `margin` [probe unit] of the cell's middle. Each piece is an
    /// ellipse. A tool without pieces is one.
    [[nodiscard]] int piecesWithin(long double margin, int column, int row) const {
        const long double length =
            std::hypot(static_cast<long double>(tool.heading.x), static_cast<long double>(tool.heading.y));
        const auto whole = placeOf(column, row);
        const long double along = static_cast<long double>(whole.first) / length;
        const long double across = static_cast<long double>(whole.second) / length;
        const sand::SolePiece all{0, 0, 1, 1, 0, 0};
        const auto sole = sand::solePieces(tool.kind);
        const auto pieces = sole.empty() ? std::span(&all, 1) : sole;
        return static_cast<int>(std::count_if(pieces.begin(), pieces.end(), [&](const sand::SolePiece& piece) {
            const long double x = (along - static_cast<long double>(piece.along) * tool.radius) /
                                  (static_cast<long double>(piece.halfLength) * tool.radius + margin);
            const long double y = (across - static_cast<long double>(piece.across) * tool.halfWidth) /
                                  (static_cast<long double>(piece.halfWidth) * tool.halfWidth + margin);
            return x * x + y * y <= 1;
        }));
    }
    /// Returns the width of the ring around the tool that takes sand [probe unit]. It is two cells, and larger by an
    /// eighth of the tool's width. A sphere up to 16 cells has no more than two cells, and a larger one no more than
    /// its radius above 16 cells.
    [[nodiscard]] std::int64_t ring() const {
        const std::int64_t half = sand::isRound(tool.kind) ? tool.radius : tool.halfWidth;
        const std::int64_t most = tool.kind == sphere ? std::max(0, tool.radius - 16 * kProbePerCell) : half;
        return 2 * kProbePerCell + std::min(half / 4, most);
    }
    [[nodiscard]] bool takes(int column, int row) const {
        const Offset offset = offsetOf(column, row);
        if (sand::isRound(tool.kind)) {
            const std::int64_t inner = tool.radius, outer = inner + ring();
            const std::int64_t square = offset.x * offset.x + offset.y * offset.y;
            return square >= inner * inner && square <= outer * outer;
        }
        const auto width = static_cast<long double>(ring());
        if (tool.kind == rectangle) {
            const long double length =
                std::hypot(static_cast<long double>(tool.heading.x), static_cast<long double>(tool.heading.y));
            const auto whole = placeOf(column, row);
            const long double along = std::abs(static_cast<long double>(whole.first) / length);
            const long double across = std::abs(static_cast<long double>(whole.second) / length);
            return (along >= tool.radius || across >= tool.halfWidth) && along <= tool.radius + width &&
                   across <= tool.halfWidth + width;
        }
        return piecesWithin(0, column, row) == 0 && piecesWithin(width, column, row) > 0 && !isBetweenToes(column, row);
    }
    [[nodiscard]] bool isBetweenToes(int column, int row) const {
        return piecesWithin(0, column, row) == 0 && piecesWithin(static_cast<long double>(ring()) / 2, column, row) > 1;
    }
    /// Returns level sand after the tool was dragged to its place from there minus `way`.
    [[nodiscard]] HeightField dragged(const ProbePoint& way) const {
        HeightField field(kSide, kSide, 1.0);
        const ProbePoint from{probe.x - way.x, probe.y - way.y, probe.z};
        sand::grid::Displacement(tool).drag(field, sand::Rim::closed, nullptr, from, probe);
        return field;
    }
    [[nodiscard]] HeightField pressed() const { return dragged({0, 0, 0}); }
};

struct Cell {
    int column, row;
};

/// Returns the cells for which `counts` is true, row by row from the south.
template <class Counts>
std::vector<Cell> cellsWhere(const Counts& counts) {
    std::vector<Cell> cells;
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            if (counts(column, row)) {
                cells.push_back({column, row});
            }
        }
    }
    return cells;
}

/// Returns the sand that the tool has taken out of level sand [unit · cell].
std::int64_t takenFrom(const HeightField& field) {
    std::int64_t taken = 0;
    for (const Cell& cell : cellsWhere([&](int column, int row) { return field.height(column, row) < 0; })) {
        taken -= field.height(cell.column, cell.row);
    }
    return taken;
}

std::vector<PlacedTool> tools(const std::vector<ToolKind>& kinds) {
    std::vector<PlacedTool> all;
    for (const ToolKind kind : kinds) {
        for (const Heading& heading :
             {*sand::headingOf(0), *sand::headingOf(30), *sand::headingOf(217.3, true), *sand::headingOf(-101)}) {
            all.push_back({.tool = toolOf(kind, 24.1, heading)});
        }
    }
    return all;
}

std::string nameOf(const PlacedTool& placed) {
    return std::string(base::nameOf(placed.tool.kind)) + " towards " +
           std::to_string(sand::degreesOf(placed.tool.heading)) + (placed.tool.heading.mirrored ? ", mirrored" : "");
}

void expectTakers(const PlacedTool& placed) {
    const HeightField field = placed.pressed();
    for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
            ASSERT_EQ(field.height(column, row) > 0, placed.takes(column, row))
                << nameOf(placed) << " at " << column << ", " << row;
        }
    }
}

TEST(Receivers, OfARoundToolAreTheCellsOfItsRing) {
    for (const ToolKind kind : {sphere, circle}) {
        for (const double radius : {0.7, 3.0, 11.3, 24.1}) {
            expectTakers({.tool = toolOf(kind, radius)});
        }
    }
}

TEST(Receivers, OfALongToolAreTheCellsAroundItsOutline) {
    for (const PlacedTool& placed : tools(support::longTools())) {
        expectTakers(placed);
    }
}

TEST(Receivers, BetweenTheToesNoCellTakesSand) {
    for (const PlacedTool& placed : tools({footprint})) {
        const HeightField field = placed.pressed();
        const std::vector<Cell> between =
            cellsWhere([&](int column, int row) { return placed.isBetweenToes(column, row); });
        ASSERT_GT(between.size(), 20U) << "the test proves nothing without such cells";
        for (const Cell& cell : between) {
            EXPECT_EQ(field.height(cell.column, cell.row), 0)
                << nameOf(placed) << " at " << cell.column << ", " << cell.row;
        }
    }
}

/// Expects that the tool's sand was shared evenly among `order`, and that the first cells have got the remainder.
/// Lowers the tool until there is a remainder.
void expectEvenShares(PlacedTool placed, const std::vector<Cell>& order) {
    const auto count = static_cast<std::int64_t>(order.size());
    HeightField field = placed.pressed();
    for (int tries = 0; takenFrom(field) % count < 2 && tries < 20; ++tries) {
        --placed.probe.z;
        field = placed.pressed();
    }
    const std::int64_t taken = takenFrom(field);
    ASSERT_GT(taken % count, 1) << nameOf(placed) << ": without a remainder the test proves nothing";
    for (std::int64_t i = 0; i < count; ++i) {
        const Cell& cell = order[static_cast<std::size_t>(i)];
        ASSERT_EQ(field.height(cell.column, cell.row), taken / count + (i < taken % count ? 1 : 0))
            << nameOf(placed) << ", cell " << i << " of " << count;
    }
}

TEST(Receivers, TheRemainderOfARoundToolsSandGoesToTheFirstByRows) {
    for (const ToolKind kind : {sphere, circle}) {
        const PlacedTool placed{.tool = toolOf(kind, 24.1)};
        expectEvenShares(placed, cellsWhere([&](int column, int row) { return placed.takes(column, row); }));
    }
}

// The order turns and is mirrored with the tool: from back to front, and from right to left.
TEST(Receivers, TheRemainderOfALongToolsSandGoesToTheHindmost) {
    for (const PlacedTool& placed : tools(support::longTools())) {
        std::vector<Cell> order = cellsWhere([&](int column, int row) { return placed.takes(column, row); });
        std::sort(order.begin(), order.end(), [&](const Cell& a, const Cell& b) {
            return placed.placeOf(a.column, a.row) < placed.placeOf(b.column, b.row);
        });
        expectEvenShares(placed, order);
    }
}

/// Returns the mean cosine, over the cells that take sand, between two directions: that of the drag in which the cell
/// takes most, and that from the nearest place below the tool. Cells within a cell of such a place are left out,
/// because the lattice of the places below is too coarse for them.
double meanCosine(const PlacedTool& placed) {
    constexpr std::int64_t kFine = kProbePerCell / 4;
    const sand::TurnedShape shape(placed.tool);
    std::vector<Offset> below;  // places below the tool, beside one that is not
    const std::int64_t reach = placed.tool.radius / kFine * kFine * 3 / 2;
    for (std::int64_t y = -reach; y <= reach; y += kFine) {
        for (std::int64_t x = -reach; x <= reach; x += kFine) {
            if (shape.covers({x, y}) && !(shape.covers({x + kFine, y}) && shape.covers({x - kFine, y}) &&
                                          shape.covers({x, y + kFine}) && shape.covers({x, y - kFine}))) {
                below.push_back({x, y});
            }
        }
    }
    double sum = 0;
    int count = 0;
    for (const Cell& cell : cellsWhere([&](int column, int row) { return placed.takes(column, row); })) {
        const Offset place = placed.offsetOf(cell.column, cell.row);
        const auto from = [&](const Offset& other) { return Offset{place.x - other.x, place.y - other.y}; };
        const Offset out =
            from(*std::ranges::min_element(below, {}, [&](const Offset& o) { return from(o).squared(); }));
        if (out.squared() > std::int64_t{kProbePerCell} * kProbePerCell) {
            const auto x = static_cast<double>(shape.share(place, {kProbePerCell, 0}));
            const auto y = static_cast<double>(shape.share(place, {0, kProbePerCell}));
            sum += (x * static_cast<double>(out.x) + y * static_cast<double>(out.y)) /
                   (std::hypot(x, y) * std::sqrt(static_cast<double>(out.squared())));
            ++count;
        }
    }
    return sum / count;
}

// Around a corner of an outline the directions differ, and slightly around an ellipse. With the shares of an ellipse,
// the mean of a rectangle is 0.91.
TEST(Receivers, ADragSharesALongToolsSandByTheOutlineThatItHas) {
    for (const PlacedTool& placed : tools(support::longTools())) {
        EXPECT_GT(meanCosine(placed), 0.95) << nameOf(placed);
    }
}

// A cell ahead takes a share in proportion to its distance ahead of the tool's centre. Shares are rounded down, and the
// remainder goes to the first cells by rows. The slowest hand moves by one probe unit, a 256th of a cell.
TEST(Receivers, ASlowDragPushesSandInItsOwnDirection) {
    for (const ToolKind kind : {sphere, circle}) {
        const PlacedTool placed{.tool = toolOf(kind, 11.3)};
        for (const ProbePoint& way :
             {ProbePoint{40, 9, 0}, {9, 40, 0}, {-3, 200, 0}, {-90, -91, 0}, {1, 0, 0}, {2, -1, 0}}) {
            const HeightField field = placed.dragged(way);
            const auto weightOf = [&](const Cell& cell) {
                const Offset offset = placed.offsetOf(cell.column, cell.row);
                return offset.x * way.x + offset.y * way.y;
            };
            const std::vector<Cell> ahead = cellsWhere([&](int column, int row) {
                return placed.takes(column, row) && weightOf({column, row}) > 0;
            });
            const std::int64_t taken = takenFrom(field);
            const std::int64_t total =
                std::accumulate(ahead.begin(), ahead.end(), std::int64_t{0},
                                [&](std::int64_t sum, const Cell& cell) { return sum + weightOf(cell); });
            std::int64_t rest = taken;
            for (const Cell& cell : ahead) {
                rest -= taken * weightOf(cell) / total;  // stays below 2^60
            }
            for (const Cell& cell : ahead) {
                ASSERT_EQ(field.height(cell.column, cell.row), taken * weightOf(cell) / total + (rest-- > 0 ? 1 : 0))
                    << nameOf(placed) << " by " << way.x << ", " << way.y << " at " << cell.column << ", " << cell.row;
            }
        }
    }
}

}  // namespace
}  // namespace receivers
