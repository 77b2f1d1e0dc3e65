// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/client/connector.hpp"

#include <boost/asio/connect.hpp>
#include <chrono>
#include <utility>

namespace haptic_bridge {
namespace {

using boost::system::error_code;
using tcp = boost::asio::ip::tcp;

constexpr std::chrono::milliseconds kConnectTimeout{3000};

}  // namespace

/// The handlers of an attempt hold it. The first of them that ends it has the answer.
struct Connector::Attempt {
    Attempt(const boost::asio::any_io_executor& executor, Answers whenDone)
        : socket(executor), answers(std::move(whenDone)) {}
    Socket socket;
    Answers answers;
};

void Connector::connect(const Address& address, Answers answers) {
    cancel();
    const auto attempt = std::make_shared<Attempt>(limit_.get_executor(), std::move(answers));
    attempt_ = attempt;
    limit_.expires_after(kConnectTimeout);
    limit_.async_wait([this, attempt](error_code error) {
        if (!error && attempt == attempt_) {
            end("no reply within 3 s");
        }
    });
    const auto connected = [this, attempt](error_code error, const tcp::endpoint&) {
        if (attempt == attempt_) {
            end(error ? error.message() : "");
        }
    };
    resolver_.async_resolve(address.host, std::to_string(address.port),
                            [this, attempt, connected](error_code error, const tcp::resolver::results_type& results) {
                                if (attempt != attempt_) {
                                    return;
                                }
                                if (error) {
                                    end(error.message());
                                } else {
                                    boost::asio::async_connect(attempt->socket, results, connected);
                                }
                            });
}

/// Answers the attempt. `why` it has failed is empty if it has not.
void Connector::end(const std::string& why) {
    const std::shared_ptr<Attempt> attempt = std::exchange(attempt_, nullptr);
    limit_.cancel();
    if (why.empty()) {
        attempt->answers.connected(std::move(attempt->socket));
        return;
    }
    error_code ignored;
    attempt->socket.close(ignored);
    attempt->answers.failed(why);
}

void Connector::cancel() {
    if (attempt_) {
        error_code ignored;
        attempt_->socket.close(ignored);
        attempt_ = nullptr;
    }
    resolver_.cancel();
    limit_.cancel();
}

}  // namespace haptic_bridge
