// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "base/field_forms.hpp"
#include "haptic_bridge/link/message_forms.hpp"
#include "sand/model/rules.hpp"

/// Messages with which a link begins. protocol.hpp lists all messages.
namespace haptic_bridge {

inline constexpr std::uint32_t kMagic = 0x42485753;  // the bytes "SWHB" on the wire
inline constexpr std::uint32_t kProtocolVersion = 12;
inline constexpr std::size_t kMaxSceneName = 256;  // [byte], also for the name of a device

/// Versions and scene of one side. Both sides must have the same before the server may send steps.
struct Identity {
    std::uint32_t protocol = kProtocolVersion;
    std::uint32_t algorithm = sand::kAlgorithmVersion;
    std::uint64_t rulesDigest = 0;  // sand::Rules::digest()
    std::string sceneName;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("magic", base::constant(kMagic, "the magic word SWHB"));
        visit("protocol", it.protocol);
        if (visit.knows(it.protocol == kProtocolVersion)) {
            visit("algorithm", it.algorithm);
            visit("rules_digest", it.rulesDigest);
            visit("scene", PrintedText{it.sceneName, kMaxSceneName});
        }
    }
    friend bool operator==(const Identity&, const Identity&) = default;
};

/// Reason why one side refuses the other.
enum class RefusalCode : std::uint8_t {
    garbage = 1,  // bytes that are not a message, or a message out of turn
    protocol,     // another protocol version
    algorithm,    // another algorithm version of the sand
    scene,        // another scene, material or tool
    busy,         // a master is linked already, or too many watchers
    state,        // a State that does not fit
    secret,       // a secret that is missing on one side, or different
    role,         // the secret of another role, or a watcher that sends more than Ping and Bye
    tls,          // TLS on one side only
    limit         // too many or too frequent connections, too many bytes, or silence
};
constexpr auto valuesOf(RefusalCode) {
    using enum RefusalCode;
    return std::array{
        base::Named{garbage, "garbage"}, base::Named{protocol, "protocol"}, base::Named{algorithm, "algorithm"},
        base::Named{scene, "scene"},     base::Named{busy, "busy"},         base::Named{state, "state"},
        base::Named{secret, "secret"},   base::Named{role, "role"},         base::Named{tls, "tls"},
        base::Named{limit, "limit"}};
}
/// Number of refusals with each code, in the order of valuesOf(RefusalCode).
using RefusalCounts = std::array<std::uint64_t, valuesOf(RefusalCode{}).size()>;

/// Rights of a connection. Each role has a secret of its own.
enum class Role : std::uint8_t {
    move = 1,  // a master: lets the server number the steps, and may send edits
    watch      // a watcher: receives the steps, and sends only Ping and Bye
};
constexpr auto valuesOf(Role) { return std::array{base::Named{Role::move, "move"}, base::Named{Role::watch, "watch"}}; }

using Nonce = std::array<std::uint8_t, 32>;     // random bytes, new for each connection
using MacBytes = std::array<std::uint8_t, 32>;  // HMAC-SHA-256

/// First message of a master or a watcher.
struct Hello {
    Identity master;
    Role role = Role::move;
    bool proves = false;  // it has a secret of `role`, and the server must prove the same secret
    bool tls = false;     // the sender uses TLS; the server refuses if its own end of the connection does not
    Nonce nonce{};        // zeros without a secret
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("master", it.master);
        if (visit.knows(it.master.protocol == kProtocolVersion)) {
            visit("role", it.role);
            visit("flags", base::flags(it.proves, it.tls));
            visit("nonce", it.nonce);
        }
    }
    friend bool operator==(const Hello&, const Hello&) = default;
};
/// Asks for proof of the secret. Answers a Hello whose `proves` is true.
struct Challenge {
    Identity server;  // a server without sand sends algorithm 0, digest 0 and the name of its device
    Nonce nonce{};
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("server", it.server);
        if (visit.knows(it.server.protocol == kProtocolVersion)) {
            visit("nonce", it.nonce);
        }
    }
    friend bool operator==(const Challenge&, const Challenge&) = default;
};
/// Accepts the connection.
struct Welcome {
    Identity server;
    std::uint32_t stepsPerSecond = 0;  // of the server's scene
    Role role = Role::move;            // the role that the server grants
    MacBytes mac{};                    // proves that the server knows the secret; zeros without a secret
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("server", it.server);
        if (visit.knows(it.server.protocol == kProtocolVersion)) {
            visit("steps_per_second", it.stepsPerSecond);
            visit("role", it.role);
            visit("mac", it.mac);
        }
    }
    friend bool operator==(const Welcome&, const Welcome&) = default;
};
/// Takes the place of the Welcome while the server still reads its scene. Sent twice a second. When the scene is read,
/// the server sends a Bye, and the peer begins again with a Hello.
struct Loading {
    static constexpr std::uint32_t kAll = 1000;
    std::uint32_t done = 0;  // part of the work that is done, of kAll
    MacBytes mac{};          // proves that the server knows the secret; zeros without a secret
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("done", base::limited(it.done, 0, kAll));
        visit("mac", it.mac);
    }
    friend bool operator==(const Loading&, const Loading&) = default;
};
/// Refuses the connection. The server then closes it.
struct Refusal {
    RefusalCode code = RefusalCode::garbage;
    std::string text;  // one line for the user: the reason, and what to do
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("code", it.code);
        visit("reason", Reason{it.text});
    }
    friend bool operator==(const Refusal&, const Refusal&) = default;
};
/// Proves to the server that the master knows the secret. Answers a Challenge.
struct Proof {
    MacBytes mac{};
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("mac", it.mac);
    }
    friend bool operator==(const Proof&, const Proof&) = default;
};
/// Takes the place of the Welcome. A server without a secret sends it at once, without reading the Hello.
struct PositionGreeting {
    std::uint32_t protocol = kProtocolVersion;
    std::string name;  // of the device, to be printed
    MacBytes mac{};    // proves that the server knows the secret; zeros without a secret
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("magic", base::constant(kMagic, "the magic word SWHB"));
        visit("protocol", it.protocol);
        if (visit.knows(it.protocol == kProtocolVersion)) {
            visit("name", PrintedText{it.name, kMaxSceneName});
            visit("mac", it.mac);
        }
    }
    friend bool operator==(const PositionGreeting&, const PositionGreeting&) = default;
};
}  // namespace haptic_bridge
