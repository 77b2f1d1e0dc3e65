// SPDX-License-Identifier: Apache-2.0
#include "host/toml_table.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <fstream>
#include <set>

#include "base/input_error.hpp"
#include "base/text_reader.hpp"

namespace host {

struct TomlTable::Document {
    std::filesystem::path path;
    toml::table root;
};

struct TomlTable::Node {
    std::shared_ptr<Document> document;
    const toml::table* table = nullptr;
    std::string name;                       // the name in [name]; empty for the root
    mutable std::set<std::string> known{};  // keys that were read
};

namespace {

long lineOf(const toml::node& node) { return static_cast<long>(node.source().begin.line); }

/// Returns nullopt unless the node is a list of exactly `count` finite numbers.
std::optional<std::vector<double>> numbersOf(const toml::node* value, std::size_t count) {
    const toml::array* array = value != nullptr ? value->as_array() : nullptr;
    if (array == nullptr || array->size() != count) {
        return std::nullopt;
    }
    std::vector<double> result;
    for (const toml::node& element : *array) {
        const std::optional<double> number = element.value<double>();
        if (!element.is_number() || !number || !std::isfinite(*number)) {
            return std::nullopt;
        }
        result.push_back(*number);
    }
    return result;
}

}  // namespace

TomlTable TomlTable::load(const std::filesystem::path& file) {
    std::error_code ignored;
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file, ignored)) {
        throw base::InputError(fmt::format("{}: cannot be read; check the path", file.string()));
    }
    // toml++ reads UTF-8 alone. Texts of Windows may be in UTF-16.
    base::TextReader lines(stream, file.string());
    std::string text;
    for (std::string_view line; lines.nextLine(line);) {
        text.append(line).push_back('\n');
    }
    return parse(text, file.string());
}

TomlTable TomlTable::parse(std::string_view text, const std::string& name) {
    auto document = std::make_shared<Document>();
    document->path = name;
    try {
        document->root = toml::parse(text, name);
    } catch (const toml::parse_error& error) {
        throw base::InputError(name, static_cast<long>(error.source().begin.line), std::string(error.description()));
    }
    auto node = std::make_shared<Node>();
    node->table = &document->root;
    node->document = std::move(document);
    return TomlTable(std::move(node));
}

bool TomlTable::has(std::string_view key) const { return node_->table->contains(key); }

long TomlTable::line(std::string_view key) const {
    const toml::node* value = node_->table->get(key);
    return std::max(value != nullptr ? lineOf(*value) : lineOf(*node_->table), 1L);
}

void TomlTable::fail(std::string_view key, const std::string& message) const {
    throw base::InputError(node_->document->path.string(), line(key), message);
}

double TomlTable::number(std::string_view key, Range range) const {
    node_->known.emplace(key);
    const toml::node* value = node_->table->get(key);
    if (value == nullptr) {
        fail(key, fmt::format("[{}] needs a number '{}'", node_->name, key));
    }
    const std::optional<double> number = value->value<double>();
    if (!value->is_number() || !number || !std::isfinite(*number)) {
        fail(key, fmt::format("{} must be a finite number", key));
    }
    if (*number < range.lowest || *number > range.highest || (range.highestIsOut && *number == range.highest)) {
        if (range.lowest == kPositive.lowest) {
            fail(key, fmt::format("{} must be positive, got {}", key, *number));
        }
        fail(key, fmt::format("{} must be within [{}, {}{}, got {}", key, range.lowest, range.highest,
                              range.highestIsOut ? ')' : ']', *number));
    }
    return *number;
}

double TomlTable::numberOr(std::string_view key, double fallback, Range range) const {
    node_->known.emplace(key);
    return has(key) ? number(key, range) : fallback;
}

int TomlTable::integer(std::string_view key, int lowest, int highest) const {
    node_->known.emplace(key);
    const toml::node* value = node_->table->get(key);
    if (value == nullptr) {
        fail(key, fmt::format("[{}] needs a whole number '{}'", node_->name, key));
    }
    const std::int64_t number = value->value<std::int64_t>().value_or(0);
    if (!value->is_integer() || number < lowest || number > highest) {
        const std::optional<double> got = value->is_number() ? value->value<double>() : std::nullopt;
        fail(key, fmt::format("{} must be a whole number within [{}, {}]{}", key, lowest, highest,
                              value->is_integer() ? fmt::format(", got {}", number)
                              : got               ? fmt::format(", got {}", *got)
                                                  : ""));
    }
    return static_cast<int>(number);
}

int TomlTable::integerOr(std::string_view key, int fallback, int lowest, int highest) const {
    node_->known.emplace(key);
    return has(key) ? integer(key, lowest, highest) : fallback;
}

bool TomlTable::flagOr(std::string_view key, bool fallback) const {
    node_->known.emplace(key);
    const toml::node* value = node_->table->get(key);
    if (value == nullptr) {
        return fallback;
    }
    if (!value->is_boolean()) {
        const std::optional<std::string> text = value->value<std::string>();
        fail(key, fmt::format("{} must be true or false, without quotation marks{}", key,
                              text ? fmt::format(", got \"{}\"", *text) : ""));
    }
    return value->value<bool>().value_or(fallback);
}

