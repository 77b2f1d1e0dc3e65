// SPDX-License-Identifier: Apache-2.0
#include "bench/csv.hpp"

#include <ctime>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "base/input_error.hpp"
#include "bench/sand/relaxations.hpp"

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

}  // namespace

void Csv::Close::operator()(std::FILE* file) const {
    if (file != stdout) {
        std::fclose(file);
    }
}

void Csv::open() {
    file_.reset(settings_.out.empty() ? stdout : std::fopen(settings_.out.c_str(), "w"));
    if (!file_) {
        throw base::InputError(name() + ": cannot be written; choose another --out");
    }
    note("machine: " + machine());
    note("compiler: " SANDWALL_COMPILER);
    note("flags: " SANDWALL_FLAGS);
    note(std::string("code path: ") + codePath());
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
