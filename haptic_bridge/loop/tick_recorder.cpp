// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/tick_recorder.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace haptic_bridge {
namespace {

using namespace std::chrono_literals;

constexpr auto kPoll = 5ms;
// [byte] of pieces that may wait for the master, some 10 s of a hand. The server sends them all before its next step,
// and its connection ends if more than 1 MiB waits to be sent. So a session may be paused while ticks are recorded.
constexpr std::size_t kMostBytes = 768 * 1024;
constexpr std::size_t kPieceMessage = 16;  // [byte], more than the header of a message with a piece

}  // namespace

TickRecorder::TickRecorder(Options options, const HapticTick& hand, FirstFailure& failure)
    : options_(std::move(options)), hand_(hand), header_(headerOf(hand)), file_(options_.file, options_.log) {
    thread_ = std::thread([this, &failure] {
        if (!failure.run("the recorder of ticks", [this] { run(); })) {
            stopping_ = true;  // no thread waits for a recorder that has failed
        }
    });
}

TickRecorder::~TickRecorder() {
    stopping_ = true;
    thread_.join();
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
        file_.write();
        done_.fetch_add(taken, std::memory_order_release);
        if (const std::uint64_t lost = lost_; lost != printedLost_ && (printedLost_ == 0 || last)) {
            options_.log(
                fmt::format("--record {}: {} ticks could not be written in time and are missing", options_.file, lost));
            printedLost_ = lost;
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
        pieces_.clear();  // pieces of a previous link
        pieceBytes_ = 0;
        pieces_.push_back(encode(header));
        return;
    }
    file_.add(entry.tick);
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
    const std::size_t more = bytes.size() + kPieceMessage;
    if (pieceBytes_ + more <= kMostBytes) {
        pieceBytes_ += more;
        pieces_.push_back(std::move(bytes));
    }
}

std::vector<base::Bytes> TickRecorder::takePieces() {
    const std::lock_guard lock(mutex_);
    pieceBytes_ = 0;
    return std::exchange(pieces_, {});
}

void TickRecorder::flush() {
    const std::uint64_t wanted = added_.load(std::memory_order_acquire);
    const int longest = options_.wait ? 30'000 : 300;  // [ms]
    for (int i = 0; i < longest && !stopping_ && done_.load(std::memory_order_acquire) < wanted; ++i) {
        std::this_thread::sleep_for(1ms);
    }
}

}  // namespace haptic_bridge