std::string TomlTable::text(std::string_view key) const {
    node_->known.emplace(key);
    const toml::node* value = node_->table->get(key);
    if (value == nullptr || !value->is_string()) {
        fail(key, value == nullptr ? fmt::format("[{}] needs a text '{}'", node_->name, key)
                                   : fmt::format("{} must be a text in quotes", key));
    }
    return value->value<std::string>().value_or("");
}

std::string TomlTable::textOr(std::string_view key, std::string_view fallback) const {
    node_->known.emplace(key);
    return has(key) ? text(key) : std::string(fallback);
}

int TomlTable::choiceOr(std::string_view key, const std::vector<std::string_view>& choices, int fallback) const {
    node_->known.emplace(key);
    if (!has(key)) {
        return fallback;
    }
    const std::string chosen = text(key);
    int index = 0;
    for (const std::string_view choice : choices) {
        if (choice == chosen) {
            return index;
        }
        ++index;
    }
    fail(key, fmt::format("{} must be one of {}, got '{}'", key, fmt::join(choices, ", "), chosen));
}

std::vector<double> TomlTable::numbers(std::string_view key, std::size_t count) const {
    node_->known.emplace(key);
    const toml::node* value = node_->table->get(key);
    std::optional<std::vector<double>> result = numbersOf(value, count);
    if (!result) {
        fail(key, value == nullptr ? fmt::format("[{}] needs a list of {} numbers '{}'", node_->name, count, key)
                                   : fmt::format("{} must be a list of {} finite numbers", key, count));
    }
    return *std::move(result);
}

std::vector<double> TomlTable::numbersOr(std::string_view key, std::vector<double> fallback) const {
    node_->known.emplace(key);
    if (!has(key)) {
        return fallback;
    }
    return numbers(key, fallback.size());
}

std::vector<std::string> TomlTable::textsOr(std::string_view key, std::vector<std::string> fallback) const {
    node_->known.emplace(key);
    if (!has(key)) {
        return fallback;
    }
    const toml::array* array = node_->table->get(key)->as_array();
    std::vector<std::string> result;
    if (array != nullptr) {
        for (const toml::node& element : *array) {
            if (const std::optional<std::string> entry = element.value<std::string>(); element.is_string() && entry) {
                result.push_back(*entry);
            }
        }
    }
    if (array == nullptr || result.size() != array->size()) {
        fail(key, fmt::format("{} must be a list of texts", key));
    }
    return result;
}

std::vector<std::vector<double>> TomlTable::numberLists(std::string_view key, std::size_t count) const {
    node_->known.emplace(key);
    const toml::node* value = node_->table->get(key);
    const toml::array* array = value != nullptr ? value->as_array() : nullptr;
    std::vector<std::vector<double>> result;
    if (array != nullptr) {
        for (const toml::node& element : *array) {
            if (std::optional<std::vector<double>> numbers = numbersOf(&element, count)) {
                result.push_back(*std::move(numbers));
            }
        }
    }
    if (array == nullptr || result.size() != array->size()) {
        fail(key, fmt::format("{} must be a list of lists of {} finite numbers", key, count));
    }
    return result;
}

bool TomlTable::isText(std::string_view key) const {
    const toml::node* value = node_->table->get(key);
    return value != nullptr && value->is_string();
}

std::optional<TomlTable> TomlTable::table(std::string_view key) const {
    node_->known.emplace(key);
    if (!has(key)) {
        return std::nullopt;
    }
    const toml::table* child = node_->table->get(key)->as_table();
    if (child == nullptr) {
        fail(key, fmt::format("{} must be a table: write [{}]", key, key));
    }
    auto node = std::make_shared<Node>();
    node->document = node_->document;
    node->table = child;
    node->name = key;
    return TomlTable(std::move(node));
}

TomlTable TomlTable::requiredTable(std::string_view key) const {
    std::optional<TomlTable> child = table(key);
    if (!child) {
        fail(key, fmt::format("a table [{}] is missing", key));
    }
    return *std::move(child);
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
    node_->known.emplace(key);
    std::vector<TomlTable> result;
    if (!has(key)) {
        return result;
    }
    const toml::array* array = node_->table->get(key)->as_array();
    if (array == nullptr || !array->is_array_of_tables()) {
        fail(key, fmt::format("{} must be tables: write [[{}]]", key, key));
    }
    for (const toml::node& element : *array) {
        auto node = std::make_shared<Node>();
        node->document = node_->document;
        node->table = element.as_table();
        node->name = key;
        result.push_back(TomlTable(std::move(node)));
    }
    return result;
}

void TomlTable::only(std::initializer_list<std::string_view> keys) const {
    node_->known.insert(keys.begin(), keys.end());
    finish();
}

void TomlTable::finish() const {
    const toml::node* first = nullptr;
    std::string name;
    for (const auto& [key, value] : *node_->table) {
        const bool unknown = !node_->known.contains(std::string(key.str()));
        if (unknown && (first == nullptr || lineOf(value) < lineOf(*first))) {
            first = &value;
            name = key.str();
        }
    }
    if (first != nullptr) {
        fail(name, fmt::format("unknown key '{}'; known here: {}", name, fmt::join(node_->known, ", ")));
    }
}

std::filesystem::path TomlTable::folder() const { return node_->document->path.parent_path(); }

}  // namespace host
