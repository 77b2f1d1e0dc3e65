// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "base/executor.hpp"

namespace boost::asio {
class thread_pool;
}  // namespace boost::asio

namespace host {

inline constexpr int kMostThreads = 256;

/// Threads of a program that share out the tasks it is given: what a base::Executor stands for.
///
/// The thread that calls run() works too, so that a pool of one is no pool. Tasks are taken in turn by whoever is free.
/// A task must not throw, and must not call run() of the same pool; run() is for one thread at a time.
class WorkerPool {
public:
    /// Throws std::invalid_argument when `threads` is outside [1, kMostThreads].
    explicit WorkerPool(int threads);
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    [[nodiscard]] int threads() const { return threads_; }
    /// Calls task(0) … task(count - 1) once each, and returns when all have returned.
    void run(int count, const std::function<void(int)>& task);
    /// run() of this pool, which must outlive it.
    [[nodiscard]] base::Executor executor();
    /// The same for sand::Erosion::Options, or null for a pool of one.
    [[nodiscard]] const base::Executor* lend() const { return threads_ > 1 ? &executor_ : nullptr; }

private:
    int threads_;
    base::Executor executor_;
    std::unique_ptr<boost::asio::thread_pool> helpers_;  // all but the caller; null when there are none
};

}  // namespace host
