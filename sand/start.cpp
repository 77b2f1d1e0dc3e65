// SPDX-License-Identifier: Apache-2.0
#include "sand/start.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sand/model/grid_codec.hpp"

namespace sand {
namespace {

/// Returns a lower bound of the memory that a coarse phase takes, and that an undo of it takes [byte].
std::int64_t bytesOfCoarsePhase(const Rules& rules) {
    if (!rules.sweepPlan().hasCoarsePhase()) {
        return 0;
    }
    // The undo keeps the cells of the patch. A group of 16 cells has two heights, two fluxes, a sum and a range.
    constexpr std::int64_t kPerGroup = 16 * sizeof(std::int32_t) + 8 * sizeof(std::int32_t);
    const auto within = [&rules](std::int64_t length, std::int64_t width) {
        return std::min<std::int64_t>(length, rules.columns) * std::min<std::int64_t>(width, rules.rows);
    };
    const Tool& tool = rules.tuning.tool;
    const std::int32_t radius = tool.radius / kProbePerCell;
    const std::int64_t half = isRound(tool.kind) ? radius : tool.halfWidth / kProbePerCell,
                       length = 2 * std::int64_t{radius};
    const std::int64_t patch = within(2 * SweepPlan::reach(radius), 2 * SweepPlan::reach(radius));
    const std::int64_t undersides = std::min(within(length, 2 * half), within(2 * half, length));
    return kPerGroup * (patch / 16) + static_cast<std::int64_t>(sizeof(std::int32_t)) * undersides;
}

}  // namespace

HeightField unpackedHeights(const base::Bytes& packed, int columns, int rows, double cellSize) {
    HeightField heights(columns, rows, cellSize);
    base::ByteReader reader(packed);
    decodeCells(reader, heights.bounds(), kMaxHeight, heights.cells());
    return heights;
}

FieldSize FieldSize::of(const Rules& rules) { return {rules.columns, rules.rows, rules.tin != 0}; }

std::optional<std::int64_t> FieldSize::bytesOfReplica() const {
    if (nominal) {
        return std::nullopt;
    }
    // When all sand moves: the height, the fluxes through two faces of the cell, and the height before the stroke.
    constexpr std::int64_t kPerCell = 4 * sizeof(std::int32_t);
    return kPerCell * columns * rows;
}

std::int64_t FieldSize::bytesOfHeights() const { return std::int64_t{sizeof(std::int32_t)} * columns * rows; }

std::string FieldSize::text() const {
    return std::to_string(columns) + " x " + std::to_string(rows) + (nominal ? " nominal cells of a TIN" : " cells");
}

bool Start::recordsMovement() const { return tin == nullptr; }

void Start::beginAs(tin::TinStart start) {
    tin = std::make_shared<const tin::TinStart>(std::move(start));
    rules.tin = tin->digest();
    terrain = HeightField(1, 1, terrain.cellSize());
    packed = nullptr;
}

void Start::pack(const std::function<void()>& between) {
    packed = packedCells(terrain.cells(), terrain.bounds(), between);
}

void Start::encodeSand(base::ByteWriter& writer) const {
    encodePacked(packed != nullptr ? *packed : *packedCells(terrain.cells(), terrain.bounds()), writer);
    if (tin != nullptr) {
        tin->encode(writer);
    }
    if (ground != nullptr) {
        encodeCells(ground->cells(), terrain.bounds(), writer);
    }
}

void Start::decodeSand(base::ByteReader& reader, double cellSize, Keep keep,
                       const std::function<void(std::size_t)>& decoded) {
    const bool grid = rules.tin == 0;
    const int columns = grid ? rules.columns : 1, rows = grid ? rules.rows : 1;
    requireCells(reader, static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    terrain = HeightField(columns, rows, cellSize);
    const std::span<const std::uint8_t> before = reader.rest();
    decodeCells(reader, terrain.bounds(), kMaxHeight, terrain.cells(), decoded);
    const auto cells = before.first(before.size() - reader.rest().size());
    packed = keep == Keep::packedToo ? std::make_shared<const base::Bytes>(cells.begin(), cells.end()) : nullptr;
    if (!grid) {
        tin = std::make_shared<const tin::TinStart>(tin::TinStart::decode(reader));
        if (tin->digest() != rules.tin || rules.ground != 0) {
            throw base::FormatError("a scene whose TIN is not that of its rules");
        }
    }
    if (rules.ground != 0) {
        ground = std::make_shared<const Ground>(Ground::decode(reader, terrain));
        if (ground->digest() != rules.ground) {
            throw base::FormatError("a scene whose ground is not that of its rules");
        }
    }
}

HeightField Start::takeHeights() {
    volumeTaken = volumeOfHeights();
    return std::exchange(terrain, HeightField(1, 1, terrain.cellSize()));
}

HeightField Start::heightsAgain() const {
    if (packed == nullptr) {
        throw std::logic_error("Start::heightsAgain: the heights are gone");
    }
    return unpackedHeights(*packed, rules.columns, rules.rows, terrain.cellSize());
}

bool Start::hasHeights(const base::Bytes& other) const {
    base::ByteReader reader(other);
    std::vector<std::int32_t> row(static_cast<std::size_t>(terrain.columns()));
    bool same = true;
    const auto compare = [&](int y) { same = same && std::equal(row.begin(), row.end(), terrain.row(y)); };
    decodeRows(reader, terrain.bounds(), kMaxHeight, {[&row](int) { return row.data(); }, compare});
    return same;
}

void Start::dropHeights() {
    if (tin == nullptr) {
        (void)takeHeights();
        packed = nullptr;
    }
}

SurfaceData Start::data() const {
    if (tin != nullptr) {
        throw std::logic_error("Start::data: a TIN has no triangles yet");
    }
    return GridData{terrain, ground.get()};
}

std::optional<Start> Start::middle(int most) const {
    if (tin != nullptr) {
        return std::nullopt;
    }
    Start part;
    part.rules = rules;
    part.rules.columns = std::min(rules.columns, most);
    part.rules.rows = std::min(rules.rows, most);
    part.terrain = HeightField(part.rules.columns, part.rules.rows, terrain.cellSize());
    const auto below = ground ? std::make_shared<Ground>(part.rules.columns, part.rules.rows) : nullptr;
    const int x0 = (rules.columns - part.rules.columns) / 2, y0 = (rules.rows - part.rules.rows) / 2;
    for (int y = 0; y < part.rules.rows; ++y) {
        for (int x = 0; x < part.rules.columns; ++x) {
            part.terrain.setHeight(x, y, terrain.height(x0 + x, y0 + y));
            if (below && ground->isWall(x0 + x, y0 + y)) {
                below->setWall(x, y);
            } else if (below) {
                below->setBedrock(x, y, ground->bedrock(x0 + x, y0 + y));
            }
        }
    }
    part.ground = below;
    return part;
}

std::int32_t Start::referenceHeight() const {
    if (tin != nullptr) {
        return tin->meanHeight;
    }
    const std::int64_t cells = std::int64_t{rules.columns} * rules.rows;
    return static_cast<std::int32_t>(volumeOfHeights().value_or(0) / cells);
}

std::int64_t Start::leastBytes() const {
    if (tin != nullptr) {
        // Replicas of 66 thousand to a million vertices took 329 to 401 bytes per vertex, depending on the layout of
        // the mesh.
        constexpr std::int64_t kPerVertex = 320;
        return kPerVertex * static_cast<std::int64_t>(tin->places.size());
    }
    return FieldSize::of(rules).leastBytes() + bytesOfCoarsePhase(rules);
}

std::int64_t Start::bytesToDraw() const {
    // A TIN is drawn with a height for each nominal cell, from which follows how much sky each place sees.
    return tin != nullptr ? std::int64_t{sizeof(float)} * rules.columns * rules.rows : 0;
}

std::optional<std::int64_t> Start::volumeOfHeights() const {
    if (tin != nullptr) {
        return std::nullopt;
    }
    return volumeTaken ? volumeTaken : std::optional(terrain.volume());
}

std::int64_t Start::mostStateBytes() const {
    if (tin != nullptr) {
        return 0;
    }
    // Heights and two fluxes, now and before the stroke. Movement has a few bytes for 32 x 32 cells.
    return rules.mostBytesOf(6);
}

SizeText Start::sizeText() const {
    const FieldSize field = FieldSize::of(rules);
    if (tin != nullptr) {
        return {"a TIN's " + std::to_string(tin->places.size()) + " vertices over " + std::to_string(field.columns) +
                    " x " + std::to_string(field.rows) + " nominal cells",
                "fewer of either"};
    }
    if (rules.sweepPlan().hasCoarsePhase()) {
        const std::int32_t radius = rules.tuning.tool.radius / kProbePerCell;
        return {field.text() + " with a tool of " + std::to_string(radius) + " cells", "fewer cells or a smaller tool"};
    }
    return {field.text(), "fewer cells"};
}

}  // namespace sand
