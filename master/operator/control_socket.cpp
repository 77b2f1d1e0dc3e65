// SPDX-License-Identifier: Apache-2.0
#include "master/operator/control_socket.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "host/print_line.hpp"
#include "master/operator/verb_arguments.hpp"

namespace master {
namespace {

using Clock = std::chrono::steady_clock;

/// Returns the socket's address by way of its folder's descriptor. A socket's path holds only 107 bytes, and the
/// folder's path may be longer.
sockaddr_un addressIn(int folder) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = fmt::format("/proc/self/fd/{}/{}", folder, ControlSocket::kName);
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    return address;
}

bool somebodyListensAt(const sockaddr_un& address) {
    const int probe = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const bool reached = connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    const bool busy = !reached && errno == EAGAIN;
    close(probe);
    return reached || busy;
}

const char* const kRefusal = R"({"error":"the session belongs to another user","ok":false})";
const char* const kTooMany = R"({"error":"too many clients at once; try again","ok":false})";
const char* const kTooLong = R"({"error":"a command of more than 1024 bytes","ok":false})";
static_assert(kLongestCommand == 1024, "kTooLong contains this number");

}  // namespace

std::string answerLine(const nlohmann::json& answer) {
    return answer.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

ControlSocket::ControlSocket(const std::filesystem::path& folder) : folder_(folder) {
    if (const std::string failure = open(); !failure.empty()) {
        host::printLine("{}: {}; the session runs without sandwall ctl", (folder / kName).string(), failure);
        return;
    }
    thread_ = std::thread([this] { serve(); });
}

std::string ControlSocket::open() {
    const auto because = [](const char* what) { return fmt::format("{} ({})", what, std::strerror(errno)); };
    folderDescriptor_ = ::open(folder_.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (folderDescriptor_ < 0) {
        return because("cannot be reached");
    }
    const sockaddr_un address = addressIn(folderDescriptor_);
    struct stat there {};
    if (fstatat(folderDescriptor_, kName, &there, AT_SYMLINK_NOFOLLOW) == 0) {
        if (!S_ISSOCK(there.st_mode)) {
            return "is there already, and no socket";
        }
        if (somebodyListensAt(address)) {
            return "another session runs in this folder";
        }
        unlinkat(folderDescriptor_, kName, 0);
    }
    const int made = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    // Sets the rights before the socket has a name, so that other users can never open it.
    fchmod(made, S_IRUSR | S_IWUSR);
    if (made < 0 || bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        std::string failure = because("cannot be made");
        close(made);
        return failure;
    }
    listener_ = made;
    if (listen(listener_, static_cast<int>(kMostClients)) != 0 || pipe2(wake_, O_CLOEXEC | O_NONBLOCK) != 0) {
        return because("cannot be listened at");
    }
    return "";
}

ControlSocket::~ControlSocket() {
    if (thread_.joinable()) {
        {
            const std::lock_guard lock(mutex_);
            ending_ = true;
        }
        close(wake_[1]);
        thread_.join();
        close(wake_[0]);
    }
    for (const auto& [client, connection] : connections_) {
        close(connection.descriptor);
    }
    if (listener_ >= 0) {
        close(listener_);
        unlinkat(folderDescriptor_, kName, 0);
    }
    if (folderDescriptor_ >= 0) {
        close(folderDescriptor_);
    }
}

std::vector<ControlSocket::Asked> ControlSocket::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(asked_, {});
}

void ControlSocket::answer(Client client, std::string json) {
    const std::lock_guard lock(mutex_);
    answers_.push_back({client, std::move(json)});
    const char any = 0;
    // If the pipe is full, the thread wakes up anyway.
    [[maybe_unused]] const ssize_t written = ::write(wake_[1], &any, 1);
}

void ControlSocket::admit() {
    const int descriptor = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (descriptor < 0) {
        return;
    }
    ucred peer{};
    socklen_t size = sizeof peer;
    const bool known = getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0;
    Connection connection;
    connection.descriptor = descriptor;
    connection.until = Clock::now() + std::chrono::seconds(kPatience);
    if (!known || !mayCommand(peer.uid, geteuid())) {
        connection.out = std::string(kRefusal) + "\n";
    } else if (connections_.size() >= kMostClients) {
        connection.out = std::string(kTooMany) + "\n";
    }
    if (!connection.out.empty()) {
        (void)write(connection);
        close(descriptor);
        return;
    }
    connections_.emplace(++lastClient_, std::move(connection));
}

void ControlSocket::read(Client client, Connection& connection) {
    std::array<char, 512> piece{};
    const ssize_t count = recv(connection.descriptor, piece.data(), piece.size(), 0);
    if (count <= 0) {
        connection.until = Clock::time_point::min();  // the client closed the connection before a whole line
        return;
    }
    connection.in.append(piece.data(), static_cast<std::size_t>(count));
    const std::size_t end = connection.in.find('\n');
    if (std::min(end, connection.in.size()) > kLongestCommand) {
        connection.out = std::string(kTooLong) + "\n";
        connection.waiting = true;
    } else if (end != std::string::npos) {
        connection.waiting = true;
        const std::lock_guard lock(mutex_);
        asked_.push_back({client, connection.in.substr(0, end)});
    }
}

bool ControlSocket::write(Connection& connection) {
    const ssize_t count =
        send(connection.descriptor, connection.out.data(), connection.out.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count < 0) {
        return errno == EAGAIN || errno == EINTR;
    }
    connection.out.erase(0, static_cast<std::size_t>(count));
    return !connection.out.empty();
}

void ControlSocket::collectAnswers() {
    std::vector<Asked> answers;
    {
        const std::lock_guard lock(mutex_);
        answers.swap(answers_);
    }
    for (Asked& answer : answers) {
        if (const auto found = connections_.find(answer.client); found != connections_.end()) {
            found->second.out = std::move(answer.line) + "\n";
            found->second.until = Clock::now() + std::chrono::seconds(kPatience);
        }
    }
}

void ControlSocket::sendAway(const std::vector<Client>& clients) {
    for (const Client client : clients) {
        close(connections_.at(client).descriptor);
        connections_.erase(client);
    }
}

void ControlSocket::serve() {
    constexpr int kLook = 500;  // [ms], between two looks for clients whose time is over
    while (true) {
        std::vector<pollfd> watched{{wake_[0], POLLIN, 0}, {listener_, POLLIN, 0}};
        std::vector<Client> clients;
        for (const auto& [client, connection] : connections_) {
            const int wanted = !connection.out.empty() ? POLLOUT : connection.waiting ? 0 : POLLIN;
            watched.push_back({connection.descriptor, static_cast<short>(wanted), 0});
            clients.push_back(client);
        }
        poll(watched.data(), watched.size(), connections_.empty() ? -1 : kLook);
        std::array<char, 64> any{};
        while (::read(wake_[0], any.data(), any.size()) > 0) {
        }
        bool ending = false;
        {
            const std::lock_guard lock(mutex_);
            ending = ending_;
        }
        collectAnswers();
        if (ending) {  // sends the last answers, such as to the client that asked for the end
            for (auto& [client, connection] : connections_) {
                (void)(connection.out.empty() || write(connection));
            }
            return;
        }
        std::vector<Client> leaving;
        for (std::size_t i = 0; i < clients.size(); ++i) {
            Connection& connection = connections_.at(clients[i]);
            const int seen = watched[i + 2].revents;
            if ((seen & POLLIN) != 0) {
                read(clients[i], connection);
            }
            const bool inTime = (connection.waiting && connection.out.empty()) || Clock::now() < connection.until;
            const bool gone = (seen & (POLLHUP | POLLERR)) != 0 && (seen & POLLIN) == 0;
            if (!inTime || gone || (!connection.out.empty() && !write(connection))) {
                leaving.push_back(clients[i]);
            }
        }
        sendAway(leaving);
        if ((watched[1].revents & POLLIN) != 0) {
            admit();
        }
    }
}

}  // namespace master
