// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Pictures of the wall as plain pixels. Any thread may use them if each image has only one writer.
namespace pictures {

inline constexpr int kChannels = 3;
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;  // largest number of pixels of one image: 0.8 GB

/// Image in sRGB with 8 bits each for red, green and blue. Row 0 is the top. Rows follow without padding.
struct Image {
    int width = 0, height = 0;      // [pixel]
    std::vector<std::uint8_t> rgb;  // width * height * kChannels

    Image() = default;
    /// Makes a black image. Throws std::invalid_argument if a side is negative or if there are more than kMaxPixels.
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

/// Image, and the place of its top left pixel.
struct Placed {
    const Image* image = nullptr;
    int x = 0, y = 0;
};

/// Copies `image` to `canvas`. Pixels outside the canvas are left out.
void blit(Image& canvas, const Image& image, int x, int y);
/// Returns a black canvas with the images on it, in their order.
[[nodiscard]] Image assemble(int width, int height, std::span<const Placed> images);
/// Returns a part of an image. Throws std::invalid_argument if the rectangle is not inside the image.
[[nodiscard]] Image crop(const Image& image, int x, int y, int width, int height);
/// Returns the image moved by whole pixels: right and down for positive numbers. The freed rim is black.
[[nodiscard]] Image shifted(const Image& image, int right, int down);

}  // namespace pictures
