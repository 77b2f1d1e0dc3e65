// SPDX-License-Identifier: Apache-2.0
#include "tracking/dtrack.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <type_traits>

#include "base/number.hpp"
#include "base/text.hpp"

namespace tracking {
namespace {

constexpr double kMetresPerMillimetre = 0.001;
constexpr std::uint32_t kReordered = 1000;  // [frame]; a network delays a packet by fewer frames
constexpr int kMaxBodies = 1000;

/// Parser that takes expected parts from the front of a line. After the first unexpected part it takes no more.
class Cursor {
public:
    explicit Cursor(std::string_view rest) : rest_(rest) {}

    bool mark(char wanted) {
        skipBlanks();
        good_ = good_ && !rest_.empty() && rest_.front() == wanted;
        rest_.remove_prefix(good_ ? 1 : 0);
        return good_;
    }
    template <class Number>
    bool number(Number& value) {
        skipBlanks();
        std::size_t length = 0;
        if constexpr (std::is_floating_point_v<Number>) {
            length = base::readNumber(rest_, value);
        } else {
            const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
            length = error == std::errc{} ? static_cast<std::size_t>(end - rest_.data()) : 0;
        }
        good_ = good_ && length > 0;
        rest_.remove_prefix(good_ ? length : 0);
        return good_;
    }
    template <std::size_t Count>
    bool bracket(std::array<double, Count>& values) {
        bool good = mark('[');
        for (double& value : values) {
            good = good && number(value);
        }
        return good && mark(']');
    }
    [[nodiscard]] bool atEnd() {
        skipBlanks();
        return good_ && rest_.empty();
    }

private:
    void skipBlanks() {
        while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) {
            rest_.remove_prefix(1);
        }
    }

    std::string_view rest_;
    bool good_ = true;
};

/// Contents of the two lines of a packet that are read.
struct Parsed {
    bool good = true;
    bool bodies = false;  // the packet has a "6d" line
    std::optional<std::uint32_t> frame;
    std::optional<Measured> head;
};

/// Reads the bodies of a "6d" line. Reads all of them, so that a line with a broken body is refused as a whole.
void readBodies(Cursor line, int wanted, Parsed& parsed) {
    int count = 0;
    parsed.good = line.number(count) && count >= 0 && count <= kMaxBodies;
    for (int i = 0; parsed.good && i < count; ++i) {
        int number = 0;
        double quality = 0;
        std::array<double, 6> place{};
        std::array<double, 9> r{};
        parsed.good = line.mark('[') && line.number(number) && line.number(quality) && line.mark(']') &&
                      line.bracket(place) && line.bracket(r);
        // A body that the tracker does not see has a negative quality, and its numbers are zeros.
        if (parsed.good && number == wanted && quality >= 0) {
            const glm::dmat3 rotation(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]);
            parsed.head = Measured{glm::dvec3(place[0], place[1], place[2]) * kMetresPerMillimetre, rotation};
        }
    }
    parsed.good = parsed.good && line.atEnd();
}

Parsed parse(std::string_view text, int wanted) {
    Parsed parsed;
    for (std::string_view line : base::split(text, '\n')) {
        const auto blank = line.find(' ');
        const std::string_view key = line.substr(0, blank);
        Cursor rest(blank == std::string_view::npos ? "" : line.substr(blank + 1));
        if (key == "fr" && parsed.good) {
            parsed.good = !parsed.frame && rest.number(parsed.frame.emplace()) && rest.atEnd();
        } else if (key == "6d" && parsed.good) {
            parsed.good = !parsed.bodies;
            parsed.bodies = true;
            if (parsed.good) {
                readBodies(rest, wanted, parsed);
            }
        }
    }
    return parsed;
}

}  // namespace

bool DtrackReader::newer(std::uint32_t frame, bool gone) const {
    if (!newest_ || gone) {
        return true;
    }
    // Unsigned, so that the counter may wrap around.
    const std::uint32_t behind = *newest_ - frame;
    return behind > kReordered;
}

Reading DtrackReader::read(std::span<const std::uint8_t> packet, bool gone) {
    std::string_view text(reinterpret_cast<const char*>(packet.data()), packet.size());
    // Some senders end the text with a zero byte, as in C.
    while (text.ends_with('\0')) {
        text.remove_suffix(1);
    }
    const Parsed parsed = parse(text, body_);
    if (!parsed.good || !parsed.bodies || (parsed.head && !plausible(*parsed.head))) {
        return {};
    }
    if (parsed.frame) {
        if (!newer(*parsed.frame, gone)) {
            return {Reading::Kind::old};
        }
        newest_ = parsed.frame;
    }
    return parsed.head ? Reading{Reading::Kind::pose, *parsed.head} : Reading{Reading::Kind::absent};
}

base::Bytes dtrackPacket(const Pose& pose, std::uint32_t frame, int body) {
    const glm::dvec3 place = pose.position / kMetresPerMillimetre;
    const double yaw = glm::degrees(std::atan2(-pose.right.z, pose.right.x));
    const double roll = glm::degrees(std::asin(std::clamp(pose.right.y, -1.0, 1.0)));
    const glm::dmat3 r = rotationOf(yaw, 0, roll);
    const std::string text = fmt::format(
        "fr {}\n6dcal 1\n6d 1 [{} 1.000][{:.3f} {:.3f} {:.3f} 0.0000 {:.4f} {:.4f}]"
        "[{:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}]\n",
        frame, body, place.x, place.y, place.z, yaw, roll, r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2],
        r[2][0], r[2][1], r[2][2]);
    return {text.begin(), text.end()};
}

}  // namespace tracking
