// SPDX-License-Identifier: Apache-2.0
#include "master/journal/background_replay.hpp"

#include <exception>
#include <stdexcept>
#include <utility>

#include "host/priority.hpp"

namespace master {
namespace {

/// Returns the hashes, computed again from all memory. Throws std::runtime_error if the memory of the replay itself
/// is corrupt, because such a replay must not outvote a majority.
BackgroundReplay::Proven proven(RestoredSand& restored) {
    sand::Replica& sand = restored.replica;
    const std::uint64_t hash = sand.stateHash();
    sand.audit(sand.hashTiles().tileCount());
    if (sand.stateHash() != hash || sand.volume() + sand.outflow() != restored.volume) {
        throw std::runtime_error("the replayed sand is not the sum of its steps: its memory may be faulty");
    }
    return {hash, sand.movementDigest()};
}

}  // namespace

BackgroundReplay::BackgroundReplay(std::filesystem::path journal, std::uint64_t step, std::uint64_t newestCheckpoint)
    : journal_(std::move(journal)), newestCheckpoint_(newestCheckpoint), wanted_(step), thread_([this] { run(); }) {}

BackgroundReplay::~BackgroundReplay() { stop(); }

void BackgroundReplay::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) {
        thread_.join();
    }
}

void BackgroundReplay::continueTo(std::uint64_t step) {
    {
        const std::lock_guard lock(mutex_);
        if (step > wanted_) {
            wanted_ = step;
            progress_.proven.reset();
        }
    }
    wake_.notify_all();
}

BackgroundReplay::Progress BackgroundReplay::progress() const {
    const std::lock_guard lock(mutex_);
    return progress_;
}

std::unique_ptr<sand::Replica> BackgroundReplay::take() {
    stop();
    return std::move(sand_);
}

std::uint64_t BackgroundReplay::awaitNext(RestoredSand& restored) {
    const Proven hashes = proven(restored);
    const std::uint64_t step = restored.replica.stepNumber();
    std::unique_lock lock(mutex_);
    progress_.step = step;
    if (wanted_ == step) {
        progress_.proven = hashes;
    }
    wake_.wait(lock, [&] { return stopping_ || wanted_ != step; });
    return wanted_;
}

void BackgroundReplay::run() {
    host::lowerPriority();
    const Restoring how{
        .newestCheckpoint = newestCheckpoint_, .beingWritten = true, .each = [this](std::uint64_t step) {
            const std::lock_guard lock(mutex_);
            progress_.step = step;
            if (stopping_) {
                throw Stopped();
            }
        }};
    try {
        std::uint64_t step = 0;
        {
            const std::lock_guard lock(mutex_);
            step = wanted_;
        }
        RestoredSand restored = restoreSand(journal_, step, how);
        while ((step = awaitNext(restored)) != restored.replica.stepNumber()) {
            replayFurther(journal_, step, restored, how);
        }
        sand_ = std::make_unique<sand::Replica>(std::move(restored.replica));
    } catch (const Stopped&) {
        return;
    } catch (const std::exception& error) {  // caught, because the session can continue without the replay
        const std::lock_guard lock(mutex_);
        progress_.error = error.what();
    }
}

}  // namespace master
