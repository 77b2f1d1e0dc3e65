// SPDX-License-Identifier: Apache-2.0
// Tests of the handshake: both halves prove that they know the secret, without a socket.
#include <functional>
#include <string>
#include <utility>
#include <vector>

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
    EXPECT_FALSE(master.answer(*challenge)) << "twice";
}

/// Returns `mac` with one other bit.
MacBytes flipped(MacBytes mac, std::size_t bit) {
    mac.at(bit / 8) ^= static_cast<std::uint8_t>(1U << bit % 8);
    return mac;
}

TEST_F(Greeting, ComparesEveryBitOfAMacOfBothRoles) {
    for (const Role role : {Role::move, Role::watch}) {
        MasterHandshake master(master_, identity_, role, {});
        ServerHandshake server(server_);
        const auto proof = master.answer(*server.challenge(master.hello(), identity_, {}));
        ASSERT_TRUE(proof);
        EXPECT_TRUE(server.accepts(*proof));
        EXPECT_TRUE(master.accepts(Welcome{identity_, 60, role, server.mac()}));
        for (std::size_t bit = 0; bit < 8 * proof->mac.size(); ++bit) {
            EXPECT_FALSE(server.accepts(Proof{flipped(proof->mac, bit)})) << base::nameOf(role) << ", bit " << bit;
            EXPECT_FALSE(master.accepts(Welcome{identity_, 60, role, flipped(server.mac(), bit)}))
                << base::nameOf(role) << ", bit " << bit;
        }
    }
}

TEST_F(Greeting, ComparesEveryBitOfAMacOfAServerWithoutSand) {
    MasterHandshake master(master_, identity_, Role::move, {});
    ServerHandshake server(server_);
    ASSERT_TRUE(master.answer(*server.challenge(master.hello(), {kProtocolVersion, 0, 0, "arm"}, {})));
    EXPECT_TRUE(master.accepts(PositionGreeting{kProtocolVersion, "arm", server.mac()}));
    for (std::size_t bit = 0; bit < 8 * server.mac().size(); ++bit) {
        EXPECT_FALSE(master.accepts(PositionGreeting{kProtocolVersion, "arm", flipped(server.mac(), bit)})) << bit;
    }
}

// Test case 2 of RFC 4231.
TEST_F(Greeting, SignsWithHmacSha256) {
    const std::string key = "Jefe", text = "what do ya want for nothing?";
    const auto bytes = [](const std::string& from) {
        return ByteSpan(reinterpret_cast<const std::uint8_t*>(from.data()), from.size());
    };
    const MacBytes expected{0x5b, 0xdc, 0xc1, 0x46, 0xbf, 0x60, 0x75, 0x4e, 0x6a, 0x04, 0x24,
                            0x26, 0x08, 0x95, 0x75, 0xc7, 0x5a, 0x00, 0x3f, 0x08, 0x9d, 0x27,
                            0x39, 0x83, 0x9d, 0xec, 0x58, 0xb9, 0x64, 0xec, 0x38, 0x43};
    EXPECT_EQ(server_.functions->hmacSha256(bytes(key), bytes(text)), expected);
}

TEST_F(Greeting, EveryCharacterOfTheSecretCounts) {
    for (const Role role : {Role::move, Role::watch}) {
        for (std::size_t at = 0; at < server_.secrets.of(role)->size(); ++at) {
            LinkSecurity other = server_;
            (role == Role::move ? other.secrets.move : other.secrets.watch)->at(at) ^= 1;
            MasterHandshake master(master_, identity_, role, {});
            ServerHandshake server(other);
            EXPECT_FALSE(server.accepts(*master.answer(*server.challenge(master.hello(), identity_, {})))) << at;
            EXPECT_FALSE(master.accepts(Welcome{identity_, 60, role, server.mac()})) << at;
        }
    }
}

