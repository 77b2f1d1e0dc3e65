// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <signal.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <functional>
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
    }

    /// Calls `end` at the first signal, on the thread that runs the io context. Also at one that has come before.
    void onFirst(std::function<void()> end) {
        signals_.async_wait([end = std::move(end)](boost::system::error_code error, int) {
            if (!error) {
                end();
            }
        });
    }

private:
    boost::asio::signal_set signals_;
};

}  // namespace haptic_bridge
