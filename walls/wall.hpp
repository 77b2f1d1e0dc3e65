// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/byte_stream.hpp"

/// Geometry of the display in the room, and of its viewer. It is the same on every rank.
///
/// Room coordinates are right-handed and in metres. x runs to the viewer's right, y up, and z from the wall towards the
/// viewer. y = 0 is usually the floor. This folder has plain data and pure functions, without GL and MPI. Any thread
/// may call them.
namespace walls {

inline constexpr int kMaxTiles = 1024;      // of one wall
inline constexpr int kMaxTileSide = 16384;  // [pixel]

/// Eye for which a picture is drawn. `middle` is the midpoint of both eyes.
enum class Eye : std::uint8_t { left, right, middle };
/// Stereo mode: how a tile's pictures reach the two eyes. All modes except `passive` have one output per tile.
enum class Stereo : std::uint8_t {
    mono,            // one picture, seen from the midpoint of the eyes
    left,            // the left eye alone
    right,           // the right eye alone
    passive,         // two outputs per tile, one for each eye, separated by polarisers
    active,          // both eyes in quad buffers; without quad buffers, one eye in each frame, in turn
    sideBySide,      // one buffer twice as wide, left eye on the left
    topBottom,       // one buffer twice as high, left eye above
    rowInterlaced,   // even rows show the left eye, odd rows the right one; the top row is row 0
    checkerboard,    // pixels whose row + column is even show the left eye; counted from the top left
    anaglyphColour,  // red from the left eye, green and blue from the right
    anaglyphHalf,    // red from the left eye's luminance, green and blue from the right
    anaglyphDubois   // both eyes mixed by Dubois' least-squares matrices (2001) for red-cyan glasses
};
inline constexpr Stereo kLastStereo = Stereo::anaglyphDubois;

/// Returns "left", "right" or "middle", as in the file names of pictures.
[[nodiscard]] std::string_view eyeName(Eye eye);
/// Returns the mode's name in wall files and options, such as "side_by_side".
[[nodiscard]] std::string_view stereoName(Stereo stereo);
/// Returns the names of all modes, in the order of Stereo.
[[nodiscard]] const std::vector<std::string>& stereoNames();
/// Returns the mode with this name. Throws base::InputError, which lists all names, if there is no such mode.
[[nodiscard]] Stereo stereoNamed(const std::string& name);
/// Returns the eyes that a mode draws, in the order of drawing. They are the middle for `mono`, one eye for `left` and
/// `right`, and left and right for all other modes.
[[nodiscard]] std::span<const Eye> eyesOf(Stereo stereo);
/// Returns whether each output shows one picture that is packed from both eyes' pictures.
[[nodiscard]] bool packsEyes(Stereo stereo);
/// Returns the size of each output's buffer [pixel] if one eye's picture has the size `eyePixels`.
[[nodiscard]] glm::ivec2 outputPixels(Stereo stereo, glm::ivec2 eyePixels);

/// Lit rectangle of a tile in the room, given by three corners as the viewer sees them [m].
struct Screen {
    glm::dvec3 lowerLeft{0}, lowerRight{1, 0, 0}, upperLeft{0, 1, 0};

