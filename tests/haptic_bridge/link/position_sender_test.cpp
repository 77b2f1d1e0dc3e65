// SPDX-License-Identifier: Apache-2.0
// The example of a position server, which is written in Python, proves its secret as the server does.
#include <array>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "haptic_bridge/link/handshake.hpp"
#include "tests/haptic_bridge/link/link_security_fixture.hpp"
#include "tests/haptic_bridge/link/raw_peer.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;

/// The example of a position server, as a process of its own. It ends by the shell's timeout, even if a test fails.
class PositionSender {
public:
    PositionSender(Folder& folder, const std::string& option) : folder_(folder) {
        const std::string script = SANDWALL_SOURCE_DIR "/haptic_bridge/examples/position_sender.py";
        output_ = popen(("timeout 60 python3 " + script + " --listen 127.0.0.1:0 " + option +
                         " 2>/dev/null & echo $! >" + folder_.file("pid") + "; wait")
                            .c_str(),
                        "r");
        std::array<char, 200> line{};
        const std::string text =
            output_ != nullptr && fgets(line.data(), line.size(), output_) != nullptr ? line.data() : "";
        port_ = static_cast<std::uint16_t>(std::atoi(text.substr(text.rfind(':') + 1).c_str()));
        EXPECT_NE(port_, 0) << text;
    }
    ~PositionSender() {
        kill(std::atoi(folder_.read("pid").c_str()), SIGTERM);
        pclose(output_);
    }
    PositionSender(const PositionSender&) = delete;
    PositionSender& operator=(const PositionSender&) = delete;

    [[nodiscard]] std::uint16_t port() const { return port_; }

private:
    Folder& folder_;
    FILE* output_ = nullptr;
    std::uint16_t port_ = 0;
};

TEST_F(LinkSecurityTest, TheExampleOfAPositionServerProvesItsSecret) {
    const std::string wrong = secretFile("wrong", "move another-secret-entirely\n");
    for (const auto& [option, file, fits] :
         std::vector<std::tuple<std::string, std::string, bool>>{{"--secret-file " + both_, both_, true},
                                                                 {"--secret-file " + both_, wrong, false},
                                                                 {"--secret-file " + both_, "", false},
                                                                 {"", both_, false},
                                                                 {"", "", true}}) {
        const PositionSender sender(folder_, option);
        Client link({"127.0.0.1", sender.port()}, offerOf(scene_), file.empty() ? LinkSecurity{} : client(file));
        EXPECT_TRUE(eventually([&] {
            const Link now = link.link().link;
            return now == Link::streaming || now == Link::refused || now == Link::lost ||
                   link.link().message.find("does not answer") != std::string::npos;
        }));
        EXPECT_EQ(link.link().link == Link::streaming, fits) << option << file << ": " << link.link().message;
    }
}

// Both servers compare the proof with code of their own.
TEST_F(LinkSecurityTest, BothServersRefuseAProofThatIsWrongInOneBit) {
    const LinkSecurity security = client(both_);
    /// Returns the answer of the server at `port` to a proof with this bit wrong, or to the right one.
    const auto answer = [&](std::uint16_t port, std::optional<std::size_t> bit) {
        RawPeer peer(port);
        MasterHandshake master(security, hello().master, Role::move, {});
        peer.send(master.hello());
        const auto challenge = peer.receive();
        if (!challenge || !std::holds_alternative<Challenge>(*challenge)) {
            return std::string("no challenge");
        }
        Proof proof = *master.answer(std::get<Challenge>(*challenge));
        if (bit) {
            proof.mac.at(*bit / 8) ^= static_cast<std::uint8_t>(1U << *bit % 8);
        }
        peer.send(proof);
        const auto reply = peer.receive();
        const auto* const refusal = reply ? std::get_if<Refusal>(&*reply) : nullptr;
        const auto* const welcome = reply ? std::get_if<Welcome>(&*reply) : nullptr;
        const auto* const greeting = reply ? std::get_if<PositionGreeting>(&*reply) : nullptr;
        const bool accepted =
            (welcome != nullptr && master.accepts(*welcome)) || (greeting != nullptr && master.accepts(*greeting));
        return refusal != nullptr ? refusal->text : accepted ? "accepted" : "another answer";
    };
    const ServerProcess server(folder_, arguments({"--secret-file", both_}));
    const PositionSender sender(folder_, "--secret-file " + both_);
    for (const std::uint16_t port : {server.port(), sender.port()}) {
        EXPECT_EQ(answer(port, {}), "accepted");
        for (const std::size_t bit : {0U, 127U, 128U, 255U}) {
            EXPECT_NE(answer(port, bit).find("the secret of role move differs here"), std::string::npos) << bit;
        }
        EXPECT_EQ(answer(port, {}), "accepted");
    }
}

}  // namespace
