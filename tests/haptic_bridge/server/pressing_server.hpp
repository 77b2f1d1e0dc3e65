// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "scene/load/scene_file.hpp"
#include "tests/support/processes/server_process.hpp"

namespace test {

/// Tests of the real server in real time, whose arm presses into the sand and logs the forces that it takes
/// (tests/haptic_bridge/devices/logging_driver.cpp).
class PressingServer : public testing::Test {
protected:
    /// Returns the options of a server whose arm has this fault as soon as breakDown() is called.
    [[nodiscard]] std::vector<std::string> words(const std::string& fault) const {
        auto all = ServerProcess::usual(sceneFile_, folder_, 0, "realtime");
        all[3] = "driver:" SANDWALL_BIN_DIR "/logging-driver.so:" + fault + ":" + folder_.file("forces");
        return all;
    }
    /// Links a master, and follows until the arm is pushed. Without a master that follows, the force would fade. If the
    /// arm trips, an operator switches its force on.
    void press(const haptic_bridge::Address& server) {
        client_ = std::make_unique<haptic_bridge::Client>(server, offerOf(scene_));
        Wall wall(scene_);
        ASSERT_TRUE(wall.follow(*client_, 5)) << client_->link().message << "\n" << folder_.read("err");
        std::size_t switchedOnAt = 0;
        ASSERT_TRUE(eventually([&] {
            const std::size_t count = forces().size();
            if (rests() && count > switchedOnAt + kRest) {
                client_->shareForce({.share = 1, .byOperator = true});
                switchedOnAt = count;
            }
            return wall.follow(*client_, wall.replica.stepNumber() + 1) && presses();
        })) << folder_.read("forces");
    }
    void breakDown() { (void)folder_.write("forces.now", ""); }

    /// Waits until the arm has logged this word.
    [[nodiscard]] bool logs(const std::string& word) const {
        return eventually([&] { return folder_.read("forces").find(word) != std::string::npos; });
    }

    /// Returns the magnitude of each force that the arm took [N]. Reads only the rows that are new, because press()
    /// asks again and again: a master that takes ever longer between its steps would be felt less and less.
    [[nodiscard]] const std::vector<double>& forces() const {
        std::ifstream file(folder_.file("forces"));
        file.seekg(read_);
        for (std::string row; std::getline(file, row) && !file.eof();) {  // a row that is being written has no end yet
            read_ += static_cast<std::streamoff>(row.size()) + 1;
            std::istringstream parts(row);
            double time = 0, x = 0, y = 0, z = 0;
            if (parts >> time >> x >> y >> z) {
                forces_.push_back(std::sqrt(x * x + y * y + z * z));
            }
        }
        return forces_;
    }
    /// Returns whether the last 21 forces are above 0, so that the arm presses when a server ends next.
    [[nodiscard]] bool presses() const {
        return lastAre(21, [](double force) { return force > 0; });
    }
    /// Returns whether the arm has got no force for so long that it has tripped: on a busy machine, the force loop may
    /// miss ticks three times within ten seconds.
    [[nodiscard]] bool rests() const {
        return lastAre(kRest, [](double force) { return force == 0; });
    }
    [[nodiscard]] double lastForce() const { return forces().back(); }

    static constexpr std::size_t kRest = 300;  // pushes

    /// Returns whether there are so many forces, and the last of them are all so.
    [[nodiscard]] bool lastAre(std::size_t count, const std::function<bool(double)>& so) const {
        const auto& all = forces();
        return all.size() >= count && std::all_of(all.end() - static_cast<std::ptrdiff_t>(count), all.end(), so);
    }

    Folder folder_;
    std::string sceneFile_ = folder_.write("small.toml", kSmallScene);
    scene::Scene scene_ = scene::loadScene(sceneFile_);
    std::unique_ptr<haptic_bridge::Client> client_;

private:
    mutable std::streamoff read_ = 0;     // bytes of the file that forces() has read
    mutable std::vector<double> forces_;  // in these bytes
};

/// A server that a shell has started, as a launcher does. When the shell ends, the test is the server's new parent.
class LaunchedServer {
public:
    /// `script` starts the server "$@" in the background, and writes its process id to "$0".
    LaunchedServer(const Folder& folder, std::vector<std::string> arguments,
                   std::string script = R"("$@" > "$0.out" 2> "$0.err" & echo $! > "$0"; wait)")
        : folder_(folder) {
        prctl(PR_SET_CHILD_SUBREAPER, 1);
        const std::string program = SANDWALL_BIN_DIR "/sandwall-haptic-server";
        arguments.insert(arguments.begin(), {"sh", "-c", std::move(script), folder.file("pid"), program});
        std::vector<char*> words;
        words.reserve(arguments.size() + 1);
        for (std::string& argument : arguments) {
            words.push_back(argument.data());
        }
        words.push_back(nullptr);
        shell_ = fork();
        if (shell_ == 0) {
            execv("/bin/sh", words.data());
            _exit(127);
        }
        eventually([&] { return folder.read("pid").ends_with('\n'); });
        server_ = std::atoi(folder.read("pid").c_str());
    }
    ~LaunchedServer() {
        killLauncher();
        if (server_ > 0) {
            kill(server_, SIGKILL);
            wait();
        }
        prctl(PR_SET_CHILD_SUBREAPER, 0);
    }
    LaunchedServer(const LaunchedServer&) = delete;
    LaunchedServer& operator=(const LaunchedServer&) = delete;

    [[nodiscard]] haptic_bridge::Address address() const {
        eventually([this] { return std::filesystem::exists(folder_.file("port")); });
        return {"127.0.0.1", static_cast<std::uint16_t>(std::atoi(folder_.read("port").c_str()))};
    }
    [[nodiscard]] pid_t pid() const { return server_; }
    void killLauncher() {
        if (shell_ > 0) {
            kill(shell_, SIGKILL);
            waitpid(shell_, nullptr, 0);
            shell_ = 0;
        }
    }
    /// After killLauncher(): returns the server's exit status, −signal, or 999 if it does not end in time.
    int wait() {
        int status = 0;
        if (!eventually([&] { return waitpid(server_, &status, WNOHANG) == server_; })) {
            return 999;
        }
        server_ = 0;
        return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
    }

private:
    const Folder& folder_;
    pid_t shell_ = 0, server_ = 0;
};

}  // namespace test
