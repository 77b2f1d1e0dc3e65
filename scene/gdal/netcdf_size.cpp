// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "scene/gdal/claims.hpp"

namespace scene {
namespace {

constexpr std::uint64_t kMost = std::uint64_t{1} << 50U;  // of any number in a header that is not damaged

/// Reads the big-endian numbers of a header. After one that is missing or too large, good() is false.
class Header {
public:
    explicit Header(std::string_view bytes) : rest_(bytes) {}

    [[nodiscard]] bool good() const { return good_; }
    std::uint64_t number(std::size_t bytes) {
        std::uint64_t value = 0;
        for (const char byte : skip(bytes)) {
            value = value << 8U | static_cast<std::uint8_t>(byte);
        }
        good_ = good_ && value < kMost;
        return good_ ? value : 0;
    }
    std::string_view skip(std::uint64_t bytes) {
        good_ = good_ && bytes <= rest_.size();
        const std::string_view taken = rest_.substr(0, good_ ? bytes : 0);
        rest_.remove_prefix(taken.size());
        return taken;
    }

private:
    std::string_view rest_;
    bool good_ = true;
};

constexpr std::uint64_t padded(std::uint64_t bytes) { return (bytes + 3) / 4 * 4; }

std::uint64_t bytesOf(std::uint64_t type) {
    constexpr std::array<std::uint64_t, 12> kBytes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    return type < kBytes.size() ? kBytes.at(type) : 0;
}

/// The format of Unidata's manual, "NetCDF Classic Format Specification". Version 2 has long offsets, and version 5
/// long counts, too.
class Classic {
public:
    explicit Classic(std::string_view begin) : header_(begin) {
        const std::string_view magic = header_.skip(4);
        const int version = magic.size() == 4 ? magic[3] : 0;
        good_ = magic.starts_with("CDF") && (version == 1 || version == 2 || version == 5);
        count_ = version == 5 ? 8 : 4;
        offset_ = version == 1 ? 4 : 8;
    }

    [[nodiscard]] std::optional<std::uint64_t> size() {
        if (!good_) {
            return std::nullopt;
        }
        const std::uint64_t records = readRecords();
        readDimensions();
        skipAttributes();
        std::uint64_t end = 0;
        std::vector<Variable> growing;
        std::uint64_t recordSize = 0;
        for (std::uint64_t i = listLength(); i > 0 && header_.good(); --i) {
            const Variable variable = readVariable();
            if (variable.grows) {
                growing.push_back(variable);
                recordSize += padded(variable.bytes);
            } else {
                end = std::max(end, variable.begin + variable.bytes);
            }
        }
        // The records of a single variable are not padded.
        recordSize = growing.size() == 1 ? growing[0].bytes : recordSize;
        for (const Variable& variable : growing) {
            if (records > 0 && (recordSize == 0 || records < kMost / recordSize)) {
                end = std::max(end, variable.begin + (records - 1) * recordSize + variable.bytes);
            }
        }
        return header_.good() ? std::optional(end) : std::nullopt;
    }

private:
    struct Variable {
        bool grows = false;
        std::uint64_t bytes = 0, begin = 0;  // of one record if it grows
    };

    std::uint64_t readRecords() {
        // A file that is still being written has -1 as the number of its records.
        const std::string_view bytes = header_.skip(count_);
        const bool streaming = std::all_of(bytes.begin(), bytes.end(), [](char c) { return c == '\xFF'; });
        Header number(bytes);
        return streaming ? 0 : number.number(count_);
    }
    std::uint64_t listLength() {
        header_.skip(4);  // tag
        return header_.number(count_);
    }
    void skipName() { header_.skip(padded(header_.number(count_))); }
    void readDimensions() {
        for (std::uint64_t i = listLength(); i > 0 && header_.good(); --i) {
            skipName();
            sides_.push_back(header_.number(count_));
        }
    }
    void skipAttributes() {
        for (std::uint64_t i = listLength(); i > 0 && header_.good(); --i) {
            skipName();
            const std::uint64_t bytes = bytesOf(header_.number(4));
            const std::uint64_t count = header_.number(count_);
            header_.skip(padded(bytes * count));
        }
    }
    Variable readVariable() {
        Variable variable;
        skipName();
        std::uint64_t cells = 1;
        for (std::uint64_t i = header_.number(count_), first = i; i > 0 && header_.good(); --i) {
            const std::uint64_t number = header_.number(count_);
            const std::uint64_t side = number < sides_.size() ? sides_[number] : 0;
            if (side == 0 && i == first) {
                variable.grows = true;
            } else {
                cells = side > 0 && cells < kMost / side ? cells * side : 0;
            }
        }
        skipAttributes();
        variable.bytes = cells * bytesOf(header_.number(4));
        header_.skip(count_);  // the variable's size, which is wrong for large variables
        variable.begin = header_.number(offset_);
        return variable;
    }

    Header header_;
    bool good_ = false;
    std::size_t count_ = 4, offset_ = 4;  // bytes of a count and of an offset
    std::vector<std::uint64_t> sides_;
};

}  // namespace

std::optional<std::uint64_t> classicNetcdfSize(std::string_view begin) { return Classic(begin).size(); }

}  // namespace scene
