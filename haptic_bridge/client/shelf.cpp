// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/client/shelf.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace haptic_bridge {
namespace {

constexpr std::size_t kMaxTests = 64;    // a wall that shows no frames answers no tests
constexpr std::size_t kPieceBytes = 64;  // [byte], overhead of a piece

}  // namespace

void Shelf::setStatus(Link link, const std::string& message) {
    const std::lock_guard lock(mutex_);
    if (status_.changes == 0 || status_.link != link || status_.message != message) {
        needsState_ = needsState_ && status_.link == link;
        status_ = {link, message, status_.changes + 1, status_.loaded};
    }
}

void Shelf::setLoaded(std::uint32_t done) {
    const std::lock_guard lock(mutex_);
    status_.loaded = done;
}

LinkStatus Shelf::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

bool Shelf::beginGranting() {
    const std::lock_guard lock(mutex_);
    if (status_.link != Link::offered) {
        return false;
    }
    status_.link = Link::granting;
    needsState_ = false;
    steps_.clear();
    return true;
}

void Shelf::askForState() {
    const std::lock_guard lock(mutex_);
    needsState_ = status_.link == Link::granting;
}

bool Shelf::needsState() const {
    const std::lock_guard lock(mutex_);
    return needsState_;
}

bool Shelf::beginGivingState() {
    const std::lock_guard lock(mutex_);
    return std::exchange(needsState_, false);
}

bool Shelf::add(TimedStep step) {
    const std::lock_guard lock(mutex_);
    ++counters_.stepsIn;
    steps_.push_back(std::move(step));
    full_ = steps_.size() >= Client::kMaxQueued;
    return full_;
}

void Shelf::addTest(std::uint32_t id, std::uint64_t after) {
    const std::lock_guard lock(mutex_);
    tests_.push_back({id, after});
    if (tests_.size() > kMaxTests) {
        tests_.pop_front();
    }
}

void Shelf::dropTests() {
    const std::lock_guard lock(mutex_);
    tests_.clear();
    testsInFrame_.clear();
}

std::vector<TimedStep> Shelf::drain(std::size_t most, bool& resume) {
    std::vector<TimedStep> steps;
    const std::lock_guard lock(mutex_);
    const std::size_t count = std::min(most, steps_.size());
    const auto end = steps_.begin() + static_cast<std::ptrdiff_t>(count);
    steps.assign(std::make_move_iterator(steps_.begin()), std::make_move_iterator(end));
    steps_.erase(steps_.begin(), end);
    const std::uint64_t next = steps_.empty() ? ~std::uint64_t{0} : steps_.front().step.number;
    while (!tests_.empty() && tests_.front().after < next) {
        if (testsInFrame_.size() < kMaxTests) {
            testsInFrame_.push_back(tests_.front().id);
        }
        tests_.pop_front();
    }
    resume = full_ && steps_.size() < Client::kMaxQueued;
    full_ = full_ && !resume;
    return steps;
}

std::vector<std::uint32_t> Shelf::takeTestsInFrame() {
    const std::lock_guard lock(mutex_);
    return std::exchange(testsInFrame_, {});
}

bool Shelf::add(TimedPosition position) {
    const std::lock_guard lock(mutex_);
    positions_.push_back(position);
    const bool since = positions_.size() >= Client::kMaxPositions && !full_;
    full_ = full_ || since;
    floods_ += since ? 1 : 0;
    return since;
}

void Shelf::dropPositions() {
    const std::lock_guard lock(mutex_);
    positions_.clear();
}

std::vector<TimedPosition> Shelf::drainPositions(bool& resume) {
    const std::lock_guard lock(mutex_);
    resume = std::exchange(full_, false);
    return std::exchange(positions_, {});
}

std::uint64_t Shelf::floods() const {
    const std::lock_guard lock(mutex_);
    return floods_;
}

bool Shelf::full() const {
    const std::lock_guard lock(mutex_);
    return full_;
}

void Shelf::addTicks(base::Bytes piece) {
    const std::lock_guard lock(mutex_);
    const std::size_t bytes = piece.size() + kPieceBytes;
    if (tickBytes_ + bytes <= Client::kMaxTicks) {
        tickBytes_ += bytes;
        ticks_.push_back(std::move(piece));
    }
}

std::vector<base::Bytes> Shelf::drainTicks() {
    const std::lock_guard lock(mutex_);
    tickBytes_ = 0;
    return std::exchange(ticks_, {});
}

void Shelf::keep(const Report& report) {
    const std::lock_guard lock(mutex_);
    report_ = report;
}

std::optional<Report> Shelf::report() const {
    const std::lock_guard lock(mutex_);
    return report_;
}

void Shelf::fail(const std::string& why) {
    const std::lock_guard lock(mutex_);
    failure_ = why;
}

std::string Shelf::failure() const {
    const std::lock_guard lock(mutex_);
    return failure_;
}

void Shelf::linked() {
    const std::lock_guard lock(mutex_);
    failure_.clear();
    if (report_) {
        report_->audited = Audited::no;
    }
}

void Shelf::setClockOffset(std::int64_t ns) {
    const std::lock_guard lock(mutex_);
    clockOffsetNs_ = ns;
}

std::int64_t Shelf::clockOffsetNs() const {
    const std::lock_guard lock(mutex_);
    return clockOffsetNs_;
}

void Shelf::setStepsPerSecond(std::uint32_t steps) {
    const std::lock_guard lock(mutex_);
    stepsPerSecond_ = steps;
}

std::uint32_t Shelf::stepsPerSecond() const {
    const std::lock_guard lock(mutex_);
    return stepsPerSecond_;
}

void Shelf::setForceCeiling(double share) {
    const std::lock_guard lock(mutex_);
    forceCeiling_ = share;
}

std::optional<double> Shelf::forceCeiling() const {
    const std::lock_guard lock(mutex_);
    return status_.link == Link::linked ? std::optional(forceCeiling_) : std::nullopt;
}

LinkCounters Shelf::counters() const {
    const std::lock_guard lock(mutex_);
    return counters_;
}

}  // namespace haptic_bridge
