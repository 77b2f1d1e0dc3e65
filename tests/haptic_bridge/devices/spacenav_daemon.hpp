// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace test {

inline const std::string kSpnavLibrary = SANDWALL_BIN_DIR "/fake-spnav.so";  // speaks to a SpacenavDaemon

/// A spacenavd whose cap a test pushes. Its socket is at $SPNAV_SOCKET of this process and of those that it starts.
///
/// Like the real one, it sends an event only when something changes, and answers questions unless it is of version 0.
/// Threads: a test calls it from one thread.
class SpacenavDaemon {
public:
    explicit SpacenavDaemon(std::string path, int version = 1) : path_(std::move(path)), version_(version) {
        setenv("SPNAV_SOCKET", path_.c_str(), 1);
        start();
    }
    ~SpacenavDaemon() {
        end();
        unsetenv("SPNAV_SOCKET");
    }
    SpacenavDaemon(const SpacenavDaemon&) = delete;
    SpacenavDaemon& operator=(const SpacenavDaemon&) = delete;

    void start() {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::copy_n(path_.begin(), std::min(path_.size(), sizeof address.sun_path - 1), address.sun_path);
        listening_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (bind(listening_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
            listen(listening_, 4) != 0) {
            throw std::runtime_error("the stand-in of spacenavd cannot listen at " + path_);
        }
        ending_ = false;
        thread_ = std::thread([this] { serve(); });
    }
    /// Ends without a last event, as when a daemon is stopped while the cap is pushed.
    void end() {
        if (!thread_.joinable()) {
            return;
        }
        ending_ = true;
        thread_.join();
        for (const int client : clients_) {
            close(client);
        }
        clients_.clear();
        close(listening_);
        unlink(path_.c_str());
    }
    /// While it hangs, it neither answers nor ends.
    void hang(bool hangs) { hangs_ = hangs; }
    /// Sends an event to each client that comes from now on, before it answers.
    void greetWithAnEvent(bool greets) { greets_ = greets; }

    void push(int right, int up, int away) { send({kMotion, right, up, away, 0, 0, 0, 16}); }
    void button(int number, bool down) { send({down ? kPress : kRelease, number, down ? 1 : 0, 0, 0, 0, 0, 0}); }
    void unplug() { send({kDevice, 1, 0, 0, 0, 0, 0, 0}); }
    /// Return the number of clients, the number of clients that got an answer, and the number of answered questions.
    [[nodiscard]] int clients() const { return came_; }
    [[nodiscard]] int links() const { return links_; }
    [[nodiscard]] int answers() const { return answers_; }

private:
    enum Type : std::int32_t { kMotion = 0, kPress = 1, kRelease = 2, kDevice = 3 };
    using Packet = std::array<std::int32_t, 8>;

    void send(const Packet& packet) {
        const std::lock_guard lock(mutex_);
        for (const int client : clients_) {
            (void)::send(client, packet.data(), sizeof packet, MSG_NOSIGNAL);
        }
    }
    void serve() {
        while (!ending_) {
            pollfd wanted{listening_, POLLIN, 0};
            if (poll(&wanted, 1, 1) > 0 && !hangs_) {
                const int client = accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
                const std::lock_guard lock(mutex_);
                clients_.push_back(client);
                ++came_;
                if (greets_) {
                    const Packet event{kMotion, 350, 0, 0, 0, 0, 0, 16};
                    (void)::send(client, event.data(), sizeof event, MSG_NOSIGNAL);
                }
            }
            const std::lock_guard lock(mutex_);
            for (const int client : clients_) {
                if (!hangs_ && version_ >= 1) {
                    answer(client);
                }
            }
        }
    }
    /// Answers a packet of one word, which asks for a protocol, or of eight words.
    void answer(int client) {
        Packet packet{};
        const auto length = recv(client, packet.data(), sizeof packet, MSG_DONTWAIT);
        if (length > 0) {
            (void)::send(client, packet.data(), static_cast<std::size_t>(length), MSG_NOSIGNAL);
            ++(length == sizeof packet ? answers_ : links_);
        }
    }

    std::string path_;
    int version_;
    int listening_ = -1;
    std::mutex mutex_;  // of clients_
    std::vector<int> clients_;
    std::atomic<bool> ending_{false}, hangs_{false}, greets_{false};
    std::atomic<int> came_{0}, links_{0}, answers_{0};
    std::thread thread_;
};

}  // namespace test
