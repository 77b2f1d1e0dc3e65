// SPDX-License-Identifier: Apache-2.0
#include "render_node/overlay/letters.hpp"

#include <algorithm>

namespace render_node {
namespace {

/// Removes the first character from `text` and returns its code. Characters of one to three bytes are known, which the
/// font has; an invalid byte is a question mark.
unsigned takeCode(std::string_view& text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(text[i])); };
    const auto follows = [&](std::size_t i) { return i < text.size() && (byte(i) & 0xc0U) == 0x80; };
    const unsigned first = byte(0);
    std::size_t length = 1;
    unsigned code = first < 0x80 ? first : '?';
    if ((first & 0xe0U) == 0xc0 && follows(1)) {
        length = 2;
        code = (first & 0x1fU) << 6 | (byte(1) & 0x3fU);
    } else if ((first & 0xf0U) == 0xe0 && follows(1) && follows(2)) {
        length = 3;
        code = (first & 0x0fU) << 12 | (byte(1) & 0x3fU) << 6 | (byte(2) & 0x3fU);
    }
    text.remove_prefix(length);
    return code;
}

const Letter& letterOf(const Face& face, unsigned code) {
    const auto find = [&](unsigned wanted) {
        return std::ranges::find(face.letters, wanted, [](const Letter& letter) { return unsigned{letter.code}; });
    };
    const auto found = find(code);
    return found == face.letters.end() ? *find('?') : *found;
}

}  // namespace

const Face& faceFor(int size) {
    const std::span<const Face> all = faces();
    const Face* best = &all.front();
    for (const Face& face : all) {
        best = face.size <= size ? &face : best;
    }
    return *best;
}

int textWidth(const Face& face, std::string_view text) {
    int width = 0;
    while (!text.empty()) {
        width += letterOf(face, takeCode(text)).advance;
    }
    return width;
}

Sheet::Sheet(glm::ivec2 size, glm::u8vec3 colour)
    : size_(glm::max(size, glm::ivec2(0))),
      rgb_(3 * static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y)) {
    fill({0, 0}, size_, colour);
}

void Sheet::fill(glm::ivec2 topLeft, glm::ivec2 size, glm::u8vec3 colour) {
    const glm::ivec2 low = glm::clamp(topLeft, glm::ivec2(0), size_);
    const glm::ivec2 high = glm::clamp(topLeft + size, low, size_);
    for (int y = low.y; y < high.y; ++y) {
        std::uint8_t* pixel = rgb_.data() + 3 * (static_cast<std::ptrdiff_t>(y) * size_.x + low.x);
        for (int x = low.x; x < high.x; ++x) {
            for (int channel = 0; channel < 3; ++channel) {
                *pixel++ = colour[channel];
            }
        }
    }
}

void Sheet::write(const Face& face, std::string_view text, glm::ivec2 topLeft, glm::u8vec3 colour) {
    glm::ivec2 pen = topLeft + glm::ivec2(0, face.ascent);
    while (!text.empty()) {
        const Letter& letter = letterOf(face, takeCode(text));
        const std::uint8_t* covered = face.coverage.data() + letter.begin;
        for (int y = 0; y < letter.height; ++y) {
            for (int x = 0; x < letter.width; ++x) {
                cover(pen + glm::ivec2(letter.left + x, letter.top + y), *covered++, colour);
            }
        }
        pen.x += letter.advance;
    }
}

/// Mixes a pixel with `colour`. `coverage` is from 0 to 255.
void Sheet::cover(glm::ivec2 at, unsigned coverage, glm::u8vec3 colour) {
    if (at.x < 0 || at.y < 0 || at.x >= size_.x || at.y >= size_.y) {
        return;
    }
    const std::size_t pixel =
        3 * (static_cast<std::size_t>(at.y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(at.x));
    for (int channel = 0; channel < 3; ++channel) {
        std::uint8_t& value = rgb_[pixel + static_cast<std::size_t>(channel)];
        const unsigned mixed = unsigned{value} * (255 - coverage) + unsigned{colour[channel]} * coverage;
        value = static_cast<std::uint8_t>((mixed + 127) / 255);
    }
}

}  // namespace render_node
