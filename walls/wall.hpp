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

/// Where the display stands in the room and who looks at it, the same on every rank.
///
/// The room is right-handed and in metres: x to the viewer's right, y up, z from the wall towards the viewer; y = 0 is
/// usually the floor. Everything here is plain data and pure functions: no GL, no MPI, safe from any thread.
namespace walls {

inline constexpr int kMaxTiles = 1024;
inline constexpr int kMaxTileSide = 16384;  // [pixel]

enum class Eye : std::uint8_t { left, right, middle };
/// How a tile's pictures reach two eyes. All but passive have one output per tile.
enum class Stereo : std::uint8_t {
    mono,            // seen from the middle between the eyes
    left,            // the left eye alone
    right,           // the right eye alone
    passive,         // two outputs per tile, one for each eye, told apart by polarisers
    active,          // the eyes in turn: quad buffers where the driver has them, else frame by frame
    sideBySide,      // one buffer twice as wide, left eye on the left
    topBottom,       // one buffer twice as high, left eye above
    rowInterlaced,   // even rows (from the top, from 0) show the left eye, odd rows the right one
    checkerboard,    // pixels whose row + column is even (from the top left) show the left eye
    anaglyphColour,  // red from the left eye, green and blue from the right
    anaglyphHalf,    // the same with the left eye's luminance as red
    anaglyphDubois   // least-squares matrices of Dubois (2001) for red-cyan glasses
};
inline constexpr Stereo kLastStereo = Stereo::anaglyphDubois;

/// "left", "right", "middle": as in the names of pictures.
[[nodiscard]] std::string_view eyeName(Eye eye);
[[nodiscard]] std::string_view stereoName(Stereo stereo);
/// All of them, in the order of the enumeration: as wall files and options write them.
[[nodiscard]] const std::vector<std::string>& stereoNames();
/// Throws base::InputError that lists them, for a name that is none of them.
[[nodiscard]] Stereo stereoNamed(const std::string& name);
/// The eyes that are drawn, in the order they are drawn: the middle alone for mono, left or right alone where only one
/// is shown, else left and right.
[[nodiscard]] std::span<const Eye> eyesOf(Stereo stereo);
/// Whether an output shows a picture that is made of both eyes' and is none of them.
[[nodiscard]] bool packsEyes(Stereo stereo);
/// Size of each output's buffer when one eye's picture has this size [pixel].
[[nodiscard]] glm::ivec2 outputPixels(Stereo stereo, glm::ivec2 eyePixels);

/// The lit rectangle of a tile by three of its corners, as the viewer sees them [m].
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

/// One plug of the graphics card: a projector or monitor, and the eyes it shows.
struct Output {
    std::string name;
    std::vector<Eye> eyes;
    std::string monitor;               // full screen on the monitor of this name, as xrandr lists it; empty: a window
    std::optional<glm::ivec2> window;  // [pixel], where the window's top left corner goes; none: where the system likes
    friend bool operator==(const Output&, const Output&) = default;
};

/// Which machine draws a tile, and with what; read from [[place]].
struct Place {
    std::string host;          // as mpirun knows it; empty: any
    std::string display;       // X display, such as ":0.1"; empty: the DISPLAY of the rank
    std::int32_t device = -1;  // EGL device by number; -1: the driver's choice
    friend bool operator==(const Place&, const Place&) = default;
};

/// What one render rank draws.
struct Tile {
    std::int32_t rank = 1;             // 1..n: the grid row by row from the top left, then the explicit screens
    std::int32_t row = 0, column = 0;  // from 1 at the top left of the grid; 0 for an explicit screen
    std::string name;                  // unique, fit for a file name: "r1c4", "floor"
    Screen screen;
    glm::ivec2 pixels{1, 1};  // width, height of one eye's picture
    std::vector<Output> outputs;
    Place place;
    friend bool operator==(const Tile&, const Tile&) = default;
};

/// Who looks. The eyes lie half the separation to either side of `eye` along `right`.
struct Viewer {
    glm::dvec3 eye{0};             // [m], the midpoint of the eyes
    double eyeSeparation = 0.065;  // [m]
    glm::dvec3 right{1, 0, 0};     // unit vector from the left eye to the right one
    friend bool operator==(const Viewer&, const Viewer&) = default;
};

/// Planes parallel to each screen between which things are drawn, from the eye [m].
struct Clip {
    double near = 0.1, far = 100;
    friend bool operator==(const Clip&, const Clip&) = default;
};

/// Where the field of sand stands in the room; projection.hpp turns it into a matrix.
struct Stage {
    glm::dvec3 centre{0};    // [m], of the field at its reference height
    double width = 1;        // [m], of the field's longer side
    double tiltDegrees = 0;  // about x: the north edge rises, the surface turns towards the viewer
    double turnDegrees = 0;  // about the vertical, counter-clockwise seen from above, after the tilt
    friend bool operator==(const Stage&, const Stage&) = default;
};

/// Equal tiles in rows and columns; the numbers the tiles were made from.
struct Grid {
    std::int32_t rows = 1, columns = 1;
    glm::dvec2 tileSize{1};  // [m], the lit area
    glm::dvec2 bezel{0};     // [m], between the lit areas of neighbours: horizontally, vertically; < 0: they overlap
    glm::ivec2 tilePixels{1};
    glm::dvec3 lowerLeft{0};                 // [m], corner of the whole grid
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0};  // unit vectors, perpendicular
    friend bool operator==(const Grid&, const Grid&) = default;
};

