// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/files/folder_test.hpp"

namespace test {

using namespace std::chrono_literals;

/// Waits a bounded time until `done` returns true. Returns whether it did.
template <class Done>
bool eventually(const Done& done, std::chrono::milliseconds most = 60000ms) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (!done()) {
        if (std::chrono::steady_clock::now() > end) {
            return false;
        }
        std::this_thread::sleep_for(1ms);
    }
    return true;
}

/// A temporary folder that is removed with the test.
class Folder {
public:
    Folder() = default;
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(file(name)) << text;
        return file(name);
    }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ifstream stream(file(name));
        return {std::istreambuf_iterator<char>(stream), {}};
    }

private:
    std::filesystem::path path_ = newFolder();
};

inline constexpr const char* kSmallScene = R"(
name = "small"
[field]
columns = 128
[terrain]
kind = "flat"
[tool]
radius = 0.04
[material]
talus_deg = 34
)";

/// The server program, started and stopped by its process id. Its output goes to files in the folder.
class ServerProcess {
public:
    /// `most` limits the memory that the program may map [byte]; 0: no limit.
    ServerProcess(const Folder& folder, std::vector<std::string> arguments, rlim_t most = 0) : folder_(folder) {
        std::filesystem::remove(folder.file("port"));
        arguments.insert(arguments.begin(), SANDWALL_BIN_DIR "/sandwall-haptic-server");
        pid_ = fork();
        if (pid_ == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL);  // --die-with-parent watches from main() on
            signal(SIGHUP, SIG_DFL);           // the tests may run under nohup
            if (const rlimit limit{most, most}; most != 0) {
                setrlimit(RLIMIT_AS, &limit);
            }
            std::vector<char*> words;
            words.reserve(arguments.size() + 1);
            for (std::string& argument : arguments) {
                words.push_back(argument.data());
            }
            words.push_back(nullptr);
            const bool redirected = freopen(folder.file("out").c_str(), "w", stdout) != nullptr &&
                                    freopen(folder.file("err").c_str(), "w", stderr) != nullptr;
            if (redirected) {
                execv(words[0], words.data());
            }
            _exit(127);
        }
    }
    ~ServerProcess() { stop(SIGKILL); }
    ServerProcess(const ServerProcess&) = delete;
    ServerProcess& operator=(const ServerProcess&) = delete;

    /// Returns the options of the usual server of the tests: fast, script:gis, on any free port.
    static std::vector<std::string> usual(const std::string& scene, const Folder& folder, int port = 0,
                                          const std::string& pace = "fast") {
        return {"--scene",
                scene,
                "--device",
                "script:gis",
                "--pace",
                pace,
                "--die-with-parent",
                "--listen",
                "127.0.0.1:" + std::to_string(port),
                "--port-file",
                folder.file("port")};
    }

    /// Returns the port; 0 if the server does not start.
    [[nodiscard]] std::uint16_t port() const {
        eventually([this] { return std::filesystem::exists(folder_.file("port")); });
        return static_cast<std::uint16_t>(std::atoi(folder_.read("port").c_str()));
    }
    [[nodiscard]] haptic_bridge::Address address() const { return {"127.0.0.1", port()}; }

    /// Returns the exit status, −signal, or 999 if the program does not end in time.
    int wait() {
        int status = 0;
        const bool ended = pid_ <= 0 || eventually([&] { return waitpid(pid_, &status, WNOHANG) == pid_; });
        if (!ended) {
            return 999;
        }
        pid_ = 0;
        return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
    }
    int stop(int signal) {
        if (pid_ <= 0) {
            return 0;
        }
        kill(pid_, signal);
        return wait();
    }
    [[nodiscard]] pid_t pid() const { return pid_; }
    [[nodiscard]] std::string errors() const { return folder_.read("err"); }
    [[nodiscard]] std::string output() const { return folder_.read("out"); }

private:
    const Folder& folder_;
    pid_t pid_ = 0;
};

/// A master without a wall. Its replica applies the steps from the client, and it reports them as shown at once.
struct Wall {
    explicit Wall(const scene::Scene& scene) : replica(scene) {}

    /// Grants the steps when the link is offered. Follows until `steps` is reached or the time is over. Counts hashes
    /// that differ.
    bool follow(haptic_bridge::Client& client, std::uint64_t steps) {
        return eventually(
            [&] {
                if (client.link().link == haptic_bridge::Link::offered) {
                    for (const auto& left : client.drain(1000)) {
                        apply(left);
                    }
                    client.grant(++epoch, replica.stepNumber(), replica.stateHash());
                }
                if (client.needsState()) {
                    client.giveState(replica.encodeState());
                }
                for (const auto& timed : client.drain(steps - replica.stepNumber())) {
                    apply(timed);
                }
                client.shown({replica.stepNumber(), 16'666'667});
                return replica.stepNumber() >= steps;
            },
            60000ms);
    }
    void apply(const haptic_bridge::TimedStep& timed) {
        if (timed.step.epoch == epoch && timed.step.number == replica.stepNumber() + 1) {
            strokes += timed.step.engaged && !replica.engaged() ? 1 : 0;
            replica.apply(timed.step);
            divergences += replica.stateHash() != timed.serverHash ? 1 : 0;
            longest = std::max(longest, timed.step.path.size());
            engaged += timed.step.engaged ? 1 : 0;
            turns += timed.step.heading ? 1 : 0;
            if (timed.step.edit.any()) {
                edits.push_back(timed.step.edit);
            }
        } else {
            ++outOfOrder;
        }
    }

    sand::Replica replica;
    std::uint32_t epoch = 0;
    int divergences = 0, outOfOrder = 0, engaged = 0, strokes = 0, turns = 0;
    std::size_t longest = 0;
    std::vector<sand::Edit> edits;
};

inline haptic_bridge::Offer offerOf(const scene::Scene& scene) {
    return {scene.rules.digest(), scene.name, scene.rules.stepLimits()};
}

}  // namespace test
