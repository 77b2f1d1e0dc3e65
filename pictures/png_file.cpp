// SPDX-License-Identifier: Apache-2.0
#include "pictures/png_file.hpp"

#include <fmt/format.h>
#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "base/input_error.hpp"
#include "host/regular_file.hpp"

namespace pictures {
namespace {

/// Owner of a libpng image. libpng's simplified interface reports errors by return value, so that no jump skips a
/// destructor.
class PngImage {
public:
    PngImage() { image.version = PNG_IMAGE_VERSION; }
    ~PngImage() { png_image_free(&image); }
    PngImage(const PngImage&) = delete;
    PngImage& operator=(const PngImage&) = delete;
    png_image image{};
};

std::uintmax_t sizeOfFile(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) {
        throw base::InputError(fmt::format("{}: no such picture; check the path", file.string()));
    }
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) {
        throw base::InputError(fmt::format("{}: {}", file.string(), error.message()));
    }
    return size;
}

}  // namespace

Image readPng(const std::filesystem::path& file) {
    // Deflate compresses at most 1032 to 1, and a pixel of a PNG takes at least one bit.
    constexpr std::uintmax_t kMostPixelsPerByte = 1032 * 8;
    const std::uintmax_t bytes = sizeOfFile(file);
    PngImage png;
    if (png_image_begin_read_from_file(&png.image, file.c_str()) == 0) {
        throw base::InputError(fmt::format("{}: cannot be read as PNG: {}", file.string(), png.image.message));
    }
    const std::uintmax_t pixels = std::uintmax_t{png.image.width} * png.image.height;
    if (pixels > static_cast<std::uintmax_t>(kMaxPixels) || pixels / kMostPixelsPerByte > bytes) {
        throw base::InputError(fmt::format(
            "{}: claims {}x{} pixels, which is more than {}", file.string(), png.image.width, png.image.height,
            pixels > static_cast<std::uintmax_t>(kMaxPixels) ? fmt::format("the {} we read", kMaxPixels)
                                                             : fmt::format("its {} bytes can hold", bytes)));
    }
    png.image.format = PNG_FORMAT_RGB;
    Image image(static_cast<int>(png.image.width), static_cast<int>(png.image.height));
    const png_color black{0, 0, 0};
    if (png_image_finish_read(&png.image, &black, image.rgb.data(), 0, nullptr) == 0) {
        throw base::InputError(fmt::format("{}: is a damaged PNG: {}", file.string(), png.image.message));
    }
    return image;
}

void writePng(const std::filesystem::path& file, const Image& image) {
    PngImage png;
    png.image.width = static_cast<png_uint_32>(image.width);
    png.image.height = static_cast<png_uint_32>(image.height);
    png.image.format = PNG_FORMAT_RGB;
    const auto refuse = [&file](const char* why) {
        throw base::InputError(fmt::format("{}: picture cannot be written: {}", file.string(), why));
    };
    if (const std::string special = host::whyNotReplaceable(file); !special.empty()) {
        refuse(special.c_str());
    }
    const int made = host::makeFile(file);
    std::FILE* const stream = made < 0 ? nullptr : fdopen(made, "wb");
    if (stream == nullptr) {
        refuse(std::strerror(errno));
    }
    const bool written = png_image_write_to_stdio(&png.image, stream, 0, image.rgb.data(), 0, nullptr) != 0;
    if (std::fclose(stream) != 0 || !written) {
        std::error_code none;
        std::filesystem::remove(file, none);
        refuse(written ? std::strerror(errno) : png.image.message);
    }
}

}  // namespace pictures
