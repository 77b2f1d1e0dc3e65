// SPDX-License-Identifier: Apache-2.0
#include "tracking/head_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <glm/gtc/quaternion.hpp>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "base/text.hpp"
#include "base/text_reader.hpp"

namespace tracking {
namespace {

constexpr double kUnitTolerance = 0.01;  // largest error of the length of a direction or a quaternion
constexpr std::array<std::string_view, 14> kTitles{"time", "x",  "y",  "z",  "yaw",     "pitch",   "roll",
                                                   "qx",   "qy", "qz", "qw", "right_x", "right_y", "right_z"};
/// First titles of the groups. A group is complete or absent.
enum Group : std::size_t { kPlace = 0, kAngles = 4, kQuaternion = 7, kRight = 11, kEnd = 14 };

/// Reader of the trace's lines. It knows which cell has which value.
class LineReader {
public:
    LineReader(const std::string& name, const RoomMapping& mapping, std::string_view header)
        : name_(name), mapping_(mapping), separator_(base::separatorOf(header)), style_(name) {
        cell_.fill(kNone);
        auto titles = base::split(header, separator_);
        for (std::size_t i = 0; i < titles.size(); ++i) {
            titles[i] = base::unquoted(titles[i]);
            const auto* known = std::find(kTitles.begin(), kTitles.end(), titles[i]);
            if (known == kTitles.end()) {
                fail(1, fmt::format("column '{}' is not known; the columns are time,x,y,z and one of yaw,pitch,roll or "
                                    "qx,qy,qz,qw or right_x,right_y,right_z",
                                    titles[i].substr(0, 80)));
            }
            std::size_t& cell = cell_[static_cast<std::size_t>(known - kTitles.begin())];
            if (cell != kNone) {
                fail(1, fmt::format("column '{}' is there twice", titles[i]));
            }
            cell = i;
        }
        columns_ = titles.size();
        requireGroups();
    }

    struct Line {
        double time;  // [s]
        Pose pose;
    };
    [[nodiscard]] Line read(std::string_view text, long number) {
        const auto cells = base::split(text, separator_);
        if (cells.size() != columns_) {
            fail(number, fmt::format("{} values expected, got {}", columns_, cells.size()));
        }
        std::array<double, kEnd> value{};
        for (std::size_t i = 0; i < kEnd; ++i) {
            if (cell_[i] == kNone) {
                continue;
            }
            const std::optional<double> read = style_.numberOf(cells[cell_[i]], number);
            if (!read) {
                fail(number, fmt::format("{} is not a number: '{}'", kTitles[i], cells[cell_[i]].substr(0, 80)));
            }
            value[i] = *read;
        }
        return {value[0], poseOf(value, number)};
    }

private:
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

    [[noreturn]] void fail(long number, const std::string& message) const {
        throw base::InputError(name_, number, message);
    }

    [[nodiscard]] bool has(std::size_t first) const { return cell_[first] != kNone; }

    void requireGroups() const {
        const std::array<std::size_t, 5> bounds{kPlace, kAngles, kQuaternion, kRight, kEnd};
        int turns = 0;
        for (std::size_t g = 0; g + 1 < bounds.size(); ++g) {
            std::size_t there = 0;
            for (std::size_t i = bounds[g]; i < bounds[g + 1]; ++i) {
                there += has(i) ? 1 : 0;
            }
            for (std::size_t i = bounds[g]; (g == 0 || there > 0) && i < bounds[g + 1]; ++i) {
                if (!has(i)) {
                    fail(1, fmt::format("column '{}' is missing", kTitles[i]));
                }
            }
            turns += g > 0 && there > 0 ? 1 : 0;
        }
        if (turns > 1) {
            fail(1, "several groups of columns give the head's turn; keep one group");
        }
        if (mapping_.eyes != glm::dvec3(0) && has(kRight)) {
            fail(1,
                 "eyes= needs yaw,pitch,roll or qx,qy,qz,qw: right_x,right_y,right_z does not give the direction up");
        }
    }

