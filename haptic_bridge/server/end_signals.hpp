// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <signal.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/system/error_code.hpp>
#include <functional>
#include <mutex>
#include <utility>

namespace haptic_bridge {

/// The signals that end the server in order: SIGINT, SIGTERM, SIGQUIT and SIGHUP. While this object lives, none of them
/// ends the process by itself, except during hold(). A second signal therefore changes nothing.
///
/// SIGHUP stays ignored if the server was started so, as nohup does. SIGPIPE is ignored from now on. Otherwise the
/// server would end in the middle of a touch when the reader of its output ends.
class EndSignals {
public:
    explicit EndSignals(boost::asio::io_context& io) : signals_(io, SIGINT, SIGTERM, SIGQUIT) {
        struct sigaction hangUp {};
        sigaction(SIGHUP, nullptr, &hangUp);
        if (hangUp.sa_handler != SIG_IGN) {
            signals_.add(SIGHUP);
        }
        signal(SIGPIPE, SIG_IGN);
        wait();
    }

    /// Calls `end` at the first signal, on the thread that runs the io context. If one has come since hold(), calls it
    /// at once. Replaces the function of an earlier call. Any thread.
    void onFirst(std::function<void()> end) {
        const std::lock_guard lock(mutex_);
        end_ = std::move(end);
        if (came_) {
            end_();
        }
    }
    /// Only notes a signal, until onFirst(), and calls `held`. When this returns, no earlier function runs. A second
    /// signal ends the process by itself, because a driver may never open its device. Any thread.
    void hold(std::function<void()> held) {
        const std::lock_guard lock(mutex_);
        end_ = {};
        held_ = std::move(held);
    }

private:
    void wait() {
        signals_.async_wait([this](boost::system::error_code error, int number) {
            if (!error) {
                came(number);
                wait();
            }
        });
    }
    void came(int number) {
        const std::lock_guard lock(mutex_);
        const bool first = !std::exchange(came_, true);
        if (!end_ && !first) {
            signal(number, SIG_DFL);
            raise(number);
        } else if (first) {
            (end_ ? end_ : held_)();
        }
    }

    boost::asio::signal_set signals_;
    std::mutex mutex_;  // of the members below
    std::function<void()> end_, held_;
    bool came_ = false;
};

}  // namespace haptic_bridge
