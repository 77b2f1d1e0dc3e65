// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/field_forms.hpp"

/// Geometry of the display in the room, and of its viewer. It is the same on every rank.
///
/// Room coordinates are right-handed and in metres. x runs to the viewer's right, y up, and z from the wall towards the
/// viewer. y = 0 is usually the floor. This folder has plain data and pure functions, without GL and MPI. Any thread
/// may call them.
namespace walls {

inline constexpr int kMaxTiles = 1024;             // of one wall
inline constexpr int kMaxTileSide = 16384;         // [pixel]
inline constexpr std::size_t kLongestWord = 4096;  // [byte] of a text in a wall's bytes; a wall file's are shorter
inline constexpr std::size_t kMostOutputs = 255;   // of a tile, and eyes of an output, in a wall's bytes

/// Eye for which a picture is drawn. `middle` is the midpoint of both eyes.
enum class Eye : std::uint8_t { left, right, middle };
/// The names are those in the file names of pictures.
constexpr auto valuesOf(Eye) {
    return std::array{base::Named{Eye::left, "left"}, base::Named{Eye::right, "right"},
                      base::Named{Eye::middle, "middle"}};
}
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
/// The names are those in wall files and options.
constexpr auto valuesOf(Stereo) {
    using enum Stereo;
    return std::array{base::Named{mono, "mono"},
                      base::Named{left, "left"},
                      base::Named{right, "right"},
                      base::Named{passive, "passive"},
                      base::Named{active, "active"},
                      base::Named{sideBySide, "side_by_side"},
                      base::Named{topBottom, "top_bottom"},
                      base::Named{rowInterlaced, "row_interlaced"},
                      base::Named{checkerboard, "checkerboard"},
                      base::Named{anaglyphColour, "anaglyph"},
                      base::Named{anaglyphHalf, "anaglyph_half"},
                      base::Named{anaglyphDubois, "anaglyph_dubois"}};
}

[[nodiscard]] inline std::string_view eyeName(Eye eye) { return base::nameOf(eye); }
[[nodiscard]] inline std::string_view stereoName(Stereo stereo) { return base::nameOf(stereo); }
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

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("lower_left", it.lowerLeft);
        visit("lower_right", it.lowerRight);
        visit("upper_left", it.upperLeft);
    }
    friend bool operator==(const Screen&, const Screen&) = default;
};

/// One projector or monitor of a tile, connected to one plug of the graphics card.
struct Output {
    std::string name;                  // tile's name; for `passive` with "_left" or "_right"
    std::vector<Eye> eyes;             // eyes that it shows, in the order in which the mode packs them
    std::string monitor;               // monitor for a full screen, named as xrandr lists it; empty: a window
    std::optional<glm::ivec2> window;  // [pixel], place of the window's top left corner; nullopt: the system chooses

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("name", base::text(it.name, kLongestWord));
        visit("eyes", base::upTo<std::uint8_t>(it.eyes, kMostOutputs));
        visit("monitor", base::text(it.monitor, kLongestWord));
        visit("window", base::spacedOptional(it.window));
    }
    friend bool operator==(const Output&, const Output&) = default;
};

/// Machine, X display and graphics card that draw a tile. Read from [[place]] of the wall file.
struct Place {
    std::string host;          // name of the machine for mpirun; empty: any machine
    std::string display;       // X display, such as ":0.1"; empty: the rank's DISPLAY
    std::int32_t device = -1;  // number of the EGL device; -1: the driver chooses

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("host", base::text(it.host, kLongestWord));
        visit("display", base::text(it.display, kLongestWord));
        visit("device", base::limited(it.device, -1, std::numeric_limits<std::int32_t>::max()));
    }
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

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("rank", it.rank);
        visit("row", it.row);
        visit("column", it.column);
        visit("name", base::text(it.name, kLongestWord));
        visit("screen", it.screen);
        visit("pixels", it.pixels);
        visit("outputs", base::upTo<std::uint8_t>(it.outputs, kMostOutputs));
        visit("place", it.place);
    }
    /// Returns which of its own numbers no wall file can give, or an empty text.
    [[nodiscard]] std::string refusal() const;
    friend bool operator==(const Tile&, const Tile&) = default;
};

/// Eyes of the viewer. Each eye is half of the separation away from `eye`, along `right`.
struct Viewer {
    glm::dvec3 eye{0};             // [m], the midpoint of the eyes
    double eyeSeparation = 0.065;  // [m]
    glm::dvec3 right{1, 0, 0};     // unit vector from the left eye to the right one

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("eye", it.eye);
        visit("eye_separation", it.eyeSeparation);
        visit("right", it.right);
    }
    /// Returns why the eyes are impossible, or an empty text.
    [[nodiscard]] std::string refusal() const;
    friend bool operator==(const Viewer&, const Viewer&) = default;
};

