// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/names.hpp"

namespace host {

/// Range of numbers that a key accepts. Messages print it: "within [0, 90)".
struct Range {
    double lowest = -std::numeric_limits<double>::max();
    double highest = std::numeric_limits<double>::max();
    bool highestIsOut = false;  // whether `highest` itself is refused
};

inline constexpr Range kPositive{std::numeric_limits<double>::min(), std::numeric_limits<double>::max()};

/// One table of a TOML file. It is read key by key, so that each message names file, line and key.
///
/// Read every known key, then call finish(), which refuses the keys that were not read. Otherwise a typing error would
/// silently select a default. Every member throws base::InputError. Copies share the same file.
class TomlTable {
public:
    static TomlTable load(const std::filesystem::path& file);
    /// Parses a text. Messages print `name` as its file.
    static TomlTable parse(std::string_view text, const std::string& name);

    [[nodiscard]] bool has(std::string_view key) const;
    [[nodiscard]] double number(std::string_view key, Range range = {}) const;
    [[nodiscard]] double numberOr(std::string_view key, double fallback, Range range = {}) const;
    [[nodiscard]] int integer(std::string_view key, int lowest, int highest) const;
    [[nodiscard]] int integerOr(std::string_view key, int fallback, int lowest, int highest) const;
    [[nodiscard]] bool flagOr(std::string_view key, bool fallback) const;
    [[nodiscard]] std::string text(std::string_view key) const;
    [[nodiscard]] std::string textOr(std::string_view key, std::string_view fallback) const;
    /// Returns the index of the key's text in `choices`, or `fallback` if the key is absent.
    [[nodiscard]] int choiceOr(std::string_view key, const std::vector<std::string_view>& choices, int fallback) const;
    /// Returns the value whose name the key's text is (base/names.hpp), or `fallback` if the key is absent.
    template <base::NamedEnum Enum>
    [[nodiscard]] Enum valueOr(std::string_view key, Enum fallback) const {
        const auto names = base::namesOf<Enum>();
        const int index = choiceOr(key, {names.begin(), names.end()}, -1);
        return index < 0 ? fallback : valuesOf(Enum{})[static_cast<std::size_t>(index)].value;
    }
    /// Returns a list of exactly `count` finite numbers.
    [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count) const;
    [[nodiscard]] std::vector<double> numbersOr(std::string_view key, std::vector<double> fallback) const;
    [[nodiscard]] std::vector<std::string> textsOr(std::string_view key, std::vector<std::string> fallback) const;
    /// Returns any number of lists, each of exactly `count` finite numbers.
    [[nodiscard]] std::vector<std::vector<double>> numberLists(std::string_view key, std::size_t count) const;
    /// Returns whether the key is present and holds a text. For keys that accept a text or a list.
    [[nodiscard]] bool isText(std::string_view key) const;

    /// Returns a sub-table, or nullopt if it is absent.
    [[nodiscard]] std::optional<TomlTable> table(std::string_view key) const;
    /// Returns a sub-table that must be present.
    [[nodiscard]] TomlTable requiredTable(std::string_view key) const;
    /// Returns the tables of [[key]] in the order of the file, or an empty list if the key is absent.
    [[nodiscard]] std::vector<TomlTable> tables(std::string_view key) const;

    /// Throws for the first key in the file that is not one of these. Call it before reading: the message then names
    /// the misspelt key, where reading would report the correct key as missing.
    void only(std::initializer_list<std::string_view> keys) const;
    /// Throws for the first key in the file that was not read.
    void finish() const;
    /// Returns the line of `key`, or the line of the table if the key is absent. Counts from 1.
    [[nodiscard]] long line(std::string_view key) const;
    /// Throws with the file and the line() of `key`.
    [[noreturn]] void fail(std::string_view key, const std::string& message) const;
    /// Returns the folder of the file, to which paths in the file are relative.
    [[nodiscard]] std::filesystem::path folder() const;

private:
    struct Document;
    struct Node;
    explicit TomlTable(std::shared_ptr<Node> node) : node_(std::move(node)) {}
    std::shared_ptr<Node> node_;
};

}  // namespace host
