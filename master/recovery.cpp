// SPDX-License-Identifier: Apache-2.0
#include "master/recovery.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "base/byte_stream.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "host/regular_file.hpp"

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

bool endsInsideALine(const std::filesystem::path& file) {
    const std::string text = textOf(file);
    return !text.empty() && text.back() != '\n';
}

}  // namespace

void tellRecovery(const Recovery& recovery, const std::filesystem::path& folder) {
    const Failure& failure = recovery.failure;
    const double seconds = unixTime() - (failure.noticed > 0 ? failure.noticed : kStarted);
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
    const bool torn = endsInsideALine(fileIn(folder));  // a crash may have cut off the last line
    const std::string line = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
    if (!host::appendText(fileIn(folder), (torn ? "\n" : "") + line)) {
        host::printLine("{}: cannot be written", fileIn(folder).string());
    }
}

std::vector<std::string> recoveriesOf(const std::filesystem::path& folder) {
    std::vector<std::string> lines;
    std::istringstream stream(textOf(fileIn(folder)));
    for (std::string line; std::getline(stream, line);) {
        if (ordered_json::accept(line)) {  // a crash may have cut off a line
            lines.push_back(line);
        }
    }
    return lines;
}

std::size_t RecoveryCount::count() {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(fileIn(folder_), error);
    if (error || bytes == 0) {
        bytes_ = count_ = 0;
    } else if (bytes != bytes_) {
        bytes_ = bytes;
        count_ = recoveriesOf(folder_).size();
    }
    return count_;
}

void forgetRecoveries(const std::filesystem::path& folder) { host::forgetFile(fileIn(folder)); }

}  // namespace master