    [[nodiscard]] Pose poseOf(const std::array<double, kEnd>& value, long number) const {
        Measured measured{{value[1], value[2], value[3]}, glm::dmat3(1.0)};
        for (std::size_t i = 1; i < 4; ++i) {
            if (std::abs(value[i]) > kFarthest) {
                fail(number, fmt::format("{} is in metres and at most {}, got {}", kTitles[i], kFarthest, value[i]));
            }
        }
        if (has(kAngles)) {
            measured.rotation = rotationOf(value[kAngles], value[kAngles + 1], value[kAngles + 2]);
        } else if (has(kQuaternion)) {
            const glm::dquat turn(value[kQuaternion + 3], value[kQuaternion], value[kQuaternion + 1],
                                  value[kQuaternion + 2]);
            requireUnit(glm::length(turn), "the quaternion", number);
            measured.rotation = glm::mat3_cast(glm::normalize(turn));
        }
        Pose pose = mapping_.pose(measured);
        if (has(kRight)) {
            const glm::dvec3 right(value[kRight], value[kRight + 1], value[kRight + 2]);
            requireUnit(glm::length(right), "right_x,right_y,right_z", number);
            // This is a direction in the tracker's axes, not a turn.
            pose.right = glm::normalize(mapping_.axes * right);
        }
        return pose;
    }

    void requireUnit(double length, std::string_view what, long number) const {
        if (!(std::abs(length - 1) <= kUnitTolerance)) {
            fail(number, fmt::format("{} must have length 1, got {:.4g}", what, length));
        }
    }

    const std::string& name_;
    const RoomMapping& mapping_;
    std::array<std::size_t, kEnd> cell_{};
    std::size_t columns_ = 0;
    char separator_;
    base::DecimalStyle style_;
};

}  // namespace

HeadTrace HeadTrace::load(const std::filesystem::path& file, const RoomMapping& mapping) {
    std::ifstream stream(file);
    if (!stream || std::filesystem::is_directory(file)) {
        throw base::InputError(fmt::format("{}: the head's trace cannot be read; check the path", file.string()));
    }
    return parse(stream, file.string(), mapping);
}

HeadTrace HeadTrace::parse(std::istream& text, const std::string& name, const RoomMapping& mapping) {
    base::TextReader lines(text, name);
    std::string_view line;
    if (!lines.nextLine(line)) {
        lines.fail("the trace is empty; a header such as time,x,y,z comes first");
    }
    LineReader reader(name, mapping, line);
    HeadTrace trace;
    double first = 0, last = 0;
    while (lines.nextLine(line)) {
        if (base::trimmed(line).empty()) {
            continue;
        }
        const LineReader::Line read = reader.read(line, lines.line());
        if (trace.samples_.empty()) {
            first = last = read.time;
        }
        if (read.time < last) {
            lines.fail(fmt::format("time runs backwards: {} after {}", read.time, last));
        }
        last = read.time;
        trace.samples_.push_back({last - first, read.pose});
    }
    if (trace.samples_.empty()) {
        throw base::InputError(name, 1, "the trace holds no sample; lines of numbers follow the header");
    }
    return trace;
}

Pose HeadTrace::at(double seconds) const {
    const auto after = std::upper_bound(samples_.begin(), samples_.end(), seconds,
                                        [](double time, const Sample& sample) { return time < sample.time; });
    if (after == samples_.begin()) {
        return samples_.front().pose;
    }
    if (after == samples_.end()) {
        return samples_.back().pose;
    }
    const Sample& from = *(after - 1);
    const double share = (seconds - from.time) / (after->time - from.time);
    const glm::dvec3 right = from.pose.right + share * (after->pose.right - from.pose.right);
    // If the head looks backwards in the next sample, the trace does not show the direction of the turn.
    const bool turned = glm::length(right) > 1e-6;
    return {from.pose.position + share * (after->pose.position - from.pose.position),
            turned ? glm::normalize(right) : from.pose.right};
}

}  // namespace tracking
