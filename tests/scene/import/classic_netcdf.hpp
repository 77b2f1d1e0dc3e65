// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace test {

/// A variable of a NetCDF file: doubles along the named dimensions, with attributes that are texts.
struct NetcdfVariable {
    std::string name;
    std::vector<std::string> along;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::vector<double> values;
};

/// Returns a NetCDF file of the classic format (version 1), as Unidata's specification describes it.
class ClassicNetcdf {
public:
    explicit ClassicNetcdf(std::vector<std::pair<std::string, int>> sides) : sides_(std::move(sides)) {}
    void add(NetcdfVariable variable) { variables_.push_back(std::move(variable)); }

    [[nodiscard]] std::string bytes() const {
        std::uint32_t begin = static_cast<std::uint32_t>(head(0).size());
        std::string file = head(begin);
        for (const NetcdfVariable& variable : variables_) {
            for (const double value : variable.values) {
                const auto bits = std::bit_cast<std::uint64_t>(value);
                put(static_cast<std::uint32_t>(bits >> 32U), file);
                put(static_cast<std::uint32_t>(bits), file);
            }
        }
        return file;
    }

private:
    static void put(std::uint32_t number, std::string& to) {
        for (const unsigned shift : {24U, 16U, 8U, 0U}) {
            to.push_back(static_cast<char>(number >> shift));
        }
    }
    static void put(const std::string& text, std::string& to) {
        put(static_cast<std::uint32_t>(text.size()), to);
        to += text;
        to.append((4 - text.size() % 4) % 4, '\0');
    }
    static void putList(std::uint32_t tag, std::size_t count, std::string& to) {
        put(count == 0 ? 0 : tag, to);
        put(static_cast<std::uint32_t>(count), to);
    }
    [[nodiscard]] std::string head(std::uint32_t begin) const {
        constexpr std::uint32_t kDimension = 10, kVariable = 11, kAttribute = 12, kText = 2, kDouble = 6;
        std::string text("CDF\1", 4);
        put(0, text);  // records
        putList(kDimension, sides_.size(), text);
        for (const auto& [name, side] : sides_) {
            put(name, text);
            put(static_cast<std::uint32_t>(side), text);
        }
        putList(kAttribute, 0, text);
        putList(kVariable, variables_.size(), text);
        for (const NetcdfVariable& variable : variables_) {
            put(variable.name, text);
            put(static_cast<std::uint32_t>(variable.along.size()), text);
            for (const std::string& dimension : variable.along) {
                std::uint32_t number = 0;
                while (sides_[number].first != dimension) {
                    ++number;
                }
                put(number, text);
            }
            putList(kAttribute, variable.attributes.size(), text);
            for (const auto& [key, value] : variable.attributes) {
                put(key, text);
                put(kText, text);
                put(value, text);
            }
            const auto size = static_cast<std::uint32_t>(variable.values.size() * sizeof(double));
            put(kDouble, text);
            put(size, text);
            put(begin, text);
            begin += size;
        }
        return text;
    }

    std::vector<std::pair<std::string, int>> sides_;
    std::vector<NetcdfVariable> variables_;
};

}  // namespace test
