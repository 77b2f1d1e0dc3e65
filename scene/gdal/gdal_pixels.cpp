// SPDX-License-Identifier: Apache-2.0
#include "scene/gdal/gdal_pixels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "scene/gdal/png_greys.hpp"

namespace scene {
namespace {

constexpr int kStripePixels = 1 << 20;  // 9 MiB as doubles with their mask

// Weights of red, green and blue in the brightness of ITU-R BT.709, times 10,000. They are whole, so that white is
// exactly the largest number.
constexpr std::array kWeights{2126.0, 7152.0, 722.0};
constexpr double kWeightOfWhite = 10000;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

class PixelReader {
public:
    PixelReader(const GdalRaster& raster, const RasterCheck& check)
        : raster_(raster),
          check_(check),
          isPng_(raster.isPng() && !raster.isColoured()),
          heights_(raster.numberSize()) {
        const int flags = GDALGetMaskFlags(raster.band());
        const bool coloured = raster.isColoured();
        if ((!coloured && raster.isSignedByte()) || (isPng_ && (flags & GMF_NODATA) != 0)) {
            // GDAL's mask would compare the number without its sign, or a transparent grey as GDAL has read it.
            int declared = 0;
            const double noData = GDALGetRasterNoDataValue(raster.band(), &declared);
            noData_ = declared == 0 ? std::nullopt : std::optional(noData);
        }
        // The number that means no data belongs to one colour. A photo whose brightness counts has data everywhere.
        if (!noData_ && (flags & GMF_ALL_VALID) == 0 && !(coloured && (flags & GMF_NODATA) != 0)) {
            mask_ = GDALGetMaskBand(raster.band());
        }
        int blockColumns = 1;
        GDALGetBlockSize(raster.band(), &blockColumns, &blockRows_);
        heights_.reserve(static_cast<std::size_t>(raster.columns()) * static_cast<std::size_t>(raster.rows()));
    }

    [[nodiscard]] RasterHeights read() {
        if (isPng_) {
            readGreysOfPng(raster_.name(), raster_.columns(), raster_.rows(),
                           [this](int row, std::span<double> greys) { take(row, greys); });
        } else {
            readStripes();
        }
        return std::move(heights_);
    }

private:
    void readStripes() {
        const bool signedBytes = !raster_.isColoured() && raster_.isSignedByte();
        std::vector<double> numbers;
        for (int row = 0, end = 0; row < raster_.rows(); row = end) {
            end = endOfStripe(row);
            numbers.resize(static_cast<std::size_t>(end - row) * static_cast<std::size_t>(raster_.columns()));
            if (raster_.isColoured()) {
                readBrightness(row, end, numbers);
            } else {
                readBand(raster_.band(), row, end, numbers);
            }
            if (signedBytes) {
                for (double& number : numbers) {
                    number -= number > 127 ? 256 : 0;
                }
            }
            take(row, numbers);
            if (end % blockRows_ == 0) {
                dropBlocks();
            }
        }
    }

    /// Reads the numbers of rows [row, end) of a band.
    void readBand(GDALRasterBandH band, int row, int end, std::vector<double>& numbers) const {
        if (GDALRasterIO(band, GF_Read, 0, row, raster_.columns(), end - row, numbers.data(), raster_.columns(),
                         end - row, GDT_Float64, 0, 0) != CE_None) {
            raster_.failToRead();
        }
    }

    void readBrightness(int row, int end, std::vector<double>& numbers) const {
        std::vector<double> one(numbers.size());
        std::fill(numbers.begin(), numbers.end(), 0.0);
        for (std::size_t colour = 0; colour < kWeights.size(); ++colour) {
            readBand(GDALGetRasterBand(raster_.dataset(), static_cast<int>(colour) + 1), row, end, one);
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                numbers[i] += kWeights[colour] * one[i];
            }
        }
        for (double& number : numbers) {
            number /= kWeightOfWhite;
        }
    }

    /// Returns the row behind the stripe that begins in `row`. A stripe ends between two rows of blocks, so that no
    /// block is read twice. Blocks that are higher than a stripe are kept by GDAL for the next one.
    [[nodiscard]] int endOfStripe(int row) const {
        const int most = std::min(row + std::max(kStripePixels / raster_.columns(), 1), raster_.rows());
        const int whole = most / blockRows_ * blockRows_;
        return whole > row ? whole : most;
    }

    /// Frees the blocks that GDAL has read. Its cache may otherwise hold the whole raster.
    void dropBlocks() const {
        (void)GDALFlushRasterCache(raster_.band());
        for (int colour = 1; raster_.isColoured() && colour < static_cast<int>(kWeights.size()); ++colour) {
            (void)GDALFlushRasterCache(GDALGetRasterBand(raster_.dataset(), colour + 1));
        }
        if (mask_ != nullptr) {
            (void)GDALFlushRasterCache(mask_);
        }
    }

    /// Adds whole rows of numbers from `row` on.
    void take(int row, std::span<double> numbers) {
        const auto columns = static_cast<std::size_t>(raster_.columns());
        const int count = static_cast<int>(numbers.size() / columns);
        mask(row, count, numbers);
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            if (const double height = raster_.heightOf(numbers[i]); std::isinf(height)) {
                raster_.fail(
                    fmt::format("the height of pixel {}, {} (from the north-west) is infinite; mask it: gdal_translate "
                                "-a_nodata {}",
                                i % columns + 1, static_cast<std::size_t>(row) + i / columns + 1, height));
            }
            heights_.add(numbers[i]);
        }
        check_.read(static_cast<double>(row + count) / raster_.rows());
    }

    void mask(int row, int count, std::span<double> numbers) {
        if (noData_) {
            std::replace(numbers.begin(), numbers.end(), *noData_, kNoNumber);
        }
        if (mask_ == nullptr) {
            return;
        }
        known_.resize(numbers.size());
        if (GDALRasterIO(mask_, GF_Read, 0, row, raster_.columns(), count, known_.data(), raster_.columns(), count,
                         GDT_Byte, 0, 0) != CE_None) {
            raster_.failToRead();
        }
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            if (known_[i] == 0) {
                numbers[i] = kNoNumber;
            }
        }
    }

    const GdalRaster& raster_;
    const RasterCheck& check_;
    bool isPng_;
    std::optional<double> noData_;    // number that means no data, if GDAL's mask does not know it
    GDALRasterBandH mask_ = nullptr;  // null if GDAL masks no pixel
    int blockRows_ = 1;
    std::vector<unsigned char> known_;  // mask of a stripe
    RasterHeights heights_;
};

}  // namespace

RasterHeights numbersOf(const GdalRaster& raster, const RasterCheck& check) {
    return PixelReader(raster, check).read();
}

}  // namespace scene
