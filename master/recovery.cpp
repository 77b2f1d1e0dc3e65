// SPDX-License-Identifier: Apache-2.0
#include "master/recovery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>

#include "base/byte_stream.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "host/regular_file.hpp"
#include "master/json_count.hpp"

namespace master {
namespace {

using nlohmann::ordered_json;

double unixTime() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

const double kStarted = unixTime();

std::filesystem::path fileIn(const std::filesystem::path& folder) { return folder / kRecoveriesFile; }

/// Returns the text of the file, or an empty text if it cannot be read.
std::string textOf(const std::filesystem::path& file) {
    const host::RegularFile opened(file, host::RegularFile::Links::refused);
    const std::optional<base::Bytes> bytes = opened.error().empty() ? opened.read(opened.size()) : std::nullopt;
    return bytes ? std::string(bytes->begin(), bytes->end()) : "";
}

/// Throws base::InputError if `recovery` lacks a field, or has a value that no session can write.
void check(const ordered_json& recovery) {
    const auto require = [&recovery](const char* key, auto fits, const std::string& allowed) {
        const auto found = recovery.find(key);
        const ordered_json value = found == recovery.end() ? ordered_json() : *found;
        if (found == recovery.end() || !fits(value)) {
            refuseValue(key, value, allowed);
        }
    };
    const auto isText = [](const ordered_json& value) { return value.is_string(); };
    const auto isTime = [](const ordered_json& value) {
        return value.is_number() && value.get<double>() >= 0 && value.get<double>() <= kMostCount;
    };
    const auto orNull = [](auto fits) {
        return [fits](const ordered_json& value) { return value.is_null() || fits(value); };
    };
    const std::string count = fmt::format("a whole number from 0 to {}", kMostCount);
    require("failure", isText, "a text");
    require("failed_how", isText, "a text");
    require("failed_rank", orNull(isCount), count + " or null");
    require("seconds_to_next_frame", orNull(isTime), fmt::format("a number from 0 to {}, or null", kMostCount));
    if (recovery.contains("seconds_to_link")) {
        require("seconds_to_link", isTime, fmt::format("a number from 0 to {}", kMostCount));
    }
    require("state_hash", orNull(isText), "a text or null");
    for (const char* key : {"step", "frame"}) {
        require(key, isCount, count);
    }
    for (const char* key : {"checkpoint_step", "replayed_steps", "cut_bytes"}) {
        require(key, orNull(isCount), count + " or null");
    }
}

struct Lines {
    std::vector<std::string> good, complaints;
};

Lines linesOf(const std::filesystem::path& folder) {
    Lines lines;
    std::istringstream stream(textOf(fileIn(folder)));
    long number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        const ordered_json recovery = ordered_json::parse(line, nullptr, false);
        if (!recovery.is_object()) {  // a crash may have cut off the line
            continue;
        }
        try {
            check(recovery);
            lines.good.push_back(line);
        } catch (const base::InputError& error) {
            lines.complaints.push_back(fmt::format("{}:{}: {}; the summary leaves this recovery out",
                                                   fileIn(folder).string(), number, error.what()));
        }
    }
    return lines;
}

}  // namespace

void tellRecovery(const Recovery& recovery, const std::filesystem::path& folder) {
    const Failure& failure = recovery.failure;
    // At least 0, because somebody may have set the clock back meanwhile.
    const double seconds = std::max(0.0, unixTime() - (failure.noticed > 0 ? failure.noticed : kStarted));
    host::printLine("first frame {:.2f} s after {}: step {}, frame {}", seconds, failure.what, recovery.step,
                    recovery.frame);
    const ordered_json json{{"failure", failure.what},
                            {"failed_rank", failure.rank ? ordered_json(*failure.rank) : ordered_json()},
                            {"failed_how", failure.how},
                            {"seconds_to_next_frame", seconds},
                            {"step", recovery.step},
                            {"frame", recovery.frame},
                            {"state_hash", fmt::format("{:016x}", recovery.stateHash)},
                            {"checkpoint_step", recovery.checkpointStep},
                            {"replayed_steps", recovery.replayedSteps},
                            {"cut_bytes", recovery.cutBytes}};
    host::emitEvent("recovered",
                    {{"recovery", host::Json{json.dump(-1, ' ', false, ordered_json::error_handler_t::replace)}}});
    const std::string line = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
    if (!host::appendLines(fileIn(folder), line)) {
        host::printLine("{}: cannot be written", fileIn(folder).string());
    }
}

std::vector<std::string> recoveriesOf(const std::filesystem::path& folder) {
    Lines read = linesOf(folder);
    for (const std::string& complaint : read.complaints) {
        host::printLine("{}", complaint);
    }
    return std::move(read.good);
}

std::size_t RecoveryCount::count() {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(fileIn(folder_), error);
    if (error || bytes == 0) {
        bytes_ = count_ = 0;
    } else if (bytes != bytes_) {
        bytes_ = bytes;
        count_ = linesOf(folder_).good.size();
    }
    return count_;
}

void forgetRecoveries(const std::filesystem::path& folder) { host::forgetFile(fileIn(folder)); }

}  // namespace master