    [[nodiscard]] glm::dvec3 upperRight() const { return lowerRight + upperLeft - lowerLeft; }
    [[nodiscard]] double width() const { return glm::length(lowerRight - lowerLeft); }             // [m]
    [[nodiscard]] double height() const { return glm::length(upperLeft - lowerLeft); }             // [m]
    [[nodiscard]] glm::dvec3 right() const { return glm::normalize(lowerRight - lowerLeft); }      // unit vector
    [[nodiscard]] glm::dvec3 up() const { return glm::normalize(upperLeft - lowerLeft); }          // unit vector
    [[nodiscard]] glm::dvec3 normal() const { return glm::normalize(glm::cross(right(), up())); }  // to the viewer
    [[nodiscard]] double distanceTo(glm::dvec3 eye) const {
        return glm::dot(eye - lowerLeft, normal());
    }  // [m], < 0 behind
    friend bool operator==(const Screen&, const Screen&) = default;
};

/// One projector or monitor of a tile, connected to one plug of the graphics card.
struct Output {
    std::string name;                  // tile's name; for `passive` with "_left" or "_right"
    std::vector<Eye> eyes;             // eyes that it shows
    std::string monitor;               // monitor for a full screen, named as xrandr lists it; empty: a window
    std::optional<glm::ivec2> window;  // [pixel], place of the window's top left corner; nullopt: the system chooses
    friend bool operator==(const Output&, const Output&) = default;
};

/// Machine, X display and graphics card that draw a tile. Read from [[place]] of the wall file.
struct Place {
    std::string host;          // name of the machine for mpirun; empty: any machine
    std::string display;       // X display, such as ":0.1"; empty: the rank's DISPLAY
    std::int32_t device = -1;  // number of the EGL device; -1: the driver chooses
    friend bool operator==(const Place&, const Place&) = default;
};

/// Part of the wall that one render rank draws.
struct Tile {
    std::int32_t rank = 1;             // 1..n: the grid row by row from the top left, then the explicit screens
    std::int32_t row = 0, column = 0;  // in the grid, counted from 1 at the top left; 0 for an explicit screen
    std::string name;                  // unique and fit for a file name, such as "r1c4" or "floor"
    Screen screen;
    glm::ivec2 pixels{1, 1};  // [pixel], width and height of one eye's picture
    std::vector<Output> outputs;
    Place place;
    friend bool operator==(const Tile&, const Tile&) = default;
};

/// Eyes of the viewer. Each eye is half of the separation away from `eye`, along `right`.
struct Viewer {
    glm::dvec3 eye{0};             // [m], the midpoint of the eyes
    double eyeSeparation = 0.065;  // [m]
    glm::dvec3 right{1, 0, 0};     // unit vector from the left eye to the right one
    friend bool operator==(const Viewer&, const Viewer&) = default;
};

/// Clipping planes, parallel to each screen. Only things between them are drawn.
struct Clip {
    double near = 0.1, far = 100;  // [m], distances from the eye
    friend bool operator==(const Clip&, const Clip&) = default;
};

/// Place of the field of sand in the room. projection.hpp makes a matrix of it.
struct Stage {
    glm::dvec3 centre{0};    // [m], centre of the field at its reference height
    double width = 1;        // [m], length of the field's longer side in the room
    double tiltDegrees = 0;  // about x: the north edge rises, and the surface turns towards the viewer
    double turnDegrees = 0;  // about the vertical after the tilt, counter-clockwise seen from above
    friend bool operator==(const Stage&, const Stage&) = default;
};

/// Equal tiles in rows and columns. tilesOf() makes the tiles from these numbers.
struct Grid {
    std::int32_t rows = 1, columns = 1;
    glm::dvec2 tileSize{1};    // [m], width and height of a tile's lit area
    glm::dvec2 bezel{0};       // [m], horizontal and vertical gap between neighbouring lit areas; < 0: they overlap
    glm::ivec2 tilePixels{1};  // [pixel], of one eye's picture
    glm::dvec3 lowerLeft{0};   // [m], lower left corner of the whole grid
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0};  // perpendicular unit vectors
    friend bool operator==(const Grid&, const Grid&) = default;
};

/// A display and its viewer. The tile of a rank is tiles[rank - 1].
struct Wall {
    std::string name;
    Viewer viewer;
    Stereo stereo = Stereo::mono;
    double refreshHz = 60;  // frames per second; each frame shows one eye if the eyes are shown in turn
    std::string tracking;   // source of the head's pose (docs/head_tracking.md); empty: the viewer does not move
    Clip clip;
    Stage stage;
    std::optional<Grid> grid;  // grid of the tiles with a row; nullopt: all screens are explicit
    std::vector<Tile> tiles;

    /// Returns the number of render ranks. The master does not count.
    [[nodiscard]] int ranks() const { return static_cast<int>(tiles.size()); }
    /// Returns the wall as bytes. The master broadcasts them, so that no other rank reads a wall file.
    [[nodiscard]] base::Bytes encode() const;
    /// Returns the wall of encode(). Throws base::FormatError if the bytes are too few or too many, or if a value is
    /// invalid.
    static Wall decode(std::span<const std::uint8_t> bytes);
    friend bool operator==(const Wall&, const Wall&) = default;
};

/// Returns the outputs of a tile with this name.
[[nodiscard]] std::vector<Output> outputsOf(Stereo stereo, const std::string& tileName);
/// Returns the tiles of a grid, row by row from the top left. Their ranks count from 1.
[[nodiscard]] std::vector<Tile> tilesOf(const Grid& grid, Stereo stereo);

/// Returns whether the display stretches each eye's half of the frame to the whole screen, as 3D televisions do.
///
/// This is so if the eyes are side by side, and the tile's pixels are closer to twice as wide as high than to square.
/// It is also so if the eyes are one above the other, and the pixels are closer to twice as high as wide.
[[nodiscard]] bool isStretched(Stereo stereo, const Tile& tile);

/// Returns the wall in another stereo mode. Eyes and outputs are those of the new mode. An output keeps its
/// monitor or window if the new mode still has that output.
///
/// If the display stretches the halves of a frame, the frame keeps its size, and the eyes' pictures get the size that
/// fits it. So mono fills the screen of a 3D television.
[[nodiscard]] Wall shownIn(Wall wall, Stereo stereo);

/// Reads and checks a wall file (docs/wall_files.md). Throws base::InputError with the file, the line and what to do.
[[nodiscard]] Wall loadWall(const std::filesystem::path& file);
/// Reads a wall file as loadWall() does, and returns the wall in the mode named `stereo`. An empty name means the
/// file's own mode. Throws base::InputError also if the wall cannot be shown in that mode, such as with an eye behind a
/// screen.
[[nodiscard]] Wall loadWallAs(const std::filesystem::path& file, const std::string& stereo);
/// Reads and checks the text of a wall file. Error messages give `name` as the name of the file.
[[nodiscard]] Wall parseWall(std::string_view text, const std::string& name);

}  // namespace walls
