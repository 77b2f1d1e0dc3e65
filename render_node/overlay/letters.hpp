// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

namespace render_node {

/// Picture of a letter: how much of each pixel it covers. Rows are from the top.
struct Letter {
    std::uint16_t code;          // in Unicode
    std::int16_t advance;        // to the next letter [pixel]
    std::int16_t left, top;      // of the picture, from the pen on the base line [pixel]; up is negative
    std::int16_t width, height;  // [pixel]
    std::uint32_t begin;         // index in Face::coverage
};

/// The letters of DejaVu Sans in one size, drawn at build time (bake_font.cpp).
struct Face {
    int size;        // of the em square [pixel]
    int ascent;      // from the top of a line to its base line [pixel]
    int lineHeight;  // [pixel]
    std::span<const Letter> letters;
    std::span<const std::uint8_t> coverage;  // 0 to 255
};
/// Returns all sizes, the smallest first.
[[nodiscard]] std::span<const Face> faces();
/// Returns the largest face of at most this size, or the smallest one.
[[nodiscard]] const Face& faceFor(int size /* [pixel] */);

/// Returns the width of a text in UTF-8 [pixel]. A character that the font lacks counts as a question mark.
[[nodiscard]] int textWidth(const Face& face, std::string_view text);

/// Opaque picture of a text panel: 8-bit sRGB, three bytes per pixel, row by row, the top row first.
class Sheet {
public:
    Sheet(glm::ivec2 size /* [pixel] */, glm::u8vec3 colour);

    /// Fills a rectangle. The parts outside of the sheet are cut off, as in write().
    void fill(glm::ivec2 topLeft, glm::ivec2 size, glm::u8vec3 colour);
    /// Writes a text in UTF-8. `topLeft` is the corner of its line.
    void write(const Face& face, std::string_view text, glm::ivec2 topLeft, glm::u8vec3 colour);

    [[nodiscard]] glm::ivec2 size() const { return size_; }  // [pixel]
    [[nodiscard]] std::span<const std::uint8_t> rgb() const { return rgb_; }

private:
    void cover(glm::ivec2 at, unsigned coverage, glm::u8vec3 colour);

    glm::ivec2 size_;
    std::vector<std::uint8_t> rgb_;
};

}  // namespace render_node
