// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "walls/wall.hpp"
#include "walls/wall_check.hpp"

namespace walls {
namespace {

constexpr std::uint8_t kEncoding = 2;

template <glm::length_t N, class Number>
void put(base::ByteWriter& writer, const glm::vec<N, Number>& vector) {
    for (glm::length_t i = 0; i < N; ++i) {
        writer.put(vector[i]);
    }
}

template <class Vector>
Vector getVector(base::ByteReader& reader) {
    Vector vector;
    for (glm::length_t i = 0; i < Vector::length(); ++i) {
        vector[i] = reader.get<typename Vector::value_type>();
        if (!std::isfinite(static_cast<double>(vector[i]))) {
            throw base::FormatError("a wall with a coordinate that is not finite");
        }
    }
    return vector;
}

double getLength(base::ByteReader& reader) { return getVector<glm::dvec1>(reader).x; }

template <class Choice>
Choice getChoice(base::ByteReader& reader, Choice last) {
    const auto value = reader.get<std::uint8_t>();
    if (value > static_cast<std::uint8_t>(last)) {
        throw base::FormatError(fmt::format("a wall with a choice of {}", value));
    }
    return static_cast<Choice>(value);
}

void put(base::ByteWriter& writer, const Grid& grid) {
    writer.put(grid.rows);
    writer.put(grid.columns);
    put(writer, grid.tileSize);
    put(writer, grid.bezel);
    put(writer, grid.tilePixels);
    put(writer, grid.lowerLeft);
    put(writer, grid.right);
    put(writer, grid.up);
}

void checkPixels(glm::ivec2 pixels) {
    if (pixels.x < 1 || pixels.y < 1 || pixels.x > kMaxTileSide || pixels.y > kMaxTileSide) {
        throw base::FormatError(fmt::format("a tile of {}x{} pixels", pixels.x, pixels.y));
    }
}

Grid getGrid(base::ByteReader& reader) {
    Grid grid;
    grid.rows = reader.get<std::int32_t>();
    grid.columns = reader.get<std::int32_t>();
    grid.tileSize = getVector<glm::dvec2>(reader);
    grid.bezel = getVector<glm::dvec2>(reader);
    grid.tilePixels = getVector<glm::ivec2>(reader);
    grid.lowerLeft = getVector<glm::dvec3>(reader);
    grid.right = getVector<glm::dvec3>(reader);
    grid.up = getVector<glm::dvec3>(reader);
    checkPixels(grid.tilePixels);
    const bool sized = grid.tileSize.x > 0 && grid.tileSize.y > 0;
    if (!sized || glm::any(glm::greaterThan(grid.bezel, grid.tileSize)) ||
        glm::any(glm::lessThanEqual(grid.tileSize + grid.bezel, glm::dvec2(0))) || grid.rows < 1 || grid.columns < 1 ||
        grid.rows > kMaxTiles || grid.columns > kMaxTiles) {
        throw base::FormatError(
            fmt::format("a grid of {} rows and {} columns without a size", grid.rows, grid.columns));
    }
    return grid;
}

void put(base::ByteWriter& writer, const Tile& tile) {
    writer.put(tile.rank);
    writer.put(tile.row);
    writer.put(tile.column);
    writer.putText(tile.name);
    put(writer, tile.screen.lowerLeft);
    put(writer, tile.screen.lowerRight);
    put(writer, tile.screen.upperLeft);
    put(writer, tile.pixels);
    writer.put(static_cast<std::uint8_t>(tile.outputs.size()));
    for (const Output& output : tile.outputs) {
        writer.putText(output.name);
        writer.put(static_cast<std::uint8_t>(output.eyes.size()));
        for (const Eye eye : output.eyes) {
            writer.put(static_cast<std::uint8_t>(eye));
        }
        writer.putText(output.monitor);
        writer.put(static_cast<std::uint8_t>(output.window.has_value()));
        put(writer, output.window.value_or(glm::ivec2(0)));
    }
    writer.putText(tile.place.host);
    writer.putText(tile.place.display);
    writer.put(tile.place.device);
}

Tile getTile(base::ByteReader& reader) {
    Tile tile;
    tile.rank = reader.get<std::int32_t>();
    tile.row = reader.get<std::int32_t>();
    tile.column = reader.get<std::int32_t>();
    tile.name = reader.getText();
    tile.screen.lowerLeft = getVector<glm::dvec3>(reader);
    tile.screen.lowerRight = getVector<glm::dvec3>(reader);
    tile.screen.upperLeft = getVector<glm::dvec3>(reader);
    tile.pixels = getVector<glm::ivec2>(reader);
    checkPixels(tile.pixels);
    tile.outputs.resize(reader.get<std::uint8_t>());
    for (Output& output : tile.outputs) {
        output.name = reader.getText();
        output.eyes.resize(reader.get<std::uint8_t>());
        for (Eye& eye : output.eyes) {
            eye = getChoice(reader, Eye::middle);
        }
        output.monitor = reader.getText();
        const bool placed = getChoice(reader, std::uint8_t{1}) == 1;
        const auto window = getVector<glm::ivec2>(reader);
        output.window = placed ? std::optional(window) : std::nullopt;
    }
    tile.place.host = reader.getText();
    tile.place.display = reader.getText();
    tile.place.device = reader.get<std::int32_t>();
    return tile;
}

void require(bool holds, const Tile& tile, const char* what) {
    if (!holds) {
        throw base::FormatError(fmt::format("a wall whose tile of rank {} {}", tile.rank, what));
    }
}

/// Checks that the outputs and their eyes are those of the stereo mode, because a rank draws by them.
void checkOutputs(const Tile& tile, Stereo stereo) {
    const std::vector<Output> expected = outputsOf(stereo, tile.name);
    require(tile.outputs.size() == expected.size(), tile, "has outputs of another stereo");
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const Output& output = tile.outputs[i];
        require(output.name == expected[i].name && output.eyes == expected[i].eyes, tile,
                "shows eyes of another stereo");
        require(output.monitor.empty() || !output.window, tile, "has a monitor and a window at once");
        require(isOneLine(output.monitor, kMaxTracking), tile, "has a monitor without a name");
    }
}

void checkTile(const Wall& wall, const Tile& tile) {
    require(tile.rank == wall.ranks() + 1, tile, "is out of order");
    if (tile.row == 0 && tile.column == 0) {
        require(isTileName(tile.name), tile, "has no fit name");
    } else {
        require(wall.grid && tile.row >= 1 && tile.row <= wall.grid->rows && tile.column >= 1 &&
                    tile.column <= wall.grid->columns &&
                    tile.rank == (tile.row - 1) * wall.grid->columns + tile.column &&
                    tile.name == fmt::format("r{}c{}", tile.row, tile.column),
                tile, "is out of its grid");
    }
    const double width = tile.screen.width(), height = tile.screen.height();
    require(width > 0 && height > 0, tile, "has no size");
    require(std::abs(glm::dot(tile.screen.right(), tile.screen.up())) < 1e-6, tile, "is not a rectangle");
    require(tile.place.device >= -1, tile, "has no such device");
    checkOutputs(tile, wall.stereo);
}

void checkFrame(const Wall& wall) {
    const Viewer& viewer = wall.viewer;
    const bool eyes = viewer.eyeSeparation > 0 && viewer.eyeSeparation <= kMaxEyeSeparation &&
                      std::abs(glm::length(viewer.right) - 1) < 1e-9;
    const bool rates = wall.refreshHz >= kMinRefresh && wall.refreshHz <= kMaxRefresh;
    const bool drawn = wall.clip.near > 0 && wall.clip.far > wall.clip.near && wall.stage.width > 0;
    if (!eyes || !rates || !drawn || !isOneLine(wall.tracking, kMaxTracking)) {
        throw base::FormatError("a wall with eyes, rates or planes that cannot be");
    }
}

}  // namespace

