// SPDX-License-Identifier: Apache-2.0
// Tests of the handshake: both halves prove that they know the secret, without a socket.
#include <utility>

#include "haptic_bridge/link/handshake.hpp"
#include "tests/haptic_bridge/link/link_security_fixture.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;

/// Both halves of a greeting, without a socket.
class Greeting : public LinkSecurityTest {
protected:
    LinkSecurity master_ = client(both_), server_ = client(both_);
    Identity identity_{kProtocolVersion, sand::kAlgorithmVersion, 7, "dunes"};
};

TEST_F(Greeting, ProvesBothSidesAndNoneToTheOther) {
    MasterHandshake master(master_, identity_, Role::move, {});
    ServerHandshake server(server_);
    EXPECT_FALSE(server.refusalFor(master.hello(), false));
    const auto challenge = server.challenge(master.hello(), identity_, {});
    ASSERT_TRUE(challenge);
    const auto proof = master.answer(*challenge);
    ASSERT_TRUE(proof);
    EXPECT_TRUE(server.accepts(*proof));
    EXPECT_TRUE(master.accepts(Welcome{identity_, 60, Role::move, server.mac()}));
    // A side's own proof, sent back to it, proves nothing.
    EXPECT_FALSE(master.accepts(Welcome{identity_, 60, Role::move, proof->mac})) << "reflected";
    EXPECT_FALSE(server.accepts(Proof{server.mac()})) << "reflected";
    EXPECT_FALSE(master.accepts(Welcome{identity_, 60, Role::watch, server.mac()})) << "a lower role than requested";
    Identity other = identity_;
    other.rulesDigest ^= 1;
    EXPECT_FALSE(master.accepts(Welcome{other, 60, Role::move, server.mac()}))
        << "another server than the one that sent the challenge";
    EXPECT_FALSE(master.answer(*challenge)) << "twice";
}

TEST_F(Greeting, EveryByteOfWhatWasSaidIsUnderTheProof) {
    MasterHandshake master(master_, identity_, Role::move, {1, 2});
    ServerHandshake server(server_);
    for (int which = 0; which < 6; ++which) {
        Hello hello = master.hello();
        hello.nonce[31] ^= which == 0 ? 1 : 0;
        hello.master.sceneName += which == 1 ? "s" : "";
        hello.tls = which == 2;
        hello.role = which == 3 ? Role::watch : Role::move;
        auto challenge = server.challenge(hello, identity_, which == 4 ? base::Bytes{1, 3} : base::Bytes{1, 2});
        challenge->nonce[0] ^= which == 5 ? 1 : 0;
        MasterHandshake answering = master;
        EXPECT_FALSE(server.accepts(*answering.answer(*challenge))) << which;
    }
}

TEST_F(Greeting, AServerThatMayOnlyWatchNumbersNoSteps) {
    MasterHandshake master(master_, identity_, Role::move, {});
    LinkSecurity watching = server_;
    watching.secrets.move = watching.secrets.watch;
    ServerHandshake server(watching);
    const auto challenge = server.challenge(master.hello(), identity_, {});
    ASSERT_TRUE(master.answer(*challenge));
    EXPECT_FALSE(master.accepts(Welcome{identity_, 60, Role::move, server.mac()}));
    EXPECT_EQ(master.because().code, RefusalCode::role) << master.because().text;
    MasterHandshake trusting(master_, identity_, Role::move, {});
    EXPECT_FALSE(trusting.accepts(Welcome{identity_, 60, Role::move, {}})) << "proves nothing";
    EXPECT_EQ(trusting.because().code, RefusalCode::secret);
}

// An attacker in between ends TLS on both sides with a certificate of its own, and forwards the decrypted messages.
TEST_F(Greeting, TlsIsBoundToTheProofSoThatNobodyStandsBetween) {
    const auto shake = [](TlsSession& guest, TlsSession& host) {
        base::Bytes there, back, plain;
        guest.begin(there);
        while (!there.empty() || !back.empty()) {
            const base::Bytes forth = std::exchange(there, {}), answers = std::exchange(back, {});
            host.receive(forth, plain, back);
            guest.receive(answers, plain, there);
        }
        EXPECT_TRUE(guest.established() && host.established());
    };
    const auto serverTls = server_.functions->tlsServer("", ""), middleTls = server_.functions->tlsServer("", "");
    const auto clientTls = server_.functions->tlsClient();
    const auto server = serverTls->open(), middleIn = middleTls->open();
    const auto master = clientTls->open(), middleOut = clientTls->open(), honest = clientTls->open();
    shake(*master, *middleIn);
    shake(*middleOut, *server);
    EXPECT_NE(master->binding(), server->binding());
    EXPECT_EQ(middleOut->binding(), server->binding());
    MasterHandshake asking(master_, identity_, Role::move, master->binding());
    ServerHandshake asked(server_);
    const auto challenge = asked.challenge(asking.hello(), identity_, server->binding());
    EXPECT_FALSE(asked.accepts(*asking.answer(*challenge)));
    EXPECT_FALSE(asking.accepts(Welcome{identity_, 60, Role::move, asked.mac()}));
}

}  // namespace
