// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/handshake.hpp"

#include <fmt/format.h>

#include <utility>

namespace haptic_bridge {

std::optional<Refusal> refusalForVersions(const Identity& server, const Identity& master) {
    if (server.protocol != master.protocol) {
        return Refusal{RefusalCode::protocol,
                       fmt::format("the server speaks protocol version {}, the master {}; run the same build on both",
                                   server.protocol, master.protocol)};
    }
    if (server.algorithm != master.algorithm) {
        return Refusal{RefusalCode::algorithm,
                       fmt::format("the server's sand is algorithm version {}, the master's {}; run the same build on "
                                   "both",
                                   server.algorithm, master.algorithm)};
    }
    return std::nullopt;
}

std::optional<Refusal> refusalFor(const Identity& server, const Identity& master) {
    if (auto refusal = refusalForVersions(server, master)) {
        return refusal;
    }
    if (server.sceneName != master.sceneName) {
        return Refusal{RefusalCode::scene, fmt::format("the server has scene '{}', the master '{}'; start both with "
                                                       "the same scene",
                                                       server.sceneName, master.sceneName)};
    }
    if (server.rulesDigest != master.rulesDigest) {
        return Refusal{RefusalCode::scene,
                       fmt::format("the server's scene '{}' has another material or tool (digest {:016x}) than the "
                                   "master's '{}' ({:016x}); give both the same scene file",
                                   server.sceneName, server.rulesDigest, master.sceneName, master.rulesDigest)};
    }
    return std::nullopt;
}

MacBytes Transcript::mac(const Security& functions, const std::string& secret, Side side) const {
    base::ByteWriter writer;
    // The label differs for the two sides, so that neither side can answer with the other's proof.
    const char* const name = side == Side::master ? "master" : "server";
    writer.putText(fmt::format("sandwall {} {}", kProtocolVersion, name));
    writer.putBytes(encode(hello));
    writer.putBytes(encode(challenge));
    writer.putBlock(binding);
    return functions.hmacSha256({reinterpret_cast<const std::uint8_t*>(secret.data()), secret.size()}, writer.bytes());
}

MasterHandshake::MasterHandshake(const LinkSecurity& security, const Identity& identity, Role role, base::Bytes binding)
    : security_(security) {
    transcript_.hello = {identity, role, security.proves(), security.tls != nullptr, {}};
    transcript_.binding = std::move(binding);
    if (security.proves()) {
        security.functions->random(transcript_.hello.nonce);
    }
}

bool MasterHandshake::refuse(RefusalCode code, std::string text) {
    because_ = {code, std::move(text)};
    return false;
}

std::optional<Proof> MasterHandshake::answer(const Challenge& challenge) {
    if (challenge.server.protocol != kProtocolVersion) {
        (void)refuse(RefusalCode::protocol, "it asks for a secret in another protocol version; run the same build");
        return std::nullopt;
    }
    if (!security_.proves() || challenged_) {
        (void)refuse(RefusalCode::secret, challenged_ ? "it asks for the secret twice"
                                                      : "it asks for a secret; give this side --secret-file, too");
        return std::nullopt;
    }
    challenged_ = true;
    transcript_.challenge = challenge;
    const std::string& secret = *security_.secrets.of(transcript_.hello.role);
    return Proof{transcript_.mac(*security_.functions, secret, Transcript::Side::master)};
}

bool MasterHandshake::proven(const Identity& server, const MacBytes& mac) {
    if (!security_.proves()) {
        return true;
    }
    if (!challenged_) {
        return refuse(RefusalCode::secret, "it does not prove a secret; start it with --secret-file");
    }
    const auto proves = [&](Role role) {
        const auto& secret = security_.secrets.of(role);
        return secret && security_.functions->equal(
                             mac, transcript_.mac(*security_.functions, *secret, Transcript::Side::server));
    };
    const Role role = transcript_.hello.role;
    if (!proves(role)) {
        return proves(Role::watch)
                   ? refuse(RefusalCode::role, "it proves only the secret of role watch, and must not number steps")
                   : refuse(RefusalCode::secret, "it does not know the secret; give both sides the same --secret-file");
    }
    return server == transcript_.challenge.server ||
           refuse(RefusalCode::secret, "it is another server than the one that has proved the secret");
}

bool MasterHandshake::accepts(const Welcome& welcome) {
    if (!proven(welcome.server, welcome.mac)) {
        return false;
    }
    return welcome.role == transcript_.hello.role ||
           refuse(RefusalCode::role, "it grants role " + std::string(base::nameOf(welcome.role)) + ", but role " +
                                         std::string(base::nameOf(transcript_.hello.role)) + " was requested");
}

bool MasterHandshake::accepts(const Loading& loading) { return proven(transcript_.challenge.server, loading.mac); }

bool MasterHandshake::accepts(const PositionGreeting& greeting) {
    return proven({greeting.protocol, 0, 0, greeting.name}, greeting.mac);
}

std::optional<Refusal> ServerHandshake::refusalFor(const Hello& hello, bool overTls) const {
    if (hello.tls != overTls) {
        return Refusal{RefusalCode::tls,
                       "your side and this server disagree on TLS; another machine may be in between"};
    }
    if (security_.proves() && !hello.proves) {
        return Refusal{RefusalCode::secret, "this server asks for a secret; give your side --secret-file, too"};
    }
    if (!security_.proves() && hello.proves) {
        return Refusal{RefusalCode::secret,
                       "this server has no secret to prove; start it with --secret-file, or start your side without"};
    }
    if (security_.proves() && !security_.secrets.of(hello.role)) {
        return Refusal{RefusalCode::role, "this server has no secret of role " + std::string(base::nameOf(hello.role)) +
                                              "; add a line to its --secret-file"};
    }
    return std::nullopt;
}

std::optional<Challenge> ServerHandshake::challenge(const Hello& hello, const Identity& server, base::Bytes binding) {
    transcript_.hello = hello;
    if (!security_.proves()) {
        return std::nullopt;
    }
    transcript_.challenge = {server, {}};
    security_.functions->random(transcript_.challenge.nonce);
    transcript_.binding = std::move(binding);
    return transcript_.challenge;
}

bool ServerHandshake::accepts(const Proof& proof) const {
    return security_.functions->equal(proof.mac,
                                      transcript_.mac(*security_.functions, secret(), Transcript::Side::master));
}

MacBytes ServerHandshake::mac() const {
    return security_.proves() ? transcript_.mac(*security_.functions, secret(), Transcript::Side::server) : MacBytes{};
}

}  // namespace haptic_bridge
