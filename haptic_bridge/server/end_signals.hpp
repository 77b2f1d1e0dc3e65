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
/// ends the process by itself. A second signal therefore changes nothing.
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
        signals_.async_wait([this](boost::system::error_code error, int) {
            if (!error) {
                came();
            }
        });
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
    /// Only notes a signal, until onFirst(). When this returns, no earlier function runs. Any thread.
    void hold() {
        const std::lock_guard lock(mutex_);
        end_ = {};
    }

private:
    void came() {
        const std::lock_guard lock(mutex_);
        came_ = true;
        if (end_) {
            end_();
        }
    }

    boost::asio::signal_set signals_;
    std::mutex mutex_;  // of the two below
    std::function<void()> end_;
    bool came_ = false;
};

}  // namespace haptic_bridge
