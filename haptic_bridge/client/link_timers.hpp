// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <utility>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/client/clock_offset.hpp"
#include "haptic_bridge/link/silence.hpp"

/// Timers of the master's end of a link. Each belongs to the network thread.
namespace haptic_bridge {

/// The pauses before the master connects again: 0.1 s, and then twice the pause before, at most 2 s.
class RetryPause {
public:
    explicit RetryPause(boost::asio::io_context& io) : timer_(io) {}

    /// Call it when a link has begun at `nowNs` [ns].
    void linked(std::int64_t nowNs) { linkedNs_ = nowNs; }
    /// Call it when a link that had begun has ended. A server that ends each link at once is asked as rarely as one
    /// that does not answer.
    void lost(std::int64_t nowNs) { pause_ = nowNs - linkedNs_ >= kLastingNs ? kFirst : pause_; }
    /// Makes the next pause the longest.
    void lengthen() { pause_ = kLast; }
    /// Calls `connect` after the pause.
    void start(std::function<void()> connect) {
        timer_.expires_after(pause_);
        pause_ = std::min(pause_ * 2, kLast);
        timer_.async_wait([connect = std::move(connect)](boost::system::error_code error) {
            if (!error) {
                connect();
            }
        });
    }
    void cancel() { timer_.cancel(); }

private:
    static constexpr std::chrono::milliseconds kFirst{100}, kLast{2000};
    static constexpr std::int64_t kLastingNs = 1'000'000'000;  // [ns]

    boost::asio::steady_timer timer_;
    std::chrono::milliseconds pause_ = kFirst;
    std::int64_t linkedNs_ = 0;
};

/// Finds out that the server is silent.
class SilenceWatch {
public:
    SilenceWatch(boost::asio::io_context& io, LinkClock clock) : timer_(io), now_(std::move(clock)) {}

    void heard() { silence_.heard(now_()); }
    /// Sets after how long the server counts as silent; kSilenceNs from the start on.
    void setMost(std::int64_t most /* [ns] */) { most_ = most; }
    [[nodiscard]] std::int64_t most() const { return most_; }
    /// Counts from now on. Calls `silent` if nothing was heard for most(). While excused() is true, the server counts
    /// as heard.
    void start(std::function<bool()> excused, std::function<void()> silent) {
        heard();
        most_ = kSilenceNs;
        excused_ = std::move(excused);
        silent_ = std::move(silent);
        active_ = true;
        look();
    }
    void cancel() {
        active_ = false;  // because a handler that is already due is not cancelled
        timer_.cancel();
    }

private:
    void look() {
        timer_.expires_after(std::chrono::milliseconds(500));
        timer_.async_wait([this](boost::system::error_code error) {
            if (error || !active_) {
                return;
            }
            const std::int64_t now = now_();
            if (excused_()) {
                silence_.heard(now);
            }
            if (silence_.lengthNs(now) > most_) {
                silent_();
            } else {
                look();
            }
        });
    }

    boost::asio::steady_timer timer_;
    LinkClock now_;
    Silence silence_;  // on now_
    std::int64_t most_ = kSilenceNs;
    std::function<bool()> excused_;
    std::function<void()> silent_;
    bool active_ = false;
};

/// Asks for the server's clock, and estimates how far it is ahead of the master's.
class Pings {
public:
    explicit Pings(boost::asio::io_context& io) : timer_(io) {}

    /// Forgets the answers of an earlier server. Calls `send` whenever a Ping is due.
    void start(std::function<void()> send) {
        sent_ = 0;
        offset_ = {};
        send_ = std::move(send);
        active_ = true;
        wait();
    }
    void cancel() {
        active_ = false;  // because a handler that is already due is not cancelled
        timer_.cancel();
    }
    /// Takes an answer. Returns the estimate: server's clock − master's clock [ns].
    [[nodiscard]] std::int64_t answered(const Pong& pong, std::int64_t receivedNs) {
        offset_.add(pong.masterNs, pong.serverNs, receivedNs);
        return offset_.offsetNs();
    }

private:
    void wait() {
        // Pings are frequent at first, so that the clock offset is known within the first frames.
        timer_.expires_after(std::chrono::milliseconds(sent_ < 8 ? 10 : 250));
        timer_.async_wait([this](boost::system::error_code error) {
            if (!error && active_) {
                ++sent_;
                wait();  // before it sends, because sending may end the link, which cancels the wait
                send_();
            }
        });
    }

    boost::asio::steady_timer timer_;
    int sent_ = 0;
    ClockOffset offset_;
    std::function<void()> send_;
    bool active_ = false;
};

/// A drill during which the client neither reads nor sends.
class SilenceDrill {
public:
    explicit SilenceDrill(boost::asio::io_context& io) : timer_(io) {}

    /// Begins the silence. Calls `resume` at its end.
    void start(std::chrono::milliseconds length, std::function<void()> resume) {
        until_ = std::chrono::steady_clock::now() + length;
        timer_.expires_at(until_);
        timer_.async_wait([resume = std::move(resume)](boost::system::error_code error) {
            if (!error) {
                resume();
            }
        });
    }
    /// Ends it, because the connection has ended.
    void forget() { until_ = {}; }
    [[nodiscard]] bool active() const { return std::chrono::steady_clock::now() < until_; }

private:
    boost::asio::steady_timer timer_;
    std::chrono::steady_clock::time_point until_;
};

}  // namespace haptic_bridge
