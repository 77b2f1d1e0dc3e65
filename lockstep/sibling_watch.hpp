// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace lockstep {

/// Thread that notices, while MPI starts, that another process of the job on this host has ended.
///
/// mpirun ends a job when one of its processes fails. But Open MPI 4.1 may lose the end of a process that ends in its
/// first instant, for example by a signal. It then waits for this process without an end, and all others wait in
/// MPI_Init or in their first messages. No process of a job ends before all have exchanged these, so that a missing one
/// is always a failure.
///
/// Only the first two processes of a host watch. A process without mpirun, or without /proc, watches nothing.
class SiblingWatch {
public:
    /// Calls `missing` once if fewer processes of the job run on this host than mpirun has announced, and mpirun has
    /// slept for a while. `missing` runs on the thread, and need not return.
    explicit SiblingWatch(std::function<void()> missing);
    /// Ends the watch. `missing` is not called afterwards.
    ~SiblingWatch();
    SiblingWatch(const SiblingWatch&) = delete;
    SiblingWatch& operator=(const SiblingWatch&) = delete;

private:
    void watch(int announced, int patience);

    std::function<void()> missing_;
    std::mutex mutex_;
    std::condition_variable stop_;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace lockstep
