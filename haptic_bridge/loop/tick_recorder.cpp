// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/tick_recorder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "base/input_error.hpp"

namespace haptic_bridge {
namespace {

using namespace std::chrono_literals;

constexpr auto kPoll = 5ms;
constexpr std::size_t kMostPieces = 4096;  // a master that takes none is not there any more

}  // namespace

TickRecorder::TickRecorder(Options options, const HapticTick& hand)
    : options_(std::move(options)), hand_(hand), header_(headerOf(hand)) {
    descriptor_ = open(options_.file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor_ < 0) {
        throw base::InputError(fmt::format("--record {}: cannot be made ({}); give a file in a folder that is there",
                                           options_.file, std::strerror(errno)));
    }
    rows_ = tickTitles();
    thread_ = std::thread([this] { run(); });
}

TickRecorder::~TickRecorder() {
    stopping_ = true;
    thread_.join();
    if (descriptor_ >= 0) {
        close(descriptor_);
    }
}

void TickRecorder::begin() {
    Entry entry;
    entry.begins = true;
    push(entry);
}

void TickRecorder::add() { push({false, hand_.lastTick(), hand_.lastInput()}); }

void TickRecorder::push(const Entry& entry) {
    bool there = queue_.push(entry);
    while (!there && options_.wait && !stopping_) {
        std::this_thread::sleep_for(1ms);
        there = queue_.push(entry);
    }
    (there ? added_ : lost_).fetch_add(1, std::memory_order_release);
}

void TickRecorder::run() {
    bool last = false;
    while (!last) {
        last = stopping_;
        std::uint64_t taken = 0;
        queue_.consume_all([&](const Entry& entry) {
            take(entry);
            ++taken;
        });
        endPiece();
        writeRows();
        done_.fetch_add(taken, std::memory_order_release);
        if (const std::uint64_t lost = lost_; lost != toldLost_ && (toldLost_ == 0 || last)) {
            options_.log(
                fmt::format("--record {}: {} ticks could not be kept in time and are missing", options_.file, lost));
            toldLost_ = lost;
        }
        if (!last) {
            std::this_thread::sleep_for(kPoll);
        }
    }
}

void TickRecorder::take(const Entry& entry) {
    if (entry.begins) {
        endPiece();
        const TrackPiece header{++piece_.sitting, true, header_, {}};
        const std::lock_guard lock(mutex_);
        pieces_.clear();  // of a link that is gone
        pieces_.push_back(encode(header));
        return;
    }
    appendRow(entry.tick, rows_);
    piece_.ticks.push_back(entry.input);
    if (piece_.ticks.size() == kMostTicksInPiece) {
        endPiece();
    }
}

void TickRecorder::endPiece() {
    if (piece_.ticks.empty()) {
        return;
    }
    base::Bytes bytes = encode(piece_);
    piece_.ticks.clear();
    const std::lock_guard lock(mutex_);
    if (pieces_.size() < kMostPieces) {
        pieces_.push_back(std::move(bytes));
    }
}

void TickRecorder::writeRows() {
    std::size_t done = 0;
    while (descriptor_ >= 0 && done < rows_.size()) {
        const ssize_t count = write(descriptor_, rows_.data() + done, rows_.size() - done);
        if (count < 0 && errno != EINTR) {
            giveUp(errno);
            break;
        }
        done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    size_ += static_cast<std::int64_t>(rows_.size());
    rows_.clear();
}

void TickRecorder::giveUp(int error) {
    // What did get there may be half a row: the file then ends with the last whole one.
    [[maybe_unused]] const int cut = ftruncate(descriptor_, size_);
    close(descriptor_);
    descriptor_ = -1;
    options_.log(fmt::format("--record {}: cannot be written ({}); it ends here, and the session goes on",
                             options_.file, std::strerror(error)));
}

std::vector<base::Bytes> TickRecorder::takePieces() {
    const std::lock_guard lock(mutex_);
    return std::exchange(pieces_, {});
}

void TickRecorder::flush() {
    const std::uint64_t wanted = added_.load(std::memory_order_acquire);
    const int longest = options_.wait ? 30'000 : 300;  // [ms]
    for (int i = 0; i < longest && done_.load(std::memory_order_acquire) < wanted; ++i) {
        std::this_thread::sleep_for(1ms);
    }
}

}  // namespace haptic_bridge
