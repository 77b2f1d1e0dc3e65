// SPDX-License-Identifier: Apache-2.0
#include "lockstep/watchdog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "host/clock.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "lockstep/cluster.hpp"

namespace lockstep {
namespace {

constexpr double kFirstWord = 1;  // [s], wait after which the missing ranks are printed
constexpr double kStartUpFirstWord = 10;
constexpr double kStartUpLimit = 120;
constexpr double kPatientLimit = 3600;
constexpr double kLongestLook = 0.5;
constexpr double kRankAfterMaster = 3;  // [s] by which a render rank acts later than the master
constexpr double kOthersAfterRank = 1;  // [s] by which the other render ranks end later than the first

constexpr const char* kVariable = "SANDWALL_START_TIMEOUT";

/// Returns the value of kVariable; an empty text if it is not set.
std::string_view givenLimit() {
    const char* const given = std::getenv(kVariable);
    return given == nullptr ? "" : given;
}

/// Returns the number of seconds in `text`, or nullopt if it is not a number from 1 to kPatientLimit.
std::optional<double> readLimit(std::string_view text) {
    double seconds = 0;
    const bool whole = !text.empty() && base::readNumber(text, seconds) == text.size();
    const bool good = whole && seconds >= 1 && seconds <= kPatientLimit;
    return good ? std::optional(seconds) : std::nullopt;
}

/// Returns the limit of a wait before the end of the first frame [s].
double startUpLimit() { return readLimit(givenLimit()).value_or(kStartUpLimit); }

void emitWait(const Wait& wait, double seconds, double limit, bool endsJob) {
    host::emitEvent("waiting", {{"by", wait.by},
                                {"frame", wait.frame},
                                {"ranks", host::Json{fmt::format("[{}]", fmt::join(wait.ranks, ","))}},
                                {"names", wait.names},
                                {"seconds", seconds},
                                {"limit", limit},
                                {"ends_job", endsJob}});
}

}  // namespace

void requireStartUpLimit() {
    const std::string_view given = givenLimit();
    if (!given.empty() && !readLimit(given)) {
        throw base::InputError(fmt::format("{}: must be a number from 1 to {} [s], got '{}'; unset it for {} s",
                                           kVariable, kPatientLimit, given, kStartUpLimit));
    }
}

Watchdog::Watchdog(std::function<Wait()> describe, double limitSeconds, Role role,
                   std::function<void(const std::string&)> lastWords)
    : describe_(std::move(describe)),
      limit_(limitSeconds),
      role_(role),
      lastWords_(std::move(lastWords)),
      thread_([this] { look(); }) {}

Watchdog::~Watchdog() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    stop_.notify_all();
    thread_.join();
}

Watchdog::Role Watchdog::roleOf(int rank) {
    return rank == kMaster ? Role::master : rank == 1 ? Role::firstRank : Role::otherRank;
}

void Watchdog::arm() { armedAt_ = host::monotonicNs(); }
void Watchdog::disarm() { armedAt_ = 0; }

void Watchdog::look() {
    std::unique_lock lock(mutex_);
    std::int64_t spokenOf = 0;  // begin of the wait that has been printed
    std::int64_t watched = 0;   // begin of the wait that `waited` measures
    std::int64_t lastLook = host::monotonicNs();
    double waited = 0;  // [s]
    const double startUp = startUpLimit();
    while (!stop_.wait_for(lock, std::chrono::milliseconds(100), [this] { return stopping_; })) {
        const std::int64_t since = armedAt_;
        const double sinceLook = static_cast<double>(host::monotonicNs() - lastLook) * 1e-9;
        lastLook = host::monotonicNs();
        if (since == 0) {
            continue;
        }
        // Time in which this process itself was stopped does not count as a wait for the others.
        waited = (since == watched ? waited : 0) + std::min(sinceLook, kLongestLook);
        watched = since;
        const Role role = role_;
        const bool speaks = role != Role::otherRank;
        // The rank that prints must end first, because the first process that ends takes all others with it.
        const double patience = role == Role::otherRank ? kOthersAfterRank : 0;
        const double later = role == Role::master ? 0 : kRankAfterMaster;
        const double seconds = waited - later;
        const double limit = patient_ ? kPatientLimit : startingUp_ ? std::max(limit_.load(), startUp) : limit_.load();
        const bool ends = seconds > limit + patience;
        const bool longEnough = seconds > (startingUp_ ? kStartUpFirstWord : kFirstWord);
        const Wait wait = speaks && (ends || (longEnough && spokenOf != since)) ? describe_() : Wait();
        if (armedAt_ != since) {
            continue;  // the wait has ended meanwhile
        }
        if (ends) {
            if (speaks) {
                const std::string line = fmt::format("{} for {:.1f} s; the limit is {:.0f} s, ending the job",
                                                     wait.text, seconds + later, limit);
                host::printLine("{}", line);
                emitWait(wait, seconds + later, limit, true);
                std::fflush(stderr);
                if (lastWords_) {
                    lastWords_(line);
                }
            }
            std::_Exit(1);
        }
        if (speaks && longEnough && spokenOf != since) {
            spokenOf = since;
            host::printLine("{} for {:.1f} s", wait.text, seconds + later);
            emitWait(wait, seconds + later, limit, false);
        }
    }
}

}  // namespace lockstep
