// SPDX-License-Identifier: Apache-2.0
// Faults of the link on purpose.
#include <algorithm>
#include <boost/asio/post.hpp>
#include <random>

#include "haptic_bridge/client/connection_thread.hpp"

namespace haptic_bridge {

void Client::Session::drill(LinkDrill drill, std::chrono::milliseconds length) {
    boost::asio::post(io_, [this, drill, length] {
        if (!connection_) {
            return;
        }
        if (drill == LinkDrill::garbage) {
            std::minstd_rand noise;
            base::Bytes bytes(4096);
            std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<std::uint8_t>(noise() >> 8); });
            connection_->sendBytes(std::move(bytes));
            return;
        }
        connection_->pause();
        silentUntil_ = std::chrono::steady_clock::now() + length;
        drillTimer_.expires_at(silentUntil_);
        drillTimer_.async_wait([this](boost::system::error_code error) {
            if (!error && connection_) {
                connection_->resume();
            }
        });
    });
}

bool Client::Session::silent() const { return std::chrono::steady_clock::now() < silentUntil_; }

}  // namespace haptic_bridge
