// SPDX-License-Identifier: Apache-2.0
#include "pictures/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace pictures {

Image::Image(int width_, int height_) : width(width_), height(height_) {
    if (width < 0 || height < 0 || std::int64_t{width} * height > kMaxPixels) {
        throw std::invalid_argument(fmt::format("no image of {}x{} pixels", width, height));
    }
    rgb.assign(pixels() * kChannels, 0);
}

void blit(Image& canvas, const Image& image, int x, int y) {
    const std::int64_t left = std::max<std::int64_t>(x, 0);
    const std::int64_t right = std::min<std::int64_t>(std::int64_t{x} + image.width, canvas.width);
    const std::int64_t top = std::max<std::int64_t>(y, 0);
    const std::int64_t bottom = std::min<std::int64_t>(std::int64_t{y} + image.height, canvas.height);
    if (left >= right) {
        return;
    }
    for (std::int64_t row = top; row < bottom; ++row) {
        const std::uint8_t* from = image.at(static_cast<int>(left - x), static_cast<int>(row - y));
        std::copy_n(from, (right - left) * kChannels, canvas.at(static_cast<int>(left), static_cast<int>(row)));
    }
}

Image assemble(int width, int height, std::span<const Placed> images) {
    Image canvas(width, height);
    for (const Placed& placed : images) {
        blit(canvas, *placed.image, placed.x, placed.y);
    }
    return canvas;
}

Image crop(const Image& image, int x, int y, int width, int height) {
    if (x < 0 || y < 0 || width < 0 || height < 0 || width > image.width - x || height > image.height - y) {
        throw std::invalid_argument(fmt::format("no crop of {}x{} at ({}, {}) from {}x{} pixels", width, height, x, y,
                                                image.width, image.height));
    }
    Image part(width, height);
    blit(part, image, -x, -y);
    return part;
}

Image shifted(const Image& image, int right, int down) {
    Image result(image.width, image.height);
    blit(result, image, right, down);
    return result;
}

}  // namespace pictures
