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

/// Pool of threads that run tasks. It provides the base::Executor of a program.
///
/// The thread that calls run() works too, so a pool of one has no further threads. Each free thread takes the next
/// task. A task must not throw, and must not call run() of the same pool. The threads of the pool compute with floats
/// as the sand needs it (base/float_environment.hpp). Threads: one caller of run() at a time.
class WorkerPool {
public:
    /// Throws std::invalid_argument if `threads` is outside [1, kMostThreads].
    explicit WorkerPool(int threads);
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    [[nodiscard]] int threads() const { return threads_; }
    /// Calls task(0) … task(count - 1) once each, and returns when all have returned.
    void run(int count, const std::function<void(int)>& task);
    /// Returns run() as an executor. The pool must outlive it.
    [[nodiscard]] base::Executor executor();
    /// Returns the executor for a replica of the sand, or null for a pool of one.
    [[nodiscard]] const base::Executor* lend() const { return threads_ > 1 ? &executor_ : nullptr; }

private:
    int threads_;
    base::Executor executor_;
    std::unique_ptr<boost::asio::thread_pool> helpers_;  // all threads but the caller; null for a pool of one
};

}  // namespace host
