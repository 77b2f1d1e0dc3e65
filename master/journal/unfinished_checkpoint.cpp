// SPDX-License-Identifier: Apache-2.0
#include "master/journal/unfinished_checkpoint.hpp"

#include <fmt/format.h>

#include <csignal>
#include <stdexcept>
#include <utility>

#include "host/phase_progress.hpp"
#include "host/print_line.hpp"

namespace master {
namespace {

constexpr const char* kLeftOut = "it is left out";
constexpr std::chrono::milliseconds kLook{100};
constexpr double kProgress = 0.01;  // smallest part that counts as progress
constexpr double kNsPerSecond = 1e9;

volatile std::sig_atomic_t endAsked = 0;

}  // namespace

void UnfinishedCheckpoint::Work::requireWanted() const {
    if (leftOut_) {
        throw std::runtime_error(kLeftOut);
    }
}

UnfinishedCheckpoint::UnfinishedCheckpoint(std::uint64_t step, std::function<void(Work&)> write)
    : step_(step), result_(std::async(std::launch::async, [work = work_, write = std::move(write)]() mutable {
          try {
              // The copy of the sand ends on this thread. Otherwise a frame would wait until its memory is given back.
              std::exchange(write, nullptr)(*work);
              return std::string();
          } catch (const std::exception& error) {
              return std::string(error.what());
          }
      })) {}

bool UnfinishedCheckpoint::endsWithin(std::chrono::milliseconds patience) const {
    return result_.wait_for(patience) == std::future_status::ready;
}

std::string UnfinishedCheckpoint::complaint() {
    std::string complaint = result_.get();
    if (complaint != kLeftOut) {
        return complaint;
    }
    host::printLine("the checkpoint of step {} is left out, because it was not written within {} s", step_,
                    kPatience.count());
    return {};
}

bool UnfinishedCheckpoint::finish(bool dispensable, const std::function<bool()>& abandoned,
                                  const std::function<std::int64_t()>& now) {
    host::PhaseProgress progress(
        "checkpoint", fmt::format("writes the checkpoint of step {}", step_),
        [](const std::string& line) { host::printLine("{}", line); }, now);
    const std::int64_t began = now();
    std::int64_t advanced = began;
    double share = work_->done_;
    while (!endsWithin(kLook)) {
        const std::int64_t present = now();
        if (work_->done_ >= share + kProgress) {
            share = work_->done_;
            advanced = present;
        }
        progress.done(work_->done_);
        if (abandoned()) {
            leaveOut();
            host::printLine("the checkpoint of step {} is abandoned; the journal has every step", step_);
            return false;
        }
        if (static_cast<double>(present - advanced) > kStalledSeconds * kNsPerSecond) {
            leaveOut();
            host::printLine(
                "the checkpoint of step {} gets no further for {} s; it is left out, and the journal has "
                "every step",
                step_, kStalledSeconds);
            return false;
        }
        if (dispensable && present - began > std::chrono::nanoseconds(kPatience).count()) {
            leaveOut();
        }
    }
    if (const std::string why = complaint(); !why.empty()) {
        host::printLine("{}; no checkpoint was written, and the journal has every step", why);
    }
    return true;
}

bool finishUnlessSignalled(UnfinishedCheckpoint& checkpoint, bool dispensable) {
    struct sigaction action {};
    action.sa_handler = [](int) { endAsked = 1; };
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGINT, &action, nullptr);
    return checkpoint.finish(dispensable, [] { return endAsked != 0; });
}

}  // namespace master
