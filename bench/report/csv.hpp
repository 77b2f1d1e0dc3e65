// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/code_path.hpp"

namespace bench {

/// The options of a curve: sizes of fields, number of runs, seed, and output file.
struct Settings {
    std::filesystem::path out;  // empty: stdout
    std::vector<int> sizes;     // [cell], sides of the square fields
    int runs = 10;              // number of runs of each timed measurement
    std::uint32_t seed = 1;
    std::string scene;                   // scene file of `explain`
    std::string raster;                  // raster file of `tin-simplify`, in place of dunes
    std::optional<base::CodePath> path;  // of `throughput`; nullopt: the fastest one
    std::vector<std::string> rows;       // of `throughput` and `guarded-sweep`; empty: all
    std::string commandLine;             // the typed command, for the file's head
};

/// A table of measurements: comment lines with their origin, a line of column names, and rows of numbers.
class Csv {
public:
    explicit Csv(const Settings& settings) : settings_(settings) {}

    /// Writes a comment line, such as the definition of a column.
    ///
    /// The first line opens the file and writes machine, compiler, flags, code path, seed, command and date before
    /// itself. So a run that refuses its input leaves no file. Throws base::InputError if the file cannot be opened.
    void note(std::string_view line);
    void columns(std::string_view names);

    /// Writes a row to the file at once, so that an interrupted run leaves whole rows.
    template <class... Values>
    void row(const Values&... values) {
        std::string line;
        ((line += line.empty() ? "" : ",", append(line, values)), ...);
        write(line);
    }

    /// Throws std::runtime_error if a line could not be written.
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

/// Prints a line about the current measurement to standard error.
template <class... Arguments>
void progress(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::print(stderr, "{}\n", fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace bench
