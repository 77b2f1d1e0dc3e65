// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "base/number.hpp"
#include "base/text.hpp"

/// Puts nan and inf into scene files and wall files. TOML has both as numbers.
namespace support {

/// Returns the error line for a text, with the file's name "f.toml" before a colon and the line.
using Complain = std::function<std::string(const std::string& text)>;

inline std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

inline std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) {
        text += line + "\n";
    }
    return text;
}

/// Expects that `lines` with `changed` in place of line `index` are refused at that line.
inline void expectRefusedAt(std::vector<std::string> lines, std::size_t index, const std::string& changed,
                            const Complain& complain) {
    lines[index] = changed;
    const std::string complaint = complain(joined(lines));
    EXPECT_TRUE(complaint.starts_with("f.toml:" + std::to_string(index + 1) + ": ")) << changed << "\n" << complaint;
    EXPECT_EQ(complaint.find('\n'), std::string::npos) << complaint;
}

/// Tries nan and inf in place of each number of the file. Returns how many numbers it has.
inline int tryEachNumber(const std::string& text, const Complain& complain) {
    const std::vector<std::string> lines = linesOf(text);
    int count = 0;
    for (std::size_t index = 0; index < lines.size(); ++index) {
        const std::string& line = lines[index];
        if (line.starts_with('#')) {
            continue;
        }
        bool quoted = false;
        for (std::size_t begin = line.find('='); begin < line.size() && (quoted || line[begin] != '#'); ++begin) {
            quoted = quoted != (line[begin] == '"');
            const std::size_t end = line.find_first_of(", ]#", begin);
            if (quoted || !base::numberOf(std::string_view(line).substr(begin, end - begin))) {
                continue;
            }
            ++count;
            for (const std::string number : {"nan", "inf", "-inf"}) {
                std::string changed = line;
                expectRefusedAt(lines, index, changed.replace(begin, end - begin, number), complain);
            }
            begin = std::min(end, line.size()) - 1;
        }
    }
    return count;
}

/// Returns the keys that the table at line `index` knows, as the error about an unknown key lists them.
inline std::vector<std::string> knownKeys(std::vector<std::string> lines, std::size_t index, const Complain& complain) {
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(index) + 1, "nonsense = 1");
    const std::string complaint = complain(joined(lines));
    const std::string start = "unknown key 'nonsense'; known here: ";
    const std::size_t at = complaint.find(start);
    std::vector<std::string> keys;
    if (at == std::string::npos) {
        ADD_FAILURE() << lines[index] << ": " << complaint;
        return keys;
    }
    for (const std::string_view key : base::split(std::string_view(complaint).substr(at + start.size()), ',')) {
        keys.emplace_back(key);
    }
    return keys;
}

/// Tries nan and inf for each key that a table of the file knows and does not have. Such a key may contradict another
/// one, so the refusal may name another line. Returns "[table] key" of each.
inline std::set<std::string> tryEachOtherKey(const std::string& text, const Complain& complain) {
    const std::vector<std::string> lines = linesOf(text);
    std::set<std::string> tried;
    for (std::size_t index = 0; index < lines.size(); ++index) {
        if (!lines[index].starts_with('[')) {
            continue;
        }
        const std::string table = lines[index].substr(0, lines[index].find_last_of(']') + 1);
        for (const std::string& key : knownKeys(lines, index, complain)) {
            bool given = false;
            for (std::size_t i = index + 1; i < lines.size() && !lines[i].starts_with('['); ++i) {
                given = given || lines[i].starts_with(key + " ");
            }
            if (given || key == "nonsense") {
                continue;
            }
            tried.insert(fmt::format("{} {}", table, key));
            for (const std::string number : {"nan", "inf", "-inf"}) {
                std::vector<std::string> longer = lines;
                longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(index) + 1,
                              fmt::format("{} = {}", key, number));
                const std::string complaint = complain(joined(longer));
                EXPECT_TRUE(complaint.starts_with("f.toml:"))
                    << table << " " << key << " = " << number << ": " << complaint;
            }
        }
    }
    return tried;
}

}  // namespace support
