// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>

namespace haptic_bridge {
namespace {

/// Names of the messages, in the order of Message.
constexpr std::array<std::string_view, std::variant_size_v<Message>> kMessages{
    "Hello",      "Welcome",   "Refusal",          "Start",    "Ready",     "NeedState", "State",   "Step",
    "TimingTest", "Shown",     "TimingEcho",       "Ping",     "Pong",      "Report",    "Bye",     "EditRequest",
    "ForceShare", "TickPiece", "PositionGreeting", "Position", "Challenge", "Proof",     "CatchUp", "Loading"};

}  // namespace

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

std::string CatchUp::refusal() const {
    const bool loads = std::any_of(steps.begin(), steps.end(),
                                   [](const sand::Step& step) { return step.edit.kind == sand::Edit::load; });
    return loads ? "a step loads sand" : "";
}

std::uint64_t inAll(const WithheldCounts& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

base::Bytes encode(const Message& message) {
    std::uint32_t length = 0;
    base::ByteWriter writer;
    writer.put(length);  // the length is known only at the end; hundreds of megabytes are then written once
    writer.put(static_cast<std::uint8_t>(message.index() + 1));
    std::visit([&writer](const auto& kind) { base::putMember(writer, kind); }, message);
    base::Bytes framed = writer.take();
    length = static_cast<std::uint32_t>(framed.size() - sizeof length);
    std::memcpy(framed.data(), &length, sizeof length);
    return framed;
}

std::uint32_t framedLength(std::span<const std::uint8_t> stream) {
    return base::ByteReader(stream).get<std::uint32_t>();
}

Message decode(std::span<const std::uint8_t> typeAndPayload) {
    base::ByteReader reader(typeAndPayload);
    const auto type = reader.get<std::uint8_t>();
    if (type < 1 || type > kMessages.size()) {
        throw base::FormatError(fmt::format("a message of type {}", type));
    }
    return base::readAlternative<Message>(type - 1U, reader, kMessages);
}

}  // namespace haptic_bridge
