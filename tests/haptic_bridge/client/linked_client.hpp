// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "haptic_bridge/client/client.hpp"
#include "tests/haptic_bridge/client/fake_server.hpp"
#include "tests/support/processes/server_process.hpp"

namespace test {

inline const haptic_bridge::Offer kOffer{42, "dunes"};
inline const haptic_bridge::Identity kIdentity{haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion, 42, "dunes"};

/// Waits for a state of the link. Returns false if it does not come.
inline bool reaches(const haptic_bridge::Client& client, haptic_bridge::Link link) {
    return eventually([&] { return client.link().link == link; });
}

/// A step whose path is one point, at x = `number`.
inline haptic_bridge::StepMessage stepOf(std::uint32_t epoch, std::uint64_t number) {
    haptic_bridge::StepMessage message{1, 2, {epoch, number, false, {{static_cast<std::int32_t>(number), 0, 0}}}};
    message.step.sweeps = 8;
    return message;
}

/// Welcomes the client and takes over the numbering of steps.
inline bool linkUp(FakeServer::Connection& connection) {
    if (!connection.await<haptic_bridge::Hello>()) {
        return false;
    }
    connection.send(haptic_bridge::Welcome{kIdentity, 60});
    if (!connection.await<haptic_bridge::StartMessage>()) {
        return false;
    }
    connection.send(haptic_bridge::Ready{});
    return true;
}

/// Grants the hand once the server offers it. The first step has the number after `number`.
inline void grantWhenOffered(haptic_bridge::Client& client, std::uint32_t epoch, std::uint64_t number) {
    ASSERT_TRUE(reaches(client, haptic_bridge::Link::offered)) << client.link().message;
    client.grant(epoch, number, 0);
}

}  // namespace test
