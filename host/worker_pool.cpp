// SPDX-License-Identifier: Apache-2.0
#include "host/worker_pool.hpp"

#include <algorithm>
#include <atomic>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <latch>
#include <stdexcept>

#include "base/float_environment.hpp"

namespace host {

WorkerPool::WorkerPool(int threads) : threads_(threads), executor_(executor()) {
    if (threads < 1 || threads > kMostThreads) {
        throw std::invalid_argument("WorkerPool: number of threads out of range");
    }
    if (threads > 1) {
        helpers_ = std::make_unique<boost::asio::thread_pool>(static_cast<std::size_t>(threads - 1));
    }
}

WorkerPool::~WorkerPool() {
    if (helpers_ != nullptr) {
        helpers_->join();
    }
}

void WorkerPool::run(int count, const std::function<void(int)>& task) {
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int i = next.fetch_add(1); i < count; i = next.fetch_add(1)) {
            task(i);
        }
    };
    const int helpers = std::clamp(count - 1, 0, threads_ - 1);
    std::latch done(helpers);
    for (int i = 0; i < helpers; ++i) {
        boost::asio::post(*helpers_, [&work, &done] {
            (void)base::needDefaultFloats();  // the thread that made the pool may have loaded anything before
            work();
            done.count_down();
        });
    }
    work();
    done.wait();
}

base::Executor WorkerPool::executor() {
    return [this](int count, const std::function<void(int)>& task) { run(count, task); };
}

}  // namespace host
