// SPDX-License-Identifier: Apache-2.0
// Both ends of the link against another program's TLS of an older version.
#include <stdexcept>
#include <string>
#include <utility>

#include "tests/haptic_bridge/link/openssl_peer.hpp"

namespace {

using haptic_bridge::TlsSession;
using test::OpenSslPeer;

/// Result of a TLS handshake between an end of the link and `peer`.
struct Shaken {
    bool ours = false, theirs = false;  // whether each end has completed the handshake
    std::string error;                  // of our end
};

Shaken shake(TlsSession& ours, bool oursBegins, OpenSslPeer& peer) {
    Shaken shaken;
    base::Bytes there, back, plain;
    oursBegins ? ours.begin(there) : void(back = peer.exchange({}));
    try {
        while (!there.empty() || !back.empty()) {
            if (const base::Bytes forth = std::exchange(there, {}); !forth.empty()) {
                const base::Bytes reply = peer.exchange(forth);
                back.insert(back.end(), reply.begin(), reply.end());
            }
            ours.receive(std::exchange(back, {}), plain, there);
        }
    } catch (const std::runtime_error& error) {
        shaken.error = error.what();
        (void)peer.exchange(there);
    }
    shaken.ours = ours.established();
    shaken.theirs = peer.established();
    return shaken;
}

/// A handshake of a server of the link with a client that offers at most `newest`, and the reverse.
Shaken shakeWithClient(int newest) {
    const auto context = haptic_bridge::loadSecurity("--tls").tlsServer("", "");
    OpenSslPeer peer(false, newest);
    return shake(*context->open(), false, peer);
}
Shaken shakeWithServer(int newest) {
    const auto context = haptic_bridge::loadSecurity("--tls").tlsClient();
    OpenSslPeer peer(true, newest);
    return shake(*context->open(), true, peer);
}

TEST(TlsVersion, IsAtLeast13AtAServer) {
    const Shaken newer = shakeWithClient(TLS1_3_VERSION);
    EXPECT_TRUE(newer.ours && newer.theirs) << "the same client with TLS 1.3 is accepted: " << newer.error;
    const Shaken older = shakeWithClient(TLS1_2_VERSION);
    EXPECT_FALSE(older.ours || older.theirs);
    EXPECT_EQ(older.error, "unsupported protocol");
}

TEST(TlsVersion, IsAtLeast13AtAClient) {
    const Shaken newer = shakeWithServer(TLS1_3_VERSION);
    EXPECT_TRUE(newer.ours && newer.theirs) << "the same server with TLS 1.3 is accepted: " << newer.error;
    const Shaken older = shakeWithServer(TLS1_2_VERSION);
    EXPECT_FALSE(older.ours || older.theirs);
    EXPECT_NE(older.error, "");
}

}  // namespace
