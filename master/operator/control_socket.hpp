// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace master {

/// Whether somebody of user `peer` may command a session of user `owner`: nobody but the owner, root neither.
[[nodiscard]] constexpr bool mayCommand(uid_t peer, uid_t owner) { return peer == owner; }

/// The socket `control` in a session's folder, for its owner alone: a line of a client in, a line of JSON out, and the
/// connection ends.
///
/// A thread of its own queues lines and sends answers, and does nothing else: clients that are slow, many or talk too
/// much are sent away, and none of them reaches the frame loop.
class ControlSocket {
public:
    static constexpr const char* kName = "control";
    static constexpr std::size_t kMostClients = 16;  // at once
    static constexpr int kPatience = 5;              // [s] that a client may take to send its line, and to read

    using Client = std::uint64_t;
    struct Asked {
        Client client = 0;
        std::string line;  // at most kLongestCommand bytes
    };

    /// Replaces a socket that nobody listens at. A folder that can hold no socket is said on stderr, and so is a
    /// session that runs there already: this one then goes on without a control socket.
    explicit ControlSocket(const std::filesystem::path& folder);
    /// Who still waits for an answer finds the connection closed.
    ~ControlSocket();
    ControlSocket(const ControlSocket&) = delete;
    ControlSocket& operator=(const ControlSocket&) = delete;

    /// What was asked since this was called last.
    [[nodiscard]] std::vector<Asked> take();
    /// Answers what a client asked, with a line of JSON without its line feed. A client that has gone is forgotten.
    void answer(Client client, std::string json);

private:
    struct Guest {
        int descriptor = -1;
        std::chrono::steady_clock::time_point until;  // after which it is sent away, unless it waits for an answer
        std::string in, out;
        bool waiting = false;  // its line has been taken
    };

    [[nodiscard]] std::string open();
    void serve();
    void admit();
    void read(Client client, Guest& guest);
    void collectAnswers();
    /// Sends what it can; false when the guest is done with.
    [[nodiscard]] static bool write(Guest& guest);
    void sendAway(const std::vector<Client>& clients);

    std::filesystem::path folder_;
    int folderDescriptor_ = -1;
    int listener_ = -1;
    int wake_[2] = {-1, -1};          // a pipe that ends the poll of the thread
    std::map<Client, Guest> guests_;  // the thread's own
    Client lastClient_ = 0;
    std::mutex mutex_;
    bool ending_ = false;
    std::vector<Asked> asked_;
    std::vector<Asked> answers_;
    std::thread thread_;
};

}  // namespace master
