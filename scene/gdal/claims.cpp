// SPDX-License-Identifier: Apache-2.0
#include "scene/gdal/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "base/text.hpp"
#include "base/text_reader.hpp"

namespace scene {
namespace {

namespace fs = std::filesystem;

/// Returns the value behind `key` in a header whose lines are "key value" or "key = value", in small letters.
std::optional<std::string> valueIn(const fs::path& header, std::string_view key) {
    std::ifstream stream(header, std::ios::binary);
    base::TextReader lines(stream, header.string());
    for (std::string_view line; lines.nextLine(line);) {
        std::string lower = base::lowerCase(base::trimmed(line));
        if (lower.starts_with(key)) {
            std::string_view rest = base::trimmed(std::string_view(lower).substr(key.size()));
            rest.remove_prefix(rest.starts_with('=') ? 1 : 0);
            return std::string(base::trimmed(rest));
        }
    }
    return std::nullopt;
}

std::optional<fs::path> fileWithEnding(const std::vector<fs::path>& files, std::string_view ending) {
    const auto found =
        std::find_if(files.begin(), files.end(), [&](const fs::path& file) { return base::endingOf(file) == ending; });
    return found == files.end() ? std::nullopt : std::optional(*found);
}

/// Refuses an EHdr raster whose header does not say how many bits a number has, unless they are what ESRI's manual says
/// for its ending. GDAL divides the size of the file by the number of cells.
void checkBits(const GdalRaster& raster, const fs::path& data, const fs::path& header) {
    if (valueIn(header, "nbits")) {
        return;
    }
    const bool floats = base::endingOf(data) == ".flt";
    const int usual = floats ? 32 : 8;
    const int bits = GDALGetDataTypeSizeBits(GDALGetRasterDataType(raster.band()));
    if (bits != usual) {
        raster.fail(fmt::format("{} x {} cells of {} bits, which is usual for {}, do not fit its {} bytes; {}",
                                raster.columns(), raster.rows(), usual, base::endingOf(data), fs::file_size(data),
                                floats ? "the file may be cut; copy it again"
                                       : "the file may be cut, or its header needs a line such as NBITS 16"));
    }
}

void checkSize(const GdalRaster& raster, std::uintmax_t bytes, std::uint64_t needed, bool alone) {
    if (bytes < needed) {
        raster.fail(fmt::format("its header says that it has {} bytes, but it has {}; the file is cut; copy it again",
                                needed, bytes));
    }
    // Without a header inside, a whole number of times the cells means numbers of another type, or other sides.
    if (alone && needed > 0 && bytes >= 2 * needed && bytes % needed == 0) {
        raster.fail(
            fmt::format("it has {} times the bytes that its header says ({}); correct the type of numbers, the "
                        "columns or the rows in the header",
                        bytes / needed, needed));
    }
}

std::uint64_t cellBytes(const GdalRaster& raster) {
    const int bits = GDALGetDataTypeSizeBits(GDALGetRasterDataType(raster.band()));
    return static_cast<std::uint64_t>(raster.columns()) * static_cast<std::uint64_t>(raster.rows()) *
           static_cast<std::uint64_t>(GDALGetRasterCount(raster.dataset())) * static_cast<std::uint64_t>(bits) / 8;
}

/// Returns the number behind `key` in a header as bytes or bits, or `missing` without a number that a file can have.
std::uint64_t countIn(const fs::path& header, std::string_view key, std::uint64_t missing) {
    const double number = base::numberOf(valueIn(header, key).value_or("")).value_or(-1);
    return number >= 0 && number <= 1e15 ? static_cast<std::uint64_t>(number) : missing;
}

/// Refuses an EHdr raster whose file ends before its last row. Rows may have padding, and numbers less than a byte.
/// GDAL 3.10 reads zeros behind the end.
void checkRows(const GdalRaster& raster, std::uintmax_t bytes, const fs::path& header) {
    const auto columns = static_cast<std::uint64_t>(raster.columns()), rows = static_cast<std::uint64_t>(raster.rows());
    const auto bands = static_cast<std::uint64_t>(GDALGetRasterCount(raster.dataset()));
    const int bits = GDALGetDataTypeSizeBits(GDALGetRasterDataType(raster.band()));
    const std::uint64_t row = (columns * countIn(header, "nbits", static_cast<std::uint64_t>(bits)) + 7) / 8;
    const std::uint64_t step = std::max(countIn(header, "totalrowbytes", 0), countIn(header, "bandrowbytes", row));
    const std::uint64_t skipped = countIn(header, "skipbytes", 0);
    const std::uint64_t needed = skipped + std::max(row * rows * bands, step * (rows - 1) + row);
    const bool padded = step != row || valueIn(header, "bandgapbytes").has_value();
    checkSize(raster, bytes, needed, skipped == 0 && !padded);
}

std::string beginOf(const fs::path& file) {
    constexpr std::size_t kMostHeader = 1 << 20;  // [byte]
    std::string begin(kMostHeader, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.resize(static_cast<std::size_t>(stream.gcount()));
    return begin;
}

void checkSizes(const GdalRaster& raster, const std::vector<fs::path>& files) {
    const std::string driver = raster.driver();
    const fs::path data = raster.name();
    const std::uintmax_t bytes = fs::file_size(data);
    constexpr std::uint64_t kPcrasterHeader = 256;
    if (driver == "EHdr") {
        if (const std::optional<fs::path> header = fileWithEnding(files, ".hdr")) {
            checkBits(raster, data, *header);
            checkRows(raster, bytes, *header);
        }
    } else if (driver == "ENVI") {
        const std::optional<fs::path> header = fileWithEnding(files, ".hdr");
        const std::optional<std::string> offset = header ? valueIn(*header, "header offset") : std::nullopt;
        const double skipped = base::numberOf(offset.value_or("0")).value_or(0);
        const auto behind = static_cast<std::uint64_t>(std::clamp(skipped, 0.0, 1e15));
        if (!header || valueIn(*header, "file compression").value_or("0") == "0") {
            checkSize(raster, bytes, behind + cellBytes(raster), behind == 0);
        }
    } else if (driver == "ERS") {
        const fs::path cells = fs::path(data).replace_extension();
        if (std::error_code none; fs::is_regular_file(cells, none)) {
            checkSize(raster, fs::file_size(cells), countIn(data, "headeroffset", 0) + cellBytes(raster), false);
        }
    } else if (driver == "RST" || driver == "SAGA" || driver == "ROI_PAC") {
        checkSize(raster, bytes, cellBytes(raster), true);
    } else if (driver == "PCRaster") {
        checkSize(raster, bytes, kPcrasterHeader + cellBytes(raster), false);
    } else if (driver == "netCDF") {
        if (const std::optional<std::uint64_t> size = classicNetcdfSize(beginOf(data))) {
            checkSize(raster, bytes, *size, false);
        }
    }
}

/// Returns whether a file beside the raster is a text of keys and numbers. A comma may separate numbers in others.
bool isHeaderOfNumbers(const fs::path& file, const std::string& driver) {
    const std::string ending = base::endingOf(file);
    const bool world = ending == ".wld" || (ending.size() == 4 && ending.back() == 'w');
    return world || (ending == ".hdr" && driver != "ENVI") || ending == ".rdc" || ending == ".sgrd" ||
           ending == ".rsc" || ending == ".ers";
}

void checkDecimalSigns(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    base::TextReader words(stream, file.string());
    for (std::string word(words.nextWord()); !word.empty(); word = words.nextWord()) {
        if (base::commaNumberOf(word)) {
            words.fail(fmt::format("'{}' has a decimal comma; write a decimal point", word));
        }
    }
}

/// Refuses a Surfer text with other words than numbers, or more or fewer than its header says. GDAL 3.6.2 takes "1,5"
/// for two numbers, and all others move.
void checkSurferText(const GdalRaster& raster) {
    std::ifstream stream(raster.name(), std::ios::binary);
    base::TextReader words(stream, raster.name());
    (void)words.nextWord();  // DSAA
    constexpr std::uint64_t kHeader = 8;
    const std::uint64_t cells =
        static_cast<std::uint64_t>(raster.columns()) * static_cast<std::uint64_t>(raster.rows());
    std::uint64_t count = 0;
    for (std::string word(words.nextWord()); !word.empty(); word = words.nextWord(), ++count) {
        if (base::numberOf(word) || base::spellsNan(word)) {
            continue;
        }
        words.fail(base::commaNumberOf(word) ? fmt::format("'{}' has a decimal comma; write a decimal point", word)
                                             : fmt::format("expected a number, got '{}'", word));
    }
    if (count != kHeader + cells) {
        raster.fail(
            fmt::format("its header says that {} x {} = {} numbers follow, but there are {}; the file may be cut",
                        raster.columns(), raster.rows(), cells, count < kHeader ? 0 : count - kHeader));
    }
}

}  // namespace

std::optional<std::string> lengthUnitInHeader(const GdalRaster& raster) {
    const bool idrisi = raster.driver() == "RST";
    if (!idrisi && raster.driver() != "ENVI") {
        return std::nullopt;
    }
    const std::optional<fs::path> header = fileWithEnding(raster.files(), idrisi ? ".rdc" : ".hdr");
    if (!header) {
        return std::nullopt;
    }
    if (!idrisi) {
        const std::string map = valueIn(*header, "map info").value_or("");
        constexpr std::string_view kUnits = "units=";
        const std::size_t at = map.find(kUnits);
        const std::string_view rest = at == std::string::npos ? "" : std::string_view(map).substr(at + kUnits.size());
        const std::string unit(base::trimmed(rest.substr(0, rest.find_first_of(",}"))));
        return unit.empty() ? std::nullopt : std::optional(unit);
    }
    const auto value = [&](std::string_view key) {
        const std::string text = valueIn(*header, key).value_or("");
        return std::string(base::trimmed(text.substr(std::min(text.find_first_not_of(": "), text.size()))));
    };
    const std::string scale = value("unit dist.");
    if (!scale.empty() && base::numberOf(scale) != 1.0) {
        throw base::InputError(fmt::format(
            "{}: its unit of lengths is {} times '{}' (unit dist.); write its coordinates with unit dist. 1",
            header->string(), scale, value("ref. units")));
    }
    const std::string unit = value("ref. units");
    return unit.empty() ? std::nullopt : std::optional(unit);
}

std::string missingHeader(const fs::path& file) {
    constexpr std::array<std::string_view, 4> kRaw{".flt", ".bil", ".bip", ".bsq"};
    if (std::find(kRaw.begin(), kRaw.end(), base::endingOf(file)) == kRaw.end()) {
        return "";
    }
    std::error_code none;
    fs::path header = fs::path(file).replace_extension(".HDR");
    if (!fs::is_regular_file(header, none)) {
        header.replace_extension(".hdr");
    }
    const std::string name = header.filename().string();
    if (!fs::is_regular_file(header, none)) {
        return "; it needs its header " + name + " beside it";
    }
    for (const char* key : {"ncols", "nrows"}) {
        if (!valueIn(header, key) && !valueIn(header, "envi")) {
            return fmt::format("; its header {} has no {}", name, key);
        }
    }
    return "";
}

void checkClaims(const GdalRaster& raster) {
    const std::vector<fs::path> files = raster.files();
    checkSizes(raster, files);
    for (const fs::path& file : files) {
        if (file != files.front() && isHeaderOfNumbers(file, raster.driver())) {
            checkDecimalSigns(file);
        }
    }
    if (raster.driver() == "GSAG") {
        checkSurferText(raster);
    }
}

}  // namespace scene
