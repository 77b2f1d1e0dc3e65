// SPDX-License-Identifier: Apache-2.0
#include "host/phase_progress.hpp"

#include <fmt/format.h>

#include <utility>

#include "host/event.hpp"

namespace host {

namespace {

constexpr std::int64_t kFirstNs = 2'000'000'000, kNextNs = 10'000'000'000;

}  // namespace

PhaseProgress::PhaseProgress(std::string name, std::string what, std::function<void(const std::string&)> print,
                             Clock clock)
    : name_(std::move(name)),
      what_(std::move(what)),
      print_(std::move(print)),
      now_(std::move(clock)),
      dueNs_(now_() + kFirstNs) {}

void PhaseProgress::done(double share) {
    const std::int64_t now = now_();
    if (now < dueNs_) {
        return;
    }
    dueNs_ = now + kNextNs;
    print_(fmt::format("{}: {:.0f} %", what_, 100 * share));
    emitEvent("phase", {{"phase", name_}, {"share", share}});
}

}  // namespace host