base::Bytes Wall::encode() const {
    base::ByteWriter writer;
    writer.put(kEncoding);
    writer.putText(name);
    put(writer, viewer.eye);
    writer.put(viewer.eyeSeparation);
    put(writer, viewer.right);
    writer.put(static_cast<std::uint8_t>(stereo));
    writer.put(refreshHz);
    writer.putText(tracking);
    writer.put(clip.near);
    writer.put(clip.far);
    put(writer, stage.centre);
    writer.put(stage.width);
    writer.put(stage.tiltDegrees);
    writer.put(stage.turnDegrees);
    writer.put(static_cast<std::uint8_t>(grid.has_value()));
    if (grid) {
        put(writer, *grid);
    }
    writer.put(static_cast<std::uint32_t>(tiles.size()));
    for (const Tile& tile : tiles) {
        put(writer, tile);
    }
    return writer.take();
}

Wall Wall::decode(std::span<const std::uint8_t> bytes) {
    base::ByteReader reader(bytes);
    if (const auto encoding = reader.get<std::uint8_t>(); encoding != kEncoding) {
        throw base::FormatError(fmt::format("a wall in encoding {}, this program knows {}", encoding, kEncoding));
    }
    Wall wall;
    wall.name = reader.getText();
    wall.viewer.eye = getVector<glm::dvec3>(reader);
    wall.viewer.eyeSeparation = getLength(reader);
    wall.viewer.right = getVector<glm::dvec3>(reader);
    wall.stereo = getChoice(reader, kLastStereo);
    wall.refreshHz = getLength(reader);
    wall.tracking = reader.getText();
    wall.clip.near = getLength(reader);
    wall.clip.far = getLength(reader);
    wall.stage.centre = getVector<glm::dvec3>(reader);
    wall.stage.width = getLength(reader);
    wall.stage.tiltDegrees = getLength(reader);
    wall.stage.turnDegrees = getLength(reader);
    if (getChoice(reader, std::uint8_t{1}) == 1) {
        wall.grid = getGrid(reader);
    }
    checkFrame(wall);
    const auto count = reader.get<std::uint32_t>();
    const std::uint32_t gridTiles =
        wall.grid ? static_cast<std::uint32_t>(wall.grid->rows) * static_cast<std::uint32_t>(wall.grid->columns) : 0;
    if (count < 1 || count > kMaxTiles || count < gridTiles) {
        throw base::FormatError(fmt::format("a wall of {} tiles", count));
    }
    std::set<std::string> names;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Tile tile = getTile(reader);
        checkTile(wall, tile);
        require(names.insert(tile.name).second, tile, "has the name of another");
        wall.tiles.push_back(tile);
    }
    if (!reader.atEnd()) {
        throw base::FormatError(fmt::format("{} bytes after the last tile of a wall", reader.rest().size()));
    }
    return wall;
}

}  // namespace walls
