// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "sand/executor.hpp"

namespace bench {

/// `threads` threads, the caller among them, that share tasks out. Not for use by two callers at a time.
class ThreadPool {
public:
    explicit ThreadPool(int threads) {
        for (int i = 1; i < threads; ++i) {
            workers_.emplace_back([this] { work(); });
        }
    }
    ~ThreadPool() {
        {
            const std::lock_guard lock(mutex_);
            ending_ = true;
        }
        wake_.notify_all();
        for (std::thread& worker : workers_) {
            worker.join();
        }
    }
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    [[nodiscard]] sand::Executor executor() {
        return [this](int count, const std::function<void(int)>& task) { run(count, task); };
    }

private:
    void run(int count, const std::function<void(int)>& task) {
        // Waking others takes longer than one task does.
        if (workers_.empty() || count == 1) {
            for (int i = 0; i < count; ++i) {
                task(i);
            }
            return;
        }
        {
            const std::lock_guard lock(mutex_);
            task_ = &task;
            count_ = count;
            next_ = 0;
            busy_ = static_cast<int>(workers_.size());
            ++round_;
        }
        wake_.notify_all();
        takeTasks();
        std::unique_lock lock(mutex_);
        done_.wait(lock, [this] { return busy_ == 0; });
    }

    void takeTasks() {
        for (int i = next_++; i < count_; i = next_++) {
            (*task_)(i);
        }
    }

    void work() {
        std::unique_lock lock(mutex_);
        for (long seen = 0;;) {
            wake_.wait(lock, [&] { return ending_ || round_ != seen; });
            if (ending_) {
                return;
            }
            seen = round_;
            lock.unlock();
            takeTasks();
            lock.lock();
            if (--busy_ == 0) {
                done_.notify_one();
            }
        }
    }

    std::vector<std::thread> workers_;
    std::mutex mutex_;
    std::condition_variable wake_, done_;
    std::atomic<int> next_ = 0;
    const std::function<void(int)>* task_ = nullptr;
    int count_ = 0;
    int busy_ = 0;
    long round_ = 0;
    bool ending_ = false;
};

}  // namespace bench
