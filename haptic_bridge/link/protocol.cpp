// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <type_traits>

namespace haptic_bridge {
namespace {

void putIdentity(const Identity& identity, base::ByteWriter& writer) {
    writer.put(kMagic);
    writer.put(identity.protocol);
    writer.put(identity.algorithm);
    writer.put(identity.rulesDigest);
    writer.putText(std::string_view(identity.sceneName).substr(0, kMaxSceneName));
}

/// Reads a text of the other side. Such texts are printed, so control characters are replaced and the text stays on one
/// line.
std::string getLine(base::ByteReader& reader) {
    std::string text = reader.getText();
    const auto at = [&text](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (at(i) < 0x20 || at(i) == 0x7f) {
            text[i] = '?';
        } else if (at(i) == 0xc2 && at(i + 1) >= 0x80 && at(i + 1) <= 0x9f) {  // U+0080 to U+009F
            text[i] = text[i + 1] = '?';
        }
    }
    return text;
}

/// Reads the reason of a Refusal or a Bye, and keeps at most kMaxReason bytes of it. A server that connects again and
/// again must not fill the master's log.
std::string getReason(base::ByteReader& reader) {
    std::string reason = getLine(reader);
    if (reason.size() > kMaxReason) {
        std::size_t end = kMaxReason - 3;
        while (end > 0 && (static_cast<unsigned char>(reason[end]) & 0xc0U) == 0x80) {  // in the middle of a character
            --end;
        }
        reason.resize(end);
        reason += "...";
    }
    return reason;
}

/// Reads an identity. If the protocol version differs, skips the rest of the message, because its layout is unknown.
Identity getIdentity(base::ByteReader& reader) {
    if (reader.get<std::uint32_t>() != kMagic) {
        throw base::FormatError("a greeting without the magic word SWHB");
    }
    Identity identity;
    identity.protocol = reader.get<std::uint32_t>();
    if (identity.protocol != kProtocolVersion) {
        reader.getBytes(reader.rest().size());
        return identity;
    }
    identity.algorithm = reader.get<std::uint32_t>();
    identity.rulesDigest = reader.get<std::uint64_t>();
    identity.sceneName = getLine(reader);
    if (identity.sceneName.size() > kMaxSceneName) {
        throw base::FormatError("a scene name of " + std::to_string(identity.sceneName.size()) + " bytes");
    }
    return identity;
}

constexpr std::uint8_t kProves = 1, kOverTls = 2;  // flags of a Hello

Role getRole(base::ByteReader& reader) {
    const auto role = reader.get<std::uint8_t>();
    if (role != static_cast<std::uint8_t>(Role::move) && role != static_cast<std::uint8_t>(Role::watch)) {
        throw base::FormatError("role " + std::to_string(role));
    }
    return static_cast<Role>(role);
}
/// Reads a byte that is at most `most`. `what` names it in the message.
std::uint8_t getUpTo(std::uint8_t most, const char* what, base::ByteReader& reader) {
    const auto value = reader.get<std::uint8_t>();
    if (value > most) {
        throw base::FormatError(fmt::format("{} of {}; at most {} is allowed", what, value, most));
    }
    return value;
}
void get(std::array<std::uint8_t, 32>& bytes, base::ByteReader& reader) {
    const auto read = reader.getBytes(bytes.size());
    std::copy(read.begin(), read.end(), bytes.begin());
}

void put(const Hello& hello, base::ByteWriter& writer) {
    putIdentity(hello.master, writer);
    writer.put(static_cast<std::uint8_t>(hello.role));
    writer.put(static_cast<std::uint8_t>((hello.proves ? kProves : 0) | (hello.tls ? kOverTls : 0)));
    writer.putBytes(hello.nonce);
}
void put(const Challenge& challenge, base::ByteWriter& writer) {
    putIdentity(challenge.server, writer);
    writer.putBytes(challenge.nonce);
}
void put(const Proof& proof, base::ByteWriter& writer) { writer.putBytes(proof.mac); }
void put(const CatchUp& catchUp, base::ByteWriter& writer) {
    writer.put(static_cast<std::uint8_t>(catchUp.last));
    writer.put(static_cast<std::uint16_t>(catchUp.steps.size()));
    for (const sand::Step& step : catchUp.steps) {
        sand::encode(step, writer);
    }
}
void put(const Welcome& welcome, base::ByteWriter& writer) {
    putIdentity(welcome.server, writer);
    writer.put(welcome.stepsPerSecond);
    writer.put(static_cast<std::uint8_t>(welcome.role));
    writer.putBytes(welcome.mac);
}
void put(const Refusal& refusal, base::ByteWriter& writer) {
    writer.put(static_cast<std::uint8_t>(refusal.code));
    writer.putText(refusal.text);
}
void put(const ForceShare& force, base::ByteWriter& writer) {
    writer.put(force.share);
    writer.put(static_cast<std::uint8_t>(force.byOperator ? 1 : 0));
}
void put(const Start& start, base::ByteWriter& writer) {
    writer.put(start.epoch);
    writer.put(start.stepNumber);
    writer.put(start.stateHash);
    put(start.force, writer);
}
void put(const Ready&, base::ByteWriter&) {}
void put(const NeedState& need, base::ByteWriter& writer) {
    writer.put(need.stepNumber);
    writer.put(need.stateHash);
}
void put(const State& state, base::ByteWriter& writer) { writer.putBytes(state.bytes); }
void put(const StepMessage& message, base::ByteWriter& writer) {
    writer.put(message.serverTimeNs);
    writer.put(message.stateHash);
    sand::encode(message.step, writer);
}
void put(const TimingTest& test, base::ByteWriter& writer) {
    writer.put(test.id);
    writer.putBytes(base::Bytes(test.padding, 0));
}
void put(const Shown& shown, base::ByteWriter& writer) {
    writer.put(shown.stepNumber);
    writer.put(shown.frameIntervalNs);
    writer.put(static_cast<std::uint8_t>(shown.held));
}
void put(const TimingEcho& echo, base::ByteWriter& writer) {
    writer.put(echo.id);
    writer.put(static_cast<std::uint8_t>(echo.leg));
}
void put(const Ping& ping, base::ByteWriter& writer) { writer.put(ping.masterNs); }
void put(const Pong& pong, base::ByteWriter& writer) {
    writer.put(pong.masterNs);
    writer.put(pong.serverNs);
}
/// Visits all numbers of a report in their order on the wire. Both encoding and decoding use this list.
template <class AnyReport, class Visit>
void eachNumber(AnyReport& report, const Visit& visit) {
    for (auto* number : {&report.hapticPeriodUsP50, &report.hapticPeriodUsP99, &report.hapticPeriodUsMax,
                         &report.forceUsP50, &report.forceUsP99, &report.toWall.msMean, &report.toWall.msStddev,
                         &report.toWall.msP50, &report.toWall.msP99, &report.toMaster.msMean, &report.toMaster.msStddev,
                         &report.toMaster.msP50, &report.toMaster.msP99, &report.stepBytesMean}) {
        visit(*number);
    }
    for (auto* number :
         {&report.steps, &report.samplesDropped, &report.ticks, &report.ticksMissed, &report.toWall.count,
          &report.toMaster.count, &report.handTicks, &report.feltTicks, &report.faultedTicks}) {
        visit(*number);
    }
    for (auto& number : report.stepsWithheld) {
        visit(number);
    }
    for (auto& number : report.guards) {
        visit(number);
    }
    for (auto& number : report.refused) {
        visit(number);
    }
}
void put(const Report& report, base::ByteWriter& writer) {
    eachNumber(report, [&writer](auto number) { writer.put(number); });
    writer.put(static_cast<std::uint8_t>(report.literal));
    writer.put(static_cast<std::uint8_t>(report.audited));
}
void put(const Bye& bye, base::ByteWriter& writer) { writer.putText(bye.reason); }
void put(const EditRequest& request, base::ByteWriter& writer) {
    writer.put(static_cast<std::uint8_t>(request.edit.kind));
    sand::encodeDetails(request.edit, writer);
}
void put(const TickPiece& piece, base::ByteWriter& writer) { writer.putBytes(piece.bytes); }
void put(const PositionGreeting& greeting, base::ByteWriter& writer) {
    writer.put(kMagic);
    writer.put(greeting.protocol);
    writer.putText(std::string_view(greeting.name).substr(0, kMaxSceneName));
    writer.putBytes(greeting.mac);
}
void put(const Position& position, base::ByteWriter& writer) {
    writer.put(position.timeNs);
    writer.put(position.x);
    writer.put(position.y);
    writer.put(position.z);
    writer.put(static_cast<std::uint8_t>(position.engaged));
}

void get(Hello& hello, base::ByteReader& reader) {
    hello.master = getIdentity(reader);
    if (hello.master.protocol == kProtocolVersion) {
        hello.role = getRole(reader);
        const auto flags = reader.get<std::uint8_t>();
        if ((flags & ~(kProves | kOverTls)) != 0) {
            throw base::FormatError("a greeting with flags " + std::to_string(flags));
        }
        hello.proves = (flags & kProves) != 0;
        hello.tls = (flags & kOverTls) != 0;
        get(hello.nonce, reader);
    }
}
void get(Challenge& challenge, base::ByteReader& reader) {
    challenge.server = getIdentity(reader);
    if (challenge.server.protocol == kProtocolVersion) {
        get(challenge.nonce, reader);
    }
}
void get(Proof& proof, base::ByteReader& reader) { get(proof.mac, reader); }
void get(CatchUp& catchUp, base::ByteReader& reader) {
    const auto last = reader.get<std::uint8_t>();
    if (last > 1) {
        throw base::FormatError("a catch-up whose mark of the last one is neither 0 nor 1");
    }
    catchUp.last = last == 1;
    auto count = reader.get<std::uint16_t>();
    if (count > kMaxCatchUp) {
        throw base::FormatError(fmt::format("a catch-up of {} steps; at most {} are allowed", count, kMaxCatchUp));
    }
    for (; count > 0; --count) {
        catchUp.steps.push_back(sand::decodeStep(reader));
        if (catchUp.steps.back().edit.kind == sand::Edit::load) {
            throw base::FormatError("a catch-up that loads sand");
        }
    }
}
void get(Welcome& welcome, base::ByteReader& reader) {
    welcome.server = getIdentity(reader);
    if (welcome.server.protocol == kProtocolVersion) {
        welcome.stepsPerSecond = reader.get<std::uint32_t>();
        welcome.role = getRole(reader);
        get(welcome.mac, reader);
    }
}
void get(Refusal& refusal, base::ByteReader& reader) {
    const auto code = reader.get<std::uint8_t>();
    if (code < static_cast<std::uint8_t>(RefusalCode::garbage) ||
        code > static_cast<std::uint8_t>(RefusalCode::limit)) {
        throw base::FormatError("a refusal with code " + std::to_string(code));
    }
    refusal.code = static_cast<RefusalCode>(code);
    refusal.text = getReason(reader);
}
void get(ForceShare& force, base::ByteReader& reader) {
    force.share = reader.get<double>();
    if (!(force.share >= 0 && force.share <= 1)) {
        throw base::FormatError("a share of the force outside 0 to 1");
    }
    const auto byOperator = reader.get<std::uint8_t>();
    if (byOperator > 1) {
        throw base::FormatError("a share of the force whose mark of an operator is neither 0 nor 1");
    }
    force.byOperator = byOperator == 1;
}
void get(Start& start, base::ByteReader& reader) {
    start.epoch = reader.get<std::uint32_t>();
    start.stepNumber = reader.get<std::uint64_t>();
    start.stateHash = reader.get<std::uint64_t>();
    get(start.force, reader);
}
void get(Ready&, base::ByteReader&) {}
void get(NeedState& need, base::ByteReader& reader) {
    need.stepNumber = reader.get<std::uint64_t>();
    need.stateHash = reader.get<std::uint64_t>();
}
void get(State& state, base::ByteReader& reader) {
    const auto bytes = reader.getBytes(reader.rest().size());
    state.bytes.assign(bytes.begin(), bytes.end());
}
void get(StepMessage& message, base::ByteReader& reader) {
    message.serverTimeNs = reader.get<std::int64_t>();
    message.stateHash = reader.get<std::uint64_t>();
    message.step = sand::decodeStep(reader);
}
void get(TimingTest& test, base::ByteReader& reader) {
    test.id = reader.get<std::uint32_t>();
    test.padding = static_cast<std::uint32_t>(reader.rest().size());
    reader.getBytes(test.padding);
}
void get(Shown& shown, base::ByteReader& reader) {
    shown.stepNumber = reader.get<std::uint64_t>();
    shown.frameIntervalNs = reader.get<std::int64_t>();
    shown.held =
        static_cast<Held>(getUpTo(static_cast<std::uint8_t>(Held::pause), "a reason to hold the sand", reader));
}
void get(TimingEcho& echo, base::ByteReader& reader) {
    echo.id = reader.get<std::uint32_t>();
    const auto leg = reader.get<std::uint8_t>();
    if (leg != static_cast<std::uint8_t>(Leg::received) && leg != static_cast<std::uint8_t>(Leg::shown)) {
        throw base::FormatError("an echo of leg " + std::to_string(leg));
    }
    echo.leg = static_cast<Leg>(leg);
}
void get(Ping& ping, base::ByteReader& reader) { ping.masterNs = reader.get<std::int64_t>(); }
void get(Pong& pong, base::ByteReader& reader) {
    pong.masterNs = reader.get<std::int64_t>();
    pong.serverNs = reader.get<std::int64_t>();
}
void get(Report& report, base::ByteReader& reader) {
    eachNumber(report, [&reader](auto& number) {
        number = reader.get<std::remove_reference_t<decltype(number)>>();
        if (!std::isfinite(static_cast<double>(number))) {
            throw base::FormatError("a report with a number that is not finite");
        }
    });
    report.literal = getUpTo(1, "a mark of literal guards", reader) == 1;
    report.audited =
        static_cast<Audited>(getUpTo(static_cast<std::uint8_t>(Audited::differed), "the result of an audit", reader));
}
void get(Bye& bye, base::ByteReader& reader) { bye.reason = getReason(reader); }
void get(EditRequest& request, base::ByteReader& reader) {
    const auto edit = reader.get<std::uint8_t>();
    if (edit == 0 || edit >= sand::kEdits) {
        throw base::FormatError("a request for edit " + std::to_string(edit));
    }
    request.edit = sand::decodeDetails(static_cast<sand::Edit::Kind>(edit), reader);
}
void get(TickPiece& piece, base::ByteReader& reader) {
    const auto bytes = reader.getBytes(reader.rest().size());
    piece.bytes.assign(bytes.begin(), bytes.end());
}
void get(PositionGreeting& greeting, base::ByteReader& reader) {
    if (reader.get<std::uint32_t>() != kMagic) {
        throw base::FormatError("a greeting without the magic word SWHB");
    }
    greeting.protocol = reader.get<std::uint32_t>();
    if (greeting.protocol != kProtocolVersion) {
        reader.getBytes(reader.rest().size());
        return;
    }
    greeting.name = getLine(reader);
    if (greeting.name.size() > kMaxSceneName) {
        throw base::FormatError("a device name of " + std::to_string(greeting.name.size()) + " bytes");
    }
    get(greeting.mac, reader);
}
/// Accepts numbers that are not finite, so that the master can report the device and keep the link.
void get(Position& position, base::ByteReader& reader) {
    position.timeNs = reader.get<std::int64_t>();
    position.x = reader.get<double>();
    position.y = reader.get<double>();
    position.z = reader.get<double>();
    position.engaged = reader.get<std::uint8_t>() != 0;
}

template <std::size_t index = 0>
Message decodeType(std::uint8_t type, base::ByteReader& reader) {
    if constexpr (index == std::variant_size_v<Message>) {
        throw base::FormatError("a message of type " + std::to_string(type));
    } else if (type == index + 1) {
        std::variant_alternative_t<index, Message> message;
        get(message, reader);
        return message;
    } else {
        return decodeType<index + 1>(type, reader);
    }
}

}  // namespace

std::uint64_t inAll(const WithheldCounts& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

std::string_view nameOf(Role role) { return role == Role::move ? "move" : "watch"; }

base::Bytes encode(const Message& message) {
    std::uint32_t length = 0;
    base::ByteWriter writer;
    writer.put(length);  // the length is known only at the end; hundreds of megabytes are then written once
    writer.put(static_cast<std::uint8_t>(message.index() + 1));
    std::visit([&writer](const auto& kind) { put(kind, writer); }, message);
    base::Bytes framed = writer.take();
    length = static_cast<std::uint32_t>(framed.size() - sizeof length);
    std::memcpy(framed.data(), &length, sizeof length);
    return framed;
}

Message decode(std::span<const std::uint8_t> typeAndPayload) {
    base::ByteReader reader(typeAndPayload);
    const auto type = reader.get<std::uint8_t>();
    Message message = decodeType(type, reader);
    if (!reader.atEnd()) {
        throw base::FormatError(fmt::format("a message of type {} with {} bytes too many", type, reader.rest().size()));
    }
    return message;
}

}  // namespace haptic_bridge
