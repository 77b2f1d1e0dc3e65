// SPDX-License-Identifier: Apache-2.0
#include "pictures/png_file.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "base/input_error.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/blocked_child.hpp"
#include "tests/support/seed.hpp"

namespace pictures {
namespace {

namespace fs = std::filesystem;

class PngFile : public test::FolderTest {
protected:
    void store(const std::vector<char>& bytes) const {
        std::ofstream(file_, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    [[nodiscard]] std::vector<char> bytes() const {
        std::ifstream stream(file_, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    /// Returns the error about the file. It must name the file and be one line.
    [[nodiscard]] std::string complaint() const {
        try {
            (void)readPng(file_);
        } catch (const base::InputError& error) {
            std::string line = error.what();
            EXPECT_EQ(line.rfind(file_.string() + ":", 0), 0U) << line;
            EXPECT_EQ(line.find('\n'), std::string::npos) << line;
            return line;
        }
        ADD_FAILURE() << "was read";
        return {};
    }

    const fs::path file_ = folder_ / "picture.png";
};

Image noise(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    Image image(width, height);
    std::generate(image.rgb.begin(), image.rgb.end(), [&] { return static_cast<std::uint8_t>(random()); });
    return image;
}

void putBigEndian(std::vector<char>& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) {
        bytes.at(at + i) = static_cast<char>(value >> (24 - 8 * i));
    }
}

/// Writes another size into a PNG's header, and corrects the header's checksum.
void claimSize(std::vector<char>& bytes, std::uint32_t width, std::uint32_t height) {
    putBigEndian(bytes, 16, width);
    putBigEndian(bytes, 20, height);
    std::uint32_t crc = 0xffffffff;
    for (std::size_t i = 12; i < 29; ++i) {
        crc ^= static_cast<std::uint8_t>(bytes.at(i));
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320U : 0U);
        }
    }
    putBigEndian(bytes, 29, ~crc);
}

TEST_F(PngFile, GivesBackEveryPixelItWasGiven) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 37}, {53, 1}, {64, 48}}) {
        const Image image = noise(width, height, seed);
        writePng(file_, image);
        EXPECT_EQ(readPng(file_), image) << width << "x" << height;
    }
}

TEST_F(PngFile, LaysTransparencyOverBlack) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = 2;
    png.height = 1;
    png.format = PNG_FORMAT_RGBA;
    const std::array<std::uint8_t, 8> pixels{200, 100, 50, 255, 200, 100, 50, 0};
    ASSERT_NE(png_image_write_to_file(&png, file_.c_str(), 0, pixels.data(), 0, nullptr), 0);
    EXPECT_EQ(readPng(file_).rgb, (std::vector<std::uint8_t>{200, 100, 50, 0, 0, 0}));
}

TEST_F(PngFile, RefusesWhatIsNoPng) {
    EXPECT_NE(complaint().find("check the path"), std::string::npos);
    store({});
    (void)complaint();
    store({'P', '6', ' ', '1', ' ', '1'});
    (void)complaint();
    fs::remove(file_);
    fs::create_directory(file_);
    EXPECT_NE(complaint().find("check the path"), std::string::npos);
}

TEST_F(PngFile, RefusesAPictureCutShortAnywhere) {
    writePng(file_, noise(20, 20, 1));
    const std::vector<char> whole = bytes();
    // The last chunk has no pixels, and libpng does not need it.
    for (std::size_t size = 0; size < whole.size() - 16; size += 13) {
        store({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
        (void)complaint();
    }
}

TEST_F(PngFile, RefusesSizesItsBytesCannotHold) {
    writePng(file_, noise(4, 4, 1));
    std::vector<char> bomb = bytes();
    claimSize(bomb, 16000, 16000);
    store(bomb);
    EXPECT_NE(complaint().find("16000x16000"), std::string::npos);
    claimSize(bomb, 900000, 900000);
    store(bomb);
    EXPECT_NE(complaint().find("900000x900000"), std::string::npos);
    claimSize(bomb, 4, 4);
    store(bomb);
    EXPECT_EQ(readPng(file_), noise(4, 4, 1)) << "the patched header itself must be sound";
}

TEST_F(PngFile, SurvivesDamagedBytes) {
    const unsigned seed = test::randomSeed();
    SCOPED_TRACE(test::again(seed));
    std::mt19937 random(seed);
    writePng(file_, noise(16, 16, 1));
    const std::vector<char> whole = bytes();
    for (int round = 0; round < 300; ++round) {
        std::vector<char> damaged = whole;
        char& byte = damaged[random() % damaged.size()];
        byte = static_cast<char>(byte ^ (1 << random() % 8));
        store(damaged);
        try {
            EXPECT_LE(readPng(file_).pixels(), static_cast<std::size_t>(kMaxPixels));
        } catch (const base::InputError&) {
        }
    }
}

TEST_F(PngFile, NamesThePictureItCannotWrite) {
    const fs::path nowhere = folder_ / "no" / "such.png";
    try {
        writePng(nowhere, Image(2, 2));
        FAIL() << "was written";
    } catch (const base::InputError& error) {
        EXPECT_EQ(std::string(error.what()).rfind(nowhere.string() + ":", 0), 0U) << error.what();
    }
}

TEST_F(PngFile, NeverReplacesAPipeOrALink) {
    support::makePipe(file_);
    EXPECT_TRUE(support::endsByItself([this] { EXPECT_THROW(writePng(file_, Image(2, 2)), base::InputError); }));
    EXPECT_TRUE(fs::is_fifo(file_));
    fs::remove(file_);
    std::ofstream(folder_ / "other") << "of another program";
    fs::create_symlink(folder_ / "other", file_);
    EXPECT_THROW(writePng(file_, Image(2, 2)), base::InputError);
    EXPECT_EQ(fs::file_size(folder_ / "other"), 18U);
    fs::remove(file_);
    std::ofstream(file_) << "old";
    writePng(file_, Image(2, 2));
    EXPECT_EQ(readPng(file_).width, 2);
}

}  // namespace
}  // namespace pictures
