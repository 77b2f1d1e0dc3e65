// SPDX-License-Identifier: Apache-2.0
#include "bench/report/csv.hpp"

#include <fcntl.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "base/input_error.hpp"

namespace bench {
namespace {

std::string machine() {
    std::ifstream info("/proc/cpuinfo");
    std::string model = "unknown processor";
    for (std::string line; std::getline(info, line);) {
        if (line.starts_with("model name")) {
            model = line.substr(line.find(':') + 2);
            break;
        }
    }
    return fmt::format("{}, {} processors", model, std::thread::hardware_concurrency());
}

std::string date() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

/// Opens a file for writing, or returns nullptr. Follows no link, except those to open files, such as /dev/stdout. A
/// new file takes the place of a regular file, because other users could have the right to write to that one.
std::FILE* newFile(const std::filesystem::path& path) {
    std::error_code none;
    if (std::filesystem::symlink_status(path, none).type() == std::filesystem::file_type::regular) {
        std::filesystem::remove(path, none);
    }
    const bool own = path == "/dev/stdout" || path == "/dev/stderr" || path.native().starts_with("/dev/fd/");
    const int made =
        open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOCTTY | (own ? 0 : O_NOFOLLOW), 0644);
    return made < 0 ? nullptr : fdopen(made, "w");
}

}  // namespace

void Csv::Close::operator()(std::FILE* file) const {
    if (file != stdout) {
        std::fclose(file);
    }
}

void Csv::open() {
    file_.reset(settings_.out.empty() ? stdout : newFile(settings_.out));
    if (!file_) {
        throw base::InputError(name() + ": cannot be written; choose another --out");
    }
    note("machine: " + machine());
    note("compiler: " SANDWALL_COMPILER);
    note("flags: " SANDWALL_FLAGS);
    note(fmt::format("code path: {}", base::nameOf(settings_.path.value_or(base::fastestCodePath()))));
    note(fmt::format("seed: {}", settings_.seed));
    note("command: " + settings_.commandLine);
    note("date: " + date());
}

void Csv::note(std::string_view line) { write(fmt::format("# {}", line)); }

void Csv::columns(std::string_view names) { write(names); }

void Csv::write(std::string_view line) {
    if (!file_) {
        open();
    }
    fmt::print(file_.get(), "{}\n", line);
    std::fflush(file_.get());
}

void Csv::finish() {
    if (file_ && std::ferror(file_.get()) != 0) {
        throw std::runtime_error(name() + ": not all rows could be written; make room on the disk");
    }
}

}  // namespace bench
