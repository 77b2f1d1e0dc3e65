// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace bench {

/// What every curve is told: how large, how often, from which seed, and where to write.
struct Settings {
    std::filesystem::path out;  // empty: stdout
    std::vector<int> sizes;     // [cell], sides of the square fields
    int runs = 10;              // of everything that is timed
    std::uint32_t seed = 1;
    std::string scene;        // explain's
    std::string raster;       // tin-simplify's, in place of dunes
    std::string commandLine;  // as typed, for the file's head
};

/// A table of measurements: comment lines that say where they come from, a line of column names, rows of numbers.
class Csv {
public:
    explicit Csv(const Settings& settings) : settings_(settings) {}

    /// One more comment line: a definition that a reader of the numbers needs. The first opens the file and writes
    /// machine, compiler, flags, code path, seed, command and date before it: input that cannot be used leaves no file.
    /// Throws base::InputError when the file cannot be opened.
    void note(std::string_view line);
    void columns(std::string_view names);

    /// A row as soon as it is known, so that an interrupted run leaves whole rows.
    template <class... Values>
    void row(const Values&... values) {
        std::string line;
        ((line += line.empty() ? "" : ",", append(line, values)), ...);
        write(line);
    }

    /// Throws std::runtime_error when the disk did not take everything.
    void finish();

private:
    static void append(std::string& line, double value) { line += fmt::format("{:.6g}", value); }
    static void append(std::string& line, std::string_view value) { line += value; }
    static void append(std::string& line, const char* value) { line += value; }
    static void append(std::string& line, const std::string& value) { line += value; }
    template <class Integer>
    requires std::is_integral_v<Integer>
    static void append(std::string& line, Integer value) { line += fmt::format("{}", value); }
    void write(std::string_view line);

    struct Close {
        void operator()(std::FILE* file) const;
    };
    void open();
    [[nodiscard]] std::string name() const {
        return settings_.out.empty() ? "standard output" : settings_.out.string();
    }

    const Settings& settings_;
    std::unique_ptr<std::FILE, Close> file_;  // null before the first line
};

/// A line on stderr about what runs now.
template <class... Arguments>
void progress(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::print(stderr, "{}\n", fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace bench
