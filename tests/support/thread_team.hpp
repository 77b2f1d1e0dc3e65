// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <barrier>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

#include "sand/executor.hpp"

namespace samples {

/// Threads that take the tasks of a loop as they come, the caller among them: for tests of what must not depend on
/// order. Not thread-safe: one loop at a time. Tasks must not throw.
class ThreadTeam {
public:
    explicit ThreadTeam(int threads) : start_(threads), end_(threads) {
        for (int i = 1; i < threads; ++i) {
            others_.emplace_back([this] { serve(); });
        }
    }
    ~ThreadTeam() {
        task_ = nullptr;
        start_.arrive_and_wait();
    }
    ThreadTeam(const ThreadTeam&) = delete;
    ThreadTeam& operator=(const ThreadTeam&) = delete;

    /// Calls task(0) … task(count - 1) and returns when all have returned.
    void run(int count, const std::function<void(int)>& task) {
        task_ = &task;
        count_ = count;
        next_ = 0;
        start_.arrive_and_wait();
        takeTasks();
        end_.arrive_and_wait();
    }

    /// Refers to the team, which must outlive it.
    [[nodiscard]] sand::Executor executor() {
        return [this](int count, const std::function<void(int)>& task) { run(count, task); };
    }

private:
    void serve() {
        for (start_.arrive_and_wait(); task_ != nullptr; start_.arrive_and_wait()) {
            takeTasks();
            end_.arrive_and_wait();
        }
    }
    void takeTasks() {
        for (int i = next_++; i < count_; i = next_++) {
            (*task_)(i);
        }
    }

    // The barriers order these between the caller and the others.
    const std::function<void(int)>* task_ = nullptr;
    int count_ = 0;
    std::atomic<int> next_ = 0;
    std::barrier<> start_, end_;
    std::vector<std::jthread> others_;  // last: joined before anything else ends
};

}  // namespace samples
