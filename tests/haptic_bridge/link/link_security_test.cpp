// SPDX-License-Identifier: Apache-2.0
// The real server against peers that it must refuse, over plain TCP and TLS.
#include <algorithm>
#include <mutex>

#include "base/input_error.hpp"
#include "tests/haptic_bridge/link/link_security_fixture.hpp"
#include "tests/haptic_bridge/link/raw_peer.hpp"
#include "tests/impaired_link/impaired_link.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;
using impaired_link::ImpairedLink;

/// A relay that records the bytes between two ends.
struct Capture {
    std::mutex mutex;
    base::Bytes there, back;
    ImpairedLink::Tap tap() {
        return [this](std::span<const std::uint8_t> bytes, bool fromClient) {
            const std::lock_guard lock(mutex);
            base::Bytes& all = fromClient ? there : back;
            all.insert(all.end(), bytes.begin(), bytes.end());
        };
    }
    bool holds(std::span<const std::uint8_t> bytes) {
        const std::lock_guard lock(mutex);
        const auto in = [&](const base::Bytes& all) {
            return std::search(all.begin(), all.end(), bytes.begin(), bytes.end()) != all.end();
        };
        return in(there) || in(back);
    }
};

TEST_F(LinkSecurityTest, ListensBeyondThisMachineOnlyWithASecret) {
    std::vector<std::string> wide = arguments({});
    *(std::find(wide.begin(), wide.end(), "--listen") + 1) = "0.0.0.0:0";
    {
        ServerProcess server(folder_, wide);
        EXPECT_EQ(server.wait(), base::kExitBadInput);
        EXPECT_NE(server.errors().find("--secret-file"), std::string::npos) << server.errors();
    }
    wide.insert(wide.end(), {"--secret-file", both_});
    ServerProcess server(folder_, wide);
    EXPECT_TRUE(links(server.address(), client(both_)));
    const LinkSecurity none;
    EXPECT_THROW(requireSecret({"192.0.2.1", 7750}, none, "--haptic"), base::InputError);
    EXPECT_NO_THROW(requireSecret({"127.8.0.1", 7750}, none, "--haptic"));
    EXPECT_NO_THROW(requireSecret({"192.0.2.1", 7750}, client(both_), "--haptic"));
    EXPECT_FALSE(isLoopback(boost::asio::ip::make_address("::ffff:10.0.0.1")));
    EXPECT_TRUE(isLoopback(boost::asio::ip::make_address("::ffff:127.0.0.1")));
}

TEST_F(LinkSecurityTest, RefusesWhoDoesNotKnowTheSecretAndSaysSo) {
    ServerProcess server(folder_, arguments({"--secret-file", both_}));
    const Address address = server.address();
    const std::string wrong = secretFile("wrong", "move another-secret-entirely\n");
    EXPECT_NE(refusalOf(address, client(wrong)).find("the secret of role move differs here"), std::string::npos);
    EXPECT_NE(refusalOf(address, {}).find("asks for a secret"), std::string::npos);
    {
        RawPeer skips(address.port);  // it sends no proof of a secret
        skips.send(hello());
        EXPECT_NE(skips.refusal().find("asks for a secret"), std::string::npos);
    }
    {
        RawPeer pushes(address.port);
        Hello proving = hello();
        proving.proves = true;
        pushes.send(proving);
        EXPECT_TRUE(pushes.receive()) << "the challenge";
        pushes.send(StartMessage{1, 0, 0});
        EXPECT_NE(pushes.refusal().find("out of turn"), std::string::npos);
    }
    {
        RawPeer large(address.port);  // unauthenticated: at most one kilobyte per message
        large.send(Bye{std::string(2000, 'x')});
        EXPECT_NE(large.refusal().find("at most 1024 are allowed"), std::string::npos);
    }
    EXPECT_TRUE(links(address, client(both_))) << "after all faults the server still serves";
    EXPECT_NE(server.errors().find("the secret of role move differs here"), std::string::npos) << server.errors();
    EXPECT_NE(server.errors().find("secret proved"), std::string::npos) << server.errors();
    const std::string errors = server.errors();
    EXPECT_EQ(errors.find(quoted(kMove)), std::string::npos) << "the server prints no secret";
}

TEST_F(LinkSecurityTest, ASecretOnOneSideAloneIsRefusedEitherWay) {
    ServerProcess server(folder_, arguments({}));
    EXPECT_NE(refusalOf(server.address(), client(both_)).find("has no secret to prove"), std::string::npos);
    const std::string watchers = secretFile("watchers", "watch " + quoted(kWatch) + "\n");
    EXPECT_THROW((void)client(watchers), base::InputError) << "a master has to move";
    ServerProcess watched(folder_, arguments({"--secret-file", watchers}));
    EXPECT_NE(refusalOf(watched.address(), client(both_)).find("no secret of role move"), std::string::npos);
}

