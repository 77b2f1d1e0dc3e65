// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/link/link_options.hpp"
#include "haptic_bridge/link/protocol.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/processes/server_process.hpp"

namespace test {

inline const std::string kMove = "the secret of links that move";
inline const std::string kWatch = "the secret of links that watch";

/// A folder with a scene and a file with both secrets, as servers and clients need them.
class LinkSecurityTest : public testing::Test {
protected:
    std::string secretFile(const std::string& name, const std::string& text) {
        std::string file = folder_.write(name, text);
        chmod(file.c_str(), S_IRUSR | S_IWUSR);
        return file;
    }
    std::string quoted(std::string secret) {
        std::replace(secret.begin(), secret.end(), ' ', '-');
        return secret;
    }
    std::vector<std::string> arguments(const std::vector<std::string>& more, const std::string& pace = "fast") {
        std::vector<std::string> all = ServerProcess::usual(sceneFile_, folder_, 0, pace);
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    haptic_bridge::LinkSecurity client(const std::string& file, bool tls = false,
                                       haptic_bridge::Role role = haptic_bridge::Role::move) {
        haptic_bridge::LinkOptions options;
        options.secretFile = file;
        options.tls = tls;
        return options.forClient(role);
    }
    haptic_bridge::Hello hello(haptic_bridge::Role role = haptic_bridge::Role::move) {
        return {{haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(), "small"},
                role,
                false,
                false,
                {}};
    }
    /// Returns the message of a link that is refused.
    std::string refusalOf(const haptic_bridge::Address& address, const haptic_bridge::LinkSecurity& security) {
        haptic_bridge::Client client(address, offerOf(scene_), security);
        EXPECT_TRUE(eventually([&] { return client.link().link == haptic_bridge::Link::refused; }))
            << client.link().message;
        return client.link().message;
    }
    bool links(const haptic_bridge::Address& address, const haptic_bridge::LinkSecurity& security,
               std::uint64_t steps = 20) {
        haptic_bridge::Client client(address, offerOf(scene_), security);
        Wall wall(scene_);
        return wall.follow(client, steps) && wall.divergences == 0;
    }

    Folder folder_;
    std::string both_ = secretFile("both", "move " + quoted(kMove) + "\nwatch " + quoted(kWatch) + "\n");
    std::string sceneFile_ = folder_.write("small.toml", kSmallScene);
    scene::Scene scene_ = scene::loadScene(sceneFile_);
};

}  // namespace test
