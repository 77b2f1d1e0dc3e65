// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <thread>
#include <vector>

namespace master {

/// Returns an answer as one line of JSON. Bytes that are not UTF-8, which a user may type, are replaced.
[[nodiscard]] std::string answerLine(const nlohmann::json& answer);

/// Returns whether a client of user `peer` may command a session of user `owner`. Only the owner may; root may not.
[[nodiscard]] constexpr bool mayCommand(uid_t peer, uid_t owner) { return peer == owner; }

/// The socket `control` in a session's folder, which only the session's owner may use. A client sends one line and gets
/// one line of JSON. Then the connection ends.
///
/// A thread of its own queues the lines and sends the answers. It closes the connections of clients that are slow, too
/// many or send too much. Such clients never delay the frame loop.
class ControlSocket {
public:
    static constexpr const char* kName = "control";
    static constexpr std::size_t kMostClients = 16;  // at once
    static constexpr int kPatience = 5;              // [s], time for a client to send its line, and to read the answer

    using Client = std::uint64_t;
    struct Asked {
        Client client = 0;
        std::string line;  // at most kLongestCommand bytes
    };

    /// Makes the socket in `folder`. Replaces a socket at which no process listens. Prints a line on standard error if
    /// the folder cannot hold a socket, or if another session runs there. The session then continues without a control
    /// socket.
    explicit ControlSocket(const std::filesystem::path& folder);
    /// Closes the connections of clients that still wait for an answer.
    ~ControlSocket();
    ControlSocket(const ControlSocket&) = delete;
    ControlSocket& operator=(const ControlSocket&) = delete;

    /// Returns the lines that clients have sent since the last call.
    [[nodiscard]] std::vector<Asked> take();
    /// Sends the line `json` to a client as its answer. `json` has no line feed. Ignored if the client has closed its
    /// connection.
    void answer(Client client, std::string json);

private:
    struct Connection {
        int descriptor = -1;
        std::chrono::steady_clock::time_point until;  // the connection is closed then, unless it waits for an answer
        std::string in, out;
        bool waiting = false;  // whether the client's line has been read
    };

    [[nodiscard]] std::string open();
    void serve();
    void admit();
    void read(Client client, Connection& connection);
    void collectAnswers();
    /// Sends as much of the answer as possible. Returns false if all is sent or the connection is broken.
    [[nodiscard]] static bool write(Connection& connection);
    void sendAway(const std::vector<Client>& clients);

    std::filesystem::path folder_;
    int folderDescriptor_ = -1;
    int listener_ = -1;
    int wake_[2] = {-1, -1};                    // a pipe that ends the poll of the thread
    std::map<Client, Connection> connections_;  // the thread's own
    Client lastClient_ = 0;
    std::mutex mutex_;
    bool ending_ = false;
    std::vector<Asked> asked_;
    std::vector<Asked> answers_;
    std::thread thread_;
};

}  // namespace master
