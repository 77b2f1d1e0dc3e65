// SPDX-License-Identifier: Apache-2.0
#include "scene/gdal/png_greys.hpp"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "base/input_error.hpp"

namespace scene {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
};

/// Reader of libpng. After an error, libpng jumps back to the member function that was called last. That function must
/// have no objects with destructors.
class PngReader {
public:
    PngReader() {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, complaint_.data(), keep, ignore);
        info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    /// Reads everything before the pixels. Numbers of less than 8 bits will take one byte each.
    [[nodiscard]] bool readHeader(std::FILE* file) {
        if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_init_io(png_, file);
        png_read_info(png_, info_);
        png_set_packing(png_);
        (void)png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }
    /// Reads all pixels into rows of rowBytes().
    [[nodiscard]] bool readRows(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_read_image(png_, rows);
        return true;
    }
    /// Reads the next row of a picture that is not interlaced.
    [[nodiscard]] bool readRow(png_bytep row) {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_read_row(png_, row, nullptr);
        return true;
    }
    /// Reads what follows the pixels.
    [[nodiscard]] bool readEnd() {
        if (setjmp(png_jmpbuf(png_)) != 0) {
            return false;
        }
        png_read_end(png_, nullptr);
        return true;
    }
    [[nodiscard]] bool isInterlaced() const { return png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE; }
    [[nodiscard]] bool isGrey() const { return (png_get_color_type(png_, info_) & PNG_COLOR_MASK_COLOR) == 0; }
    [[nodiscard]] int columns() const { return static_cast<int>(png_get_image_width(png_, info_)); }
    [[nodiscard]] int rows() const { return static_cast<int>(png_get_image_height(png_, info_)); }
    [[nodiscard]] std::size_t channels() const { return png_get_channels(png_, info_); }
    [[nodiscard]] std::size_t numberBytes() const { return png_get_bit_depth(png_, info_) == 16 ? 2 : 1; }
    [[nodiscard]] std::size_t rowBytes() const { return png_get_rowbytes(png_, info_); }
    [[nodiscard]] std::string complaint() const { return complaint_.data(); }

private:
    using Text = std::array<char, 128>;

    static void keep(png_structp png, png_const_charp message) {
        auto* const text = static_cast<char*>(png_get_error_ptr(png));
        std::strncpy(text, message, Text().size() - 1);
        png_longjmp(png, 1);
    }
    static void ignore(png_structp /*png*/, png_const_charp /*message*/) {}

    Text complaint_{};
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

}  // namespace

void readGreysOfPng(const std::string& file, int columns, int rows,
                    const std::function<void(int row, std::span<double> greys)>& take) {
    const std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(file.c_str(), "rb"));
    if (!stream) {
        throw base::InputError(file + ": cannot be read; check the path");
    }
    PngReader png;
    if (!png.readHeader(stream.get())) {
        throw base::InputError(file + ": cannot be read as PNG: " + png.complaint());
    }
    if (!png.isGrey() || png.columns() != columns || png.rows() != rows) {
        throw base::InputError(file + ": has changed since it was opened; it must be a grey picture of the same size");
    }
    const auto readable = [&](bool read) {
        if (!read) {
            throw base::InputError(file + ": its pixels cannot be read: " + png.complaint());
        }
    };
    const auto height = static_cast<std::size_t>(rows);
    std::vector<png_byte> bytes(png.rowBytes() * (png.isInterlaced() ? height : 1));
    if (png.isInterlaced()) {
        std::vector<png_bytep> starts;
        for (std::size_t row = 0; row < height; ++row) {
            starts.push_back(bytes.data() + row * png.rowBytes());
        }
        readable(png.readRows(starts.data()));
    }
    std::vector<double> greys(static_cast<std::size_t>(columns));
    const std::size_t size = png.numberBytes(), step = size * png.channels();
    for (int row = 0; row < rows; ++row) {
        const png_byte* from = bytes.data();
        if (png.isInterlaced()) {
            from += static_cast<std::size_t>(row) * png.rowBytes();
        } else {
            readable(png.readRow(bytes.data()));
        }
        for (double& grey : greys) {
            grey = size == 1 ? from[0] : from[0] * 256 + from[1];  // the first byte is the higher one
            from += step;
        }
        take(row, greys);
    }
    readable(png.readEnd());
}

}  // namespace scene