/// Clipping planes, parallel to each screen. Only things between them are drawn.
struct Clip {
    double near = 0.1, far = 100;  // [m], distances from the eye

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("near", it.near);
        visit("far", it.far);
    }
    /// Returns why the planes are impossible, or an empty text.
    [[nodiscard]] std::string refusal() const;
    friend bool operator==(const Clip&, const Clip&) = default;
};

/// Place of the field of sand in the room. projection.hpp makes a matrix of it.
struct Stage {
    glm::dvec3 centre{0};    // [m], centre of the field at its reference height
    double width = 1;        // [m], length of the field's longer side in the room
    double tiltDegrees = 0;  // about x: the north edge rises, and the surface turns towards the viewer
    double turnDegrees = 0;  // about the vertical after the tilt, counter-clockwise seen from above

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("centre", it.centre);
        visit("width", it.width);
        visit("tilt_deg", it.tiltDegrees);
        visit("turn_deg", it.turnDegrees);
    }
    /// Returns that the field has no size, or an empty text.
    [[nodiscard]] std::string refusal() const;
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

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("rows", base::limited(it.rows, 1, kMaxTiles));
        visit("columns", base::limited(it.columns, 1, kMaxTiles));
        visit("tile_size", it.tileSize);
        visit("bezel", it.bezel);
        visit("tile_pixels", it.tilePixels);
        visit("lower_left", it.lowerLeft);
        visit("right", it.right);
        visit("up", it.up);
    }
    /// Returns why the tiles have no size, or an empty text.
    [[nodiscard]] std::string refusal() const;
    friend bool operator==(const Grid&, const Grid&) = default;
};

/// A display and its viewer. The tile of a rank is tiles[rank - 1].
struct Wall {
    std::string name;
    Viewer viewer;
    Stereo stereo = Stereo::mono;
    bool swapEyes = false;  // the outputs show the right eye where the mode has the left one, and the other way round
    double refreshHz = 60;  // frames per second; each frame shows one eye if the eyes are shown in turn
    std::string tracking;   // source of the head's pose (docs/head_tracking.md); empty: the viewer does not move
    Clip clip;
    Stage stage;
    std::optional<Grid> grid;  // grid of the tiles with a row; nullopt: all screens are explicit
    std::vector<Tile> tiles;
    bool onDesk = false;  // the windows are placed for one desktop, and not by a wall file (desk_windows.hpp)

    /// Returns the number of render ranks. The master does not count.
    [[nodiscard]] int ranks() const { return static_cast<int>(tiles.size()); }
    /// Returns the wall as bytes. The master broadcasts them, so that no other rank reads a wall file.
    [[nodiscard]] base::Bytes encode() const;
    /// Returns the wall of encode(). Throws base::FormatError, which names the value that no wall file can give.
    static Wall decode(std::span<const std::uint8_t> bytes);

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("encoding", base::constant(std::uint8_t{4}, "encoding 4, the only one that this program knows"));
        visit("name", base::text(it.name, kLongestWord));
        visit("viewer", it.viewer);
        visit("stereo", it.stereo);
        visit("swap_eyes", it.swapEyes);
        visit("refresh_hz", it.refreshHz);
        visit("tracking", base::text(it.tracking, kLongestWord));
        visit("clip", it.clip);
        visit("stage", it.stage);
        visit("grid", it.grid);
        visit("tiles", base::upTo<std::uint32_t>(it.tiles, kMaxTiles));
        visit("on_desk", it.onDesk);
    }
    /// Returns which of its parts do not fit together, or an empty text.
    [[nodiscard]] std::string refusal() const;
    friend bool operator==(const Wall&, const Wall&) = default;
};

/// Returns the outputs of a tile with this name. `swapEyes` is Wall::swapEyes.
[[nodiscard]] std::vector<Output> outputsOf(Stereo stereo, const std::string& tileName, bool swapEyes = false);
/// Returns the tiles of a grid, row by row from the top left. Their ranks count from 1.
[[nodiscard]] std::vector<Tile> tilesOf(const Grid& grid, Stereo stereo);

/// Returns whether the display stretches each eye's half of the frame to the whole screen, as 3D televisions do.
///
/// This is so if the eyes are side by side, and the tile's pixels are closer to twice as wide as high than to square.
/// It is also so if the eyes are one above the other, and the pixels are closer to twice as high as wide.
[[nodiscard]] bool isStretched(Stereo stereo, const Tile& tile);

/// Returns the wall with `swapEyes`. All of its outputs show the eyes accordingly; a wall that draws one eye shows the
/// same picture as before. The pictures of the eyes themselves do not change.
[[nodiscard]] Wall withSwappedEyes(Wall wall, bool swapEyes);

/// Returns the wall in another stereo mode. Eyes and outputs are those of the new mode, swapped if the wall swaps eyes.
/// An output keeps its monitor or window if the new mode still has that output.
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
