// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <functional>
#include <mutex>
#include <string>

namespace haptic_bridge {

/// Takes the exceptions of the server's threads to its main thread. Without it, an exception would end the process at
/// once, and an arm would hold its last force.
///
/// Only the first failure counts, because it may be the reason for others. Threads: every member function may be called
/// by any thread, except onFailure().
class FirstFailure {
public:
    /// Sets what the first failure calls, on the thread that fails, so that the main thread ends its work. `wake` must
    /// not throw. Call this before threads begin.
    void onFailure(std::function<void()> wake) { wake_ = std::move(wake); }

    /// Calls work(). Returns whether it returned, and keeps its exception otherwise. `name` is that of the device or
    /// the thread for the user.
    template <class Work>
    bool run(const std::string& name, const Work& work) noexcept {
        try {
            work();
            return true;
        } catch (...) {
            keep(name, std::current_exception());
            return false;
        }
    }
    /// If a thread has failed, throws std::runtime_error. Its one line names who failed, and the reason.
    void rethrow() const;

private:
    void keep(const std::string& name, const std::exception_ptr& error) noexcept;

    std::function<void()> wake_;
    mutable std::mutex mutex_;
    bool failed_ = false;
    std::string line_;
};

}  // namespace haptic_bridge
