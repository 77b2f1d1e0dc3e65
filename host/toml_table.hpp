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

namespace host {

/// The range of numbers that a key accepts. A message prints it: "within [0, 90)".
struct Range {
    double lowest = -std::numeric_limits<double>::max();
    double highest = std::numeric_limits<double>::max();
    bool highestIsOut = false;  // `highest` itself is refused
};

inline constexpr Range kPositive{std::numeric_limits<double>::min(), std::numeric_limits<double>::max()};

/// One table of a TOML file, read key by key, so that every complaint names file, line and key.
///
/// A reader takes the keys it knows and ends with finish(), which refuses the ones nobody asked for: a typing error
/// must not become a silent default. Every member throws base::InputError. Copies share the same file.
class TomlTable {
public:
    static TomlTable load(const std::filesystem::path& file);
    /// `name` stands for the file in messages.
    static TomlTable parse(std::string_view text, const std::string& name);

    [[nodiscard]] bool has(std::string_view key) const;
    [[nodiscard]] double number(std::string_view key, Range range = {}) const;
    [[nodiscard]] double numberOr(std::string_view key, double fallback, Range range = {}) const;
    [[nodiscard]] int integer(std::string_view key, int lowest, int highest) const;
    [[nodiscard]] int integerOr(std::string_view key, int fallback, int lowest, int highest) const;
    [[nodiscard]] bool flagOr(std::string_view key, bool fallback) const;
    [[nodiscard]] std::string text(std::string_view key) const;
    [[nodiscard]] std::string textOr(std::string_view key, std::string_view fallback) const;
    /// The index of the key's text among `choices`, `fallback` when the key is absent.
    [[nodiscard]] int choiceOr(std::string_view key, const std::vector<std::string_view>& choices, int fallback) const;
    /// Exactly `count` finite numbers.
    [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count) const;
    [[nodiscard]] std::vector<double> numbersOr(std::string_view key, std::vector<double> fallback) const;
    [[nodiscard]] std::vector<std::string> textsOr(std::string_view key, std::vector<std::string> fallback) const;
    /// Any number of lists of exactly `count` finite numbers each.
    [[nodiscard]] std::vector<std::vector<double>> numberLists(std::string_view key, std::size_t count) const;
    /// Whether the key is there and holds a text: for keys that take a text or a list.
    [[nodiscard]] bool isText(std::string_view key) const;

    /// A sub-table; absent gives nothing.
    [[nodiscard]] std::optional<TomlTable> table(std::string_view key) const;
    /// A sub-table that must be there.
    [[nodiscard]] TomlTable requiredTable(std::string_view key) const;
    /// The tables of [[key]], in the order of the file; absent gives none.
    [[nodiscard]] std::vector<TomlTable> tables(std::string_view key) const;

    /// Throws for the first key, in the order of lines, that is not among these. Asked before anything is read, it
    /// names the misspelt key where the reader would miss the right one.
    void only(std::initializer_list<std::string_view> keys) const;
    /// Throws for the first key, in the order of lines, that nobody read.
    void finish() const;
    /// Throws with file and the line of `key` (of the table itself when the key is absent).
    [[noreturn]] void fail(std::string_view key, const std::string& message) const;
    /// The folder of the file, for paths inside it.
    [[nodiscard]] std::filesystem::path folder() const;

private:
    struct Document;
    struct Node;
    explicit TomlTable(std::shared_ptr<Node> node) : node_(std::move(node)) {}
    std::shared_ptr<Node> node_;
};

}  // namespace host