/// Change of the signed messages by an attacker between the two sides.
struct Change {
    std::string name;
    std::function<void(Hello&)> hello;
    std::function<void(Challenge&)> challenge{};
    base::Bytes binding{1, 2};  // of the server's end of the connection
};
std::vector<Change> changes() {
    std::vector<Change> all{
        {"version", [](Hello& hello) { ++hello.master.protocol; }},
        {"algorithm", [](Hello& hello) { ++hello.master.algorithm; }},
        {"digest", [](Hello& hello) { ++hello.master.rulesDigest; }},
        {"scene", [](Hello& hello) { hello.master.sceneName += "s"; }},
        {"role", [](Hello& hello) { hello.role = Role::watch; }},
        {"proves", [](Hello& hello) { hello.proves = !hello.proves; }},
        {"TLS", [](Hello& hello) { hello.tls = !hello.tls; }},
        {"the server's algorithm", {}, [](Challenge& challenge) { ++challenge.server.algorithm; }},
        {"the server's digest", {}, [](Challenge& challenge) { ++challenge.server.rulesDigest; }},
        {"the server's scene", {}, [](Challenge& challenge) { challenge.server.sceneName += "s"; }},
        {"first byte of the binding", {}, {}, {0, 2}},
        {"last byte of the binding", {}, {}, {1, 3}},
        {"length of the binding", {}, {}, {1, 2, 0}},
        {"no binding", {}, {}, {}},
    };
    for (std::size_t i = 0; i < Nonce{}.size(); ++i) {
        const std::string byte = "byte " + std::to_string(i) + " of the nonce";
        all.push_back({"the master's " + byte, [i](Hello& hello) { hello.nonce.at(i) ^= 1; }});
        all.push_back({"the server's " + byte, {}, [i](Challenge& challenge) { challenge.nonce.at(i) ^= 1; }});
    }
    return all;
}

TEST_F(Greeting, EveryByteOfWhatWasSaidIsUnderBothProofs) {
    for (const Change& change : changes()) {
        MasterHandshake master(master_, identity_, Role::move, {1, 2});
        ServerHandshake server(server_);
        Hello hello = master.hello();
        if (change.hello) {
            change.hello(hello);
        }
        Challenge challenge = *server.challenge(hello, identity_, change.binding);
        if (change.challenge) {
            change.challenge(challenge);
        }
        EXPECT_FALSE(server.accepts(*master.answer(challenge))) << change.name;
        EXPECT_FALSE(master.accepts(Welcome{challenge.server, 60, Role::move, server.mac()})) << change.name;
        EXPECT_EQ(master.because().code, RefusalCode::secret) << change.name;
    }
}

TEST_F(Greeting, WelcomesOnlyWithTheIdentityOfTheChallenge) {
    MasterHandshake master(master_, identity_, Role::move, {});
    ServerHandshake server(server_);
    ASSERT_TRUE(master.answer(*server.challenge(master.hello(), identity_, {})));
    std::vector<Identity> others(4, identity_);
    ++others[0].protocol;
    ++others[1].algorithm;
    ++others[2].rulesDigest;
    others[3].sceneName += "s";
    for (const Identity& other : others) {
        EXPECT_FALSE(master.accepts(Welcome{other, 60, Role::move, server.mac()}));
        EXPECT_EQ(master.because().code, RefusalCode::secret);
    }
    EXPECT_TRUE(master.accepts(Welcome{identity_, 60, Role::move, server.mac()}));

    MasterHandshake hand(master_, identity_, Role::move, {});
    ServerHandshake arm(server_);
    ASSERT_TRUE(hand.answer(*arm.challenge(hand.hello(), {kProtocolVersion, 0, 0, "arm"}, {})));
    EXPECT_FALSE(hand.accepts(PositionGreeting{kProtocolVersion, "arms", arm.mac()}));
    EXPECT_FALSE(hand.accepts(PositionGreeting{kProtocolVersion + 1, "arm", arm.mac()}));
    EXPECT_TRUE(hand.accepts(PositionGreeting{kProtocolVersion, "arm", arm.mac()}));
}

TEST_F(Greeting, AnswersNoChallengeOfAnotherProtocol) {
    MasterHandshake master(master_, identity_, Role::move, {});
    EXPECT_FALSE(master.answer({{kProtocolVersion + 1, sand::kAlgorithmVersion, 7, "dunes"}, {}}));
    EXPECT_EQ(master.because().code, RefusalCode::protocol);
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
    const auto shake = [](TlsSession& client, TlsSession& peer) {
        base::Bytes there, back, plain;
        client.begin(there);
        while (!there.empty() || !back.empty()) {
            const base::Bytes forth = std::exchange(there, {}), answers = std::exchange(back, {});
            peer.receive(forth, plain, back);
            client.receive(answers, plain, there);
        }
        EXPECT_TRUE(client.established() && peer.established());
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