/// A display and its viewer. Tiles are in the order of ranks: tiles[rank - 1].
struct Wall {
    std::string name;
    Viewer viewer;
    Stereo stereo = Stereo::mono;
    double refreshHz = 60;  // frames per second; with eyes in turn each frame shows one of them
    std::string tracking;   // where the head's pose comes from (docs/head_tracking.md); empty: the viewer stands still
    Clip clip;
    Stage stage;
    std::optional<Grid> grid;  // tiles with a row came from it
    std::vector<Tile> tiles;

    [[nodiscard]] int ranks() const { return static_cast<int>(tiles.size()); }  // render ranks, without the master
    /// The wall as bytes: what the master broadcasts, so that no rank reads a file of its own.
    [[nodiscard]] base::Bytes encode() const;
    /// Throws base::FormatError when the bytes are cut short, too long or hold what cannot be.
    static Wall decode(std::span<const std::uint8_t> bytes);
    friend bool operator==(const Wall&, const Wall&) = default;
};

/// The outputs a tile of this name needs.
[[nodiscard]] std::vector<Output> outputsOf(Stereo stereo, const std::string& tileName);
/// The tiles of a grid, row by row from the top left, ranks from 1.
[[nodiscard]] std::vector<Tile> tilesOf(const Grid& grid, Stereo stereo);

/// Whether the display stretches each eye's half of the frame to the whole screen, as 3D televisions do: eyes side by
/// side or one above the other, with pixels closer to twice as wide as high, or twice as high, than to square.
[[nodiscard]] bool isStretched(Stereo stereo, const Tile& tile);

/// The same wall shown another way: eyes and outputs follow, monitors and windows are kept where they still fit. What
/// was half a frame stretched becomes the whole frame, so that mono fills the screen of a 3D television.
[[nodiscard]] Wall shownIn(Wall wall, Stereo stereo);

/// Reads and checks a wall file (docs/wall_files.md). Throws base::InputError with file, line and what to do.
[[nodiscard]] Wall loadWall(const std::filesystem::path& file);
/// The same wall shown in another mode, which may need an eye that the file's own did not draw; an empty name means the
/// file's own.
[[nodiscard]] Wall loadWallAs(const std::filesystem::path& file, const std::string& stereo);
/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Wall parseWall(std::string_view text, const std::string& name);

}  // namespace walls
