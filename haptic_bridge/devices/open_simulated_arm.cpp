// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>

#include "base/input_error.hpp"
#include "base/number.hpp"
#include "haptic_bridge/devices/simulated_arm.hpp"
#include "haptic_bridge/devices/strokes.hpp"
#include "haptic_bridge/hand/arm_numbers.hpp"
#include "haptic_bridge/hand/arm_presets.hpp"

namespace haptic_bridge {
namespace {

// The relaxed forearm of a person while drawing: a few hundred N/m, damped to about half of the critical damping.
constexpr Grip kUsualGrip{300, 5};

struct Spec {
    std::string text;
    std::size_t begin;  // index of the first unread character

    [[noreturn]] void fail(const std::string& what) const { throw base::InputError("--device " + text + ": " + what); }
    [[nodiscard]] std::string_view next() {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string_view word = std::string_view(text).substr(begin, end - begin);
        begin = end + 1;
        return word;
    }
    [[nodiscard]] bool more() const { return begin <= text.size(); }
    /// Reads a number for which `allowed` is true. `bounds` are what it allows, in words.
    template <class Allowed>
    [[nodiscard]] double number(std::string_view key, std::string_view word, const Allowed& allowed,
                                const std::string& bounds) const {
        double value = 0;
        if (word.empty() || base::readNumber(word, value) != word.size() || !allowed(value)) {
            fail(fmt::format("{} needs {}, got '{}'", key, bounds, word));
        }
        return value;
    }
};

Strokes readStrokes(const Spec& spec, const std::string& file) {
    if (file == "gis") {
        return Strokes::parse(gisStrokes(), "gis.strokes");
    }
    std::ifstream stream(file, std::ios::binary);
    // Opening a folder succeeds; reading it does not.
    if (!stream || (stream.peek(), stream.bad())) {
        spec.fail(fmt::format("{} cannot be read; give path=gis, or a stroke list that exists", file));
    }
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return Strokes::parse(text, file);
}

SimulatedArm::Path pathAlong(const Strokes& strokes, const StrokeSpace& space) {
    return [device = std::make_shared<StrokeDevice>(strokes), space](double time) {
        const Pose pose = device->read(time);
        return SimulatedArm::Target{{pose.x * space.halfSide, pose.y * space.halfSide, (pose.z - 1) * space.radius},
                                    pose.engaged};
    };
}

/// Settings that the keys of a spec change.
struct Settings {
    ArmPhysics physics;
    Grip grip = kUsualGrip;
};

/// Sets the number of the arm with this key. Returns false if no number has that key.
bool setNumberOfArm(ArmPhysics& physics, const Spec& spec, std::string_view key, std::string_view word) {
    const auto* number =
        std::find_if(kArmNumbers.begin(), kArmNumbers.end(), [&](const ArmNumber& n) { return n.key == key; });
    if (key.empty() || number == kArmNumbers.end()) {
        return false;
    }
    const auto allowed = [number](double value) { return number->allows(value); };
    const double value = spec.number(key, word, allowed, number->bounds());
    if (number->member != nullptr) {
        physics.*number->member = value;
        return true;
    }
    if (value != std::floor(value)) {
        spec.fail(fmt::format("{} must be a whole number of {}, got {}", key, number->unit, word));
    }
    physics.delayTicks = static_cast<int>(value);
    return true;
}

/// Sets the number with this name. Returns false if no number has that name.
bool setNumber(Settings& settings, const Spec& spec, std::string_view name, std::string_view value) {
    if (name != "grip" && name != "grip_damping") {
        return setNumberOfArm(settings.physics, spec, name, value);
    }
    const double highest = name == "grip" ? 1e5 : 1e3;
    double& number = name == "grip" ? settings.grip.stiffness : settings.grip.damping;
    const auto allowed = [highest](double given) { return given >= 0 && given <= highest; };
    number = spec.number(name, value, allowed, fmt::format("a number from 0 to {}", highest));
    return true;
}

}  // namespace

std::unique_ptr<SimulatedArm> openSimulatedArm(const std::string& text, const StrokeSpace& space) {
    Spec spec{text, std::string_view(text).starts_with("sim:") ? std::size_t{4} : std::size_t{0}};
    const std::string_view preset = spec.next();
    const auto physics = armPreset(preset);
    if (!physics) {
        spec.fail(fmt::format("preset '{}' is unknown; give touch, falcon, omega.3 or delta.3", preset));
    }
    Settings settings{.physics = *physics};
    SimulatedArm::Path path;
    while (spec.more()) {
        const std::string_view word = spec.next();
        const auto equals = word.find('=');
        const std::string_view name = word.substr(0, equals);
        const std::string_view value = equals == std::string_view::npos ? "" : word.substr(equals + 1);
        if (name == "path") {
            path = pathAlong(readStrokes(spec, std::string(value)), space);
        } else if (!setNumber(settings, spec, name, value)) {
            spec.fail(fmt::format(
                "key '{}' is unknown; the keys are path, grip, grip_damping, delay, damping, mass, friction, "
                "resolution, max_force and stiffness",
                name));
        }
    }
    return std::make_unique<SimulatedArm>(settings.physics, settings.grip, std::move(path));
}

}  // namespace haptic_bridge