TEST_F(LinkSecurityTest, AWholeGreetingPlayedBackOpensNothing) {
    ServerProcess server(folder_, arguments({"--secret-file", both_}));
    Capture capture;
    {
        ImpairedLink recorder({}, "127.0.0.1", server.port(), 0, capture.tap());
        ASSERT_TRUE(links({"127.0.0.1", recorder.port()}, client(both_)));
    }
    RawPeer replayer(server.port());
    replayer.send(std::span(capture.there).first(std::min<std::size_t>(capture.there.size(), 1024)));
    const auto challenge = replayer.receive();
    ASSERT_TRUE(challenge && std::holds_alternative<Challenge>(*challenge));
    EXPECT_NE(replayer.refusal().find("the secret of role move differs here"), std::string::npos);
}

TEST_F(LinkSecurityTest, NeitherSideFallsBackFromTls) {
    ServerProcess sealed(folder_, arguments({"--secret-file", both_, "--tls"}));
    const Address address = sealed.address();
    EXPECT_NE(refusalOf(address, client(both_)).find("accepts only TLS"), std::string::npos);
    EXPECT_TRUE(links(address, client(both_, true))) << sealed.errors();
    const std::string wrong = secretFile("wrong", "move another-secret-entirely\n");
    EXPECT_NE(refusalOf(address, client(wrong, true)).find("differs here"), std::string::npos);
    EXPECT_NE(sealed.errors().find("it does not use TLS"), std::string::npos) << sealed.errors();
    EXPECT_NE(sealed.errors().find("TLS 1.3"), std::string::npos) << sealed.errors();
    const Folder other;
    std::vector<std::string> plainly = ServerProcess::usual(sceneFile_, other);
    plainly.insert(plainly.end(), {"--secret-file", both_});
    ServerProcess plain(other, plainly);
    EXPECT_NE(refusalOf(plain.address(), client(both_, true)).find("does not use TLS"), std::string::npos);
    EXPECT_TRUE(eventually([&] { return plain.errors().find("it uses TLS") != std::string::npos; })) << plain.errors();
    EXPECT_THROW((void)client("", true), base::InputError) << "TLS without a secret proves nothing";
}

TEST_F(LinkSecurityTest, UnderTlsACaptureShowsNoProbePosition) {
    for (const bool tls : {false, true}) {
        std::vector<std::string> more{"--secret-file", both_};
        if (tls) {
            more.emplace_back("--tls");
        }
        ServerProcess server(folder_, arguments(more));
        Capture capture;
        std::vector<sand::Step> steps;
        {
            ImpairedLink recorder({}, "127.0.0.1", server.port(), 0, capture.tap());
            Client link({"127.0.0.1", recorder.port()}, offerOf(scene_), client(both_, tls));
            Wall wall(scene_);
            ASSERT_TRUE(wall.follow(link, 30)) << link.link().message << server.errors();
            ASSERT_TRUE(eventually([&] {
                for (const auto& timed : link.drain(100)) {
                    wall.apply(timed);
                    steps.push_back(timed.step);
                }
                link.shown({wall.replica.stepNumber(), 16'666'667});
                return steps.size() >= 100;
            }));
            EXPECT_EQ(wall.divergences, 0);
        }
        int positions = 0, found = 0;
        for (const sand::Step& step : steps) {
            base::ByteWriter writer;
            step.put(writer);
            if (!step.path.empty()) {
                ++positions;
                found += capture.holds(writer.bytes()) ? 1 : 0;
            }
        }
        EXPECT_GT(positions, 50);
        EXPECT_EQ(found, tls ? 0 : positions);
        const std::string_view name = "small";
        EXPECT_NE(capture.holds({reinterpret_cast<const std::uint8_t*>(name.data()), name.size()}), tls);
    }
}

TEST_F(LinkSecurityTest, WithoutASecretNoOpenSslIsMapped) {
    const auto maps = [](const ServerProcess& server) {
        std::ifstream stream("/proc/" + std::to_string(server.pid()) + "/maps");
        return std::string{std::istreambuf_iterator<char>(stream), {}};
    };
    {
        ServerProcess plain(folder_, arguments({}));
        ASSERT_NE(plain.port(), 0);
        EXPECT_EQ(maps(plain).find("libcrypto"), std::string::npos);
        EXPECT_EQ(maps(plain).find("libssl"), std::string::npos);
    }
    ServerProcess secret(folder_, arguments({"--secret-file", both_}));
    ASSERT_NE(secret.port(), 0);
    EXPECT_NE(maps(secret).find("libcrypto"), std::string::npos) << "the check finds a library that is loaded";
}

}  // namespace
