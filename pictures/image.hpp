// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Pictures of the wall: plain pixels, safe from any thread as long as each image has one writer.
namespace pictures {

inline constexpr int kChannels = 3;
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;  // of one image: 0.8 GB

/// Red, green, blue, 8 bits each, sRGB; row 0 is the top, rows follow without padding.
struct Image {
    int width = 0, height = 0;      // [pixel]
    std::vector<std::uint8_t> rgb;  // width * height * kChannels

    Image() = default;
    /// Black. Throws std::invalid_argument when a side is negative or there are more than kMaxPixels.
    Image(int width, int height);

    [[nodiscard]] std::size_t pixels() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    [[nodiscard]] std::uint8_t* at(int x, int y) { return rgb.data() + offset(x, y); }
    [[nodiscard]] const std::uint8_t* at(int x, int y) const { return rgb.data() + offset(x, y); }
    friend bool operator==(const Image&, const Image&) = default;

private:
    [[nodiscard]] std::size_t offset(int x, int y) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               kChannels;
    }
};

/// An image and where its top left pixel goes.
struct Placed {
    const Image* image = nullptr;
    int x = 0, y = 0;
};

/// Copies `image` onto `canvas`; what falls outside is left out.
void blit(Image& canvas, const Image& image, int x, int y);
/// A black canvas with the images on it, in their order.
[[nodiscard]] Image assemble(int width, int height, std::span<const Placed> images);
/// A part of an image. Throws std::invalid_argument when the rectangle does not lie inside.
[[nodiscard]] Image crop(const Image& image, int x, int y, int width, int height);
/// The image moved by whole pixels, right and down for positive numbers; the freed rim is black.
[[nodiscard]] Image shifted(const Image& image, int right, int down);

}  // namespace pictures
