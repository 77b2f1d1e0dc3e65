// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <sstream>

#include "scene/load/scene_file.hpp"
#include "tests/haptic_bridge/server/server_process.hpp"

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
    /// Links a master, and waits until the arm is pushed.
    void press(const haptic_bridge::Address& server) {
        client_ = std::make_unique<haptic_bridge::Client>(server, offerOf(scene_));
        ASSERT_TRUE(Wall(scene_).follow(*client_, 5)) << client_->link().message << "\n" << folder_.read("err");
        ASSERT_TRUE(eventually([this] { return pushes() > 20; })) << folder_.read("forces");
        ASSERT_GT(lastForce(), 0) << "the arm must press when the server ends";
    }
    void breakDown() { (void)folder_.write("forces.now", ""); }

    /// Waits until the arm has logged this word.
    [[nodiscard]] bool logs(const std::string& word) const {
        return eventually([&] { return folder_.read("forces").find(word) != std::string::npos; });
    }

    /// Returns the magnitude of each force that the arm took [N].
    [[nodiscard]] std::vector<double> forces() const {
        std::vector<double> all;
        std::istringstream rows(folder_.read("forces"));
        for (std::string row; std::getline(rows, row) && !rows.eof();) {  // a row that is being written has no end yet
            std::istringstream parts(row);
            double time = 0, x = 0, y = 0, z = 0;
            if (parts >> time >> x >> y >> z) {
                all.push_back(std::sqrt(x * x + y * y + z * z));
            }
        }
        return all;
    }
    [[nodiscard]] std::size_t pushes() const {
        const auto all = forces();
        return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [](double force) { return force > 0; }));
    }
    [[nodiscard]] double lastForce() const { return forces().back(); }

    Folder folder_;
    std::string sceneFile_ = folder_.write("small.toml", kSmallScene);
    scene::Scene scene_ = scene::loadScene(sceneFile_);
    std::unique_ptr<haptic_bridge::Client> client_;
};

}  // namespace test
