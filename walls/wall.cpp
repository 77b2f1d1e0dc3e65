// SPDX-License-Identifier: Apache-2.0
#include "walls/wall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace walls {
namespace {

constexpr std::uint8_t kEncoding = 2;

template <glm::length_t N, class Number>
void put(files::ByteWriter& writer, const glm::vec<N, Number>& vector) {
    for (glm::length_t i = 0; i < N; ++i) {
        writer.put(vector[i]);
    }
}

template <class Vector>
Vector getVector(files::ByteReader& reader) {
    Vector vector;
    for (glm::length_t i = 0; i < Vector::length(); ++i) {
        vector[i] = reader.get<typename Vector::value_type>();
        if (!std::isfinite(static_cast<double>(vector[i]))) {
            throw files::FormatError("a wall with a coordinate that is not finite");
        }
    }
    return vector;
}

double getLength(files::ByteReader& reader) { return getVector<glm::dvec1>(reader).x; }

template <class Choice>
Choice getChoice(files::ByteReader& reader, Choice last) {
    const auto value = reader.get<std::uint8_t>();
    if (value > static_cast<std::uint8_t>(last)) {
        throw files::FormatError(fmt::format("a wall with a choice of {}", value));
    }
    return static_cast<Choice>(value);
}

void put(files::ByteWriter& writer, const Grid& grid) {
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
        throw files::FormatError(fmt::format("a tile of {}x{} pixels", pixels.x, pixels.y));
    }
}

Grid getGrid(files::ByteReader& reader) {
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
    if (!sized || glm::any(glm::greaterThan(glm::abs(grid.bezel), grid.tileSize)) || grid.rows < 1 ||
        grid.columns < 1 || grid.rows > kMaxTiles || grid.columns > kMaxTiles) {
        throw files::FormatError(
            fmt::format("a grid of {} rows and {} columns without a size", grid.rows, grid.columns));
    }
    return grid;
}

void put(files::ByteWriter& writer, const Tile& tile) {
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

Tile getTile(files::ByteReader& reader) {
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

}  // namespace

std::string_view eyeName(Eye eye) {
    constexpr std::array<std::string_view, 3> kNames{"left", "right", "middle"};
    return kNames.at(static_cast<std::size_t>(eye));
}

const std::vector<std::string>& stereoNames() {
    static const std::vector<std::string> kNames{"mono",         "left",         "right",         "passive",
                                                 "active",       "side_by_side", "top_bottom",    "row_interlaced",
                                                 "checkerboard", "anaglyph",     "anaglyph_half", "anaglyph_dubois"};
    return kNames;
}

std::string_view stereoName(Stereo stereo) { return stereoNames().at(static_cast<std::size_t>(stereo)); }

Stereo stereoNamed(const std::string& name) {
    const auto found = std::find(stereoNames().begin(), stereoNames().end(), name);
    if (found == stereoNames().end()) {
        throw std::out_of_range("no stereo mode " + name);
    }
    return static_cast<Stereo>(found - stereoNames().begin());
}

std::span<const Eye> eyesOf(Stereo stereo) {
    static constexpr std::array<Eye, 2> kBoth{Eye::left, Eye::right};
    static constexpr std::array<Eye, 1> kMiddle{Eye::middle};
    switch (stereo) {
        case Stereo::mono:
            return kMiddle;
        case Stereo::left:
            return std::span(kBoth).first(1);
        case Stereo::right:
            return std::span(kBoth).last(1);
        default:
            return kBoth;
    }
}

glm::ivec2 outputPixels(Stereo stereo, glm::ivec2 eyePixels) {
    switch (stereo) {
        case Stereo::sideBySide:
            return {2 * eyePixels.x, eyePixels.y};
        case Stereo::topBottom:
            return {eyePixels.x, 2 * eyePixels.y};
        default:
            return eyePixels;
    }
}

std::vector<Output> outputsOf(Stereo stereo, const std::string& tileName) {
    if (stereo == Stereo::passive) {
        return {{tileName + "_left", {Eye::left}, {}, {}}, {tileName + "_right", {Eye::right}, {}, {}}};
    }
    const std::span<const Eye> eyes = eyesOf(stereo);
    return {{tileName, {eyes.begin(), eyes.end()}, {}, {}}};
}

std::vector<Tile> tilesOf(const Grid& grid, Stereo stereo) {
    std::vector<Tile> tiles;
    const glm::dvec2 pitch = grid.tileSize + grid.bezel;
    for (int row = 1; row <= grid.rows; ++row) {
        for (int column = 1; column <= grid.columns; ++column) {
            Tile tile;
            tile.rank = static_cast<std::int32_t>(tiles.size()) + 1;
            tile.row = row;
            tile.column = column;
            tile.name = fmt::format("r{}c{}", row, column);
            tile.screen.lowerLeft =
                grid.lowerLeft + grid.right * (pitch.x * (column - 1)) + grid.up * (pitch.y * (grid.rows - row));
            tile.screen.lowerRight = tile.screen.lowerLeft + grid.right * grid.tileSize.x;
            tile.screen.upperLeft = tile.screen.lowerLeft + grid.up * grid.tileSize.y;
            tile.pixels = grid.tilePixels;
            tile.outputs = outputsOf(stereo, tile.name);
            tiles.push_back(std::move(tile));
        }
    }
    return tiles;
}

Wall shownIn(Wall wall, Stereo stereo) {
    for (Tile& tile : wall.tiles) {
        std::vector<Output> outputs = outputsOf(stereo, tile.name);
        for (std::size_t i = 0; i < std::min(outputs.size(), tile.outputs.size()); ++i) {
            outputs[i].monitor = tile.outputs[i].monitor;
            outputs[i].window = tile.outputs[i].window;
        }
        tile.outputs = std::move(outputs);
    }
    wall.stereo = stereo;
    return wall;
}

files::Bytes Wall::encode() const {
    files::ByteWriter writer;
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
    files::ByteReader reader(bytes);
    if (const auto encoding = reader.get<std::uint8_t>(); encoding != kEncoding) {
        throw files::FormatError(fmt::format("a wall in encoding {}, this program knows {}", encoding, kEncoding));
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
    const auto count = reader.get<std::uint32_t>();
    if (count < 1 || count > kMaxTiles) {
        throw files::FormatError(fmt::format("a wall of {} tiles", count));
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const Tile tile = getTile(reader);
        const bool placed = wall.grid && tile.row >= 1 && tile.row <= wall.grid->rows && tile.column >= 1 &&
                            tile.column <= wall.grid->columns;
        if (tile.rank != wall.ranks() + 1 || (!placed && (tile.row != 0 || tile.column != 0))) {
            throw files::FormatError(fmt::format("a tile out of place: number {} has rank {}, row {}, column {}", i + 1,
                                                 tile.rank, tile.row, tile.column));
        }
        wall.tiles.push_back(tile);
    }
    if (!reader.atEnd()) {
        throw files::FormatError(fmt::format("{} bytes after the last tile of a wall", reader.rest().size()));
    }
    return wall;
}

}  // namespace walls
