// SPDX-License-Identifier: Apache-2.0
#include "master/measure/recovery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/byte_stream.hpp"
#include "host/clock.hpp"
#include "host/event.hpp"
#include "host/json_fields.hpp"
#include "host/print_line.hpp"
#include "host/regular_file.hpp"
#include "lockstep/cluster.hpp"

namespace master {
namespace {

using nlohmann::ordered_json;

const std::int64_t kStartedNs = host::monotonicNs();

std::filesystem::path fileIn(const std::filesystem::path& folder) { return folder / kRecoveriesFile; }

/// Returns the text of the file, or an empty text if it cannot be read.
std::string textOf(const host::RegularFile& file) {
    const std::optional<base::Bytes> bytes = file.error().empty() ? file.read(file.size()) : std::nullopt;
    return bytes ? std::string(bytes->begin(), bytes->end()) : "";
}

/// A line of the file. The launcher writes lines too, also for the haptic server, for which some values are null.
struct Line {
    std::string failure;
    std::optional<std::uint64_t> rank{};
    std::string how;
    std::optional<double> secondsToFrame{}, secondsToLink{};  // [s]
    std::uint64_t step = 0, frame = 0;
    std::optional<std::string> stateHash;
    std::optional<std::uint64_t> checkpointStep, replayedSteps, cutBytes;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("failure", it.failure);
        visit("failed_rank", it.rank);
        visit("failed_how", it.how);
        visit("seconds_to_next_frame", it.secondsToFrame);
        visit("seconds_to_link", host::ifThere(it.secondsToLink));
        visit("step", it.step);
        visit("frame", it.frame);
        visit("state_hash", it.stateHash);
        visit("checkpoint_step", it.checkpointStep);
        visit("replayed_steps", it.replayedSteps);
        visit("cut_bytes", it.cutBytes);
    }
};

struct Lines {
    std::vector<std::string> good, complaints;
};

/// Reads `file`, which is that of the session's folder `folder`.
Lines linesOf(const std::filesystem::path& folder, const host::RegularFile& file) {
    Lines lines;
    std::istringstream stream(textOf(file));
    long number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        const ordered_json recovery = ordered_json::parse(line, nullptr, false);
        if (!recovery.is_object()) {  // a crash may have cut off the line
            continue;
        }
        try {
            (void)host::fromJson<Line>(recovery);
            lines.good.push_back(line);
        } catch (const base::InputError& error) {
            lines.complaints.push_back(fmt::format("{}:{}: {}; the summary leaves this recovery out",
                                                   fileIn(folder).string(), number, error.what()));
        }
    }
    return lines;
}

/// Returns whether `how` is one of the words that the launcher uses for the end of a process.
bool isKnown(std::string_view how) {
    if (how == "hung" || how == "broken" || how == "disk") {
        return true;
    }
    constexpr std::array<std::string_view, 3> kBegins{"SIG", "signal ", "status "};
    return std::any_of(kBegins.begin(), kBegins.end(), [how](std::string_view begin) {
        return how.starts_with(begin) && std::all_of(how.begin() + std::ssize(begin), how.end(), [](char c) {
                   return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '+' || c == '-';
               });
    });
}

}  // namespace

double Failure::secondsAgo(std::int64_t nowNs, std::int64_t startedNs, const std::string& here) const {
    const double now = static_cast<double>(nowNs) * 1e-9;
    return std::max(0.0, machine == here ? now - noticed : before + now - static_cast<double>(startedNs) * 1e-9);
}

std::string withoutHosts(const Failure& failure) {
    const std::string how = isKnown(failure.how) ? failure.how : "failed";
    if (failure.rank) {
        return fmt::format("rank {}: {}", *failure.rank, how);
    }
    return failure.how.empty() ? "the start" : how;
}

void reportRecovery(const Recovery& recovery, const std::filesystem::path& folder) {
    const Failure& failure = recovery.failure;
    const double seconds = failure.secondsAgo(host::monotonicNs(), kStartedNs, lockstep::machineId());
    host::printLine("first frame {:.2f} s after {}: step {}, frame {}", seconds, failure.what, recovery.step,
                    recovery.frame);
    Line fields{.failure = failure.what,
                .how = failure.how,
                .secondsToFrame = seconds,
                .step = recovery.step,
                .frame = recovery.frame,
                .stateHash = fmt::format("{:016x}", recovery.stateHash),
                .checkpointStep = recovery.checkpointStep,
                .replayedSteps = recovery.replayedSteps,
                .cutBytes = static_cast<std::uint64_t>(recovery.cutBytes)};
    if (failure.rank) {
        fields.rank = static_cast<std::uint64_t>(*failure.rank);
    }
    const std::string json = host::jsonOf(fields).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    host::emitEvent("recovered", {{"recovery", host::Json{json}}});
    if (!host::appendLines(fileIn(folder), json + '\n')) {
        host::printLine("{}: cannot be written", fileIn(folder).string());
    }
}

std::vector<std::string> recoveriesOf(const std::filesystem::path& folder) {
    Lines read = linesOf(folder, host::RegularFile(fileIn(folder), host::RegularFile::Links::refused));
    for (const std::string& complaint : read.complaints) {
        host::printLine("{}", complaint);
    }
    return std::move(read.good);
}

std::size_t RecoveryCount::count() {
    const host::RegularFile file(fileIn(folder_), host::RegularFile::Links::refused);
    const std::uintmax_t bytes = file.error().empty() ? file.size() : 0;
    if (bytes != bytes_) {
        bytes_ = bytes;
        count_ = linesOf(folder_, file).good.size();
    }
    return count_;
}

void forgetRecoveries(const std::filesystem::path& folder) { host::forgetFile(fileIn(folder)); }

}  // namespace master
