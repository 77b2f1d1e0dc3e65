// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/open_device.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "base/input_error.hpp"
#include "haptic_bridge/devices/device_module.hpp"
#include "haptic_bridge/devices/mapped_device.hpp"
#include "haptic_bridge/devices/simulated_arm.hpp"
#include "haptic_bridge/devices/spacenav.hpp"
#include "haptic_bridge/devices/strokes.hpp"
#include "haptic_bridge/devices/trace.hpp"

namespace haptic_bridge {
namespace {

std::ifstream openToRead(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    // Opening a folder succeeds; reading it does not.
    if (!stream || (stream.peek(), stream.bad())) {
        throw base::InputError(file + ": cannot be read; give --device a file that exists");
    }
    return stream;
}

/// Opens a simulated arm. Its stroke list is in hand space. The arm is therefore opened once to learn its reach, and
/// again with the size of hand space in metres.
std::unique_ptr<Device> openSimulated(const std::string& spec, const HandSettings& settings,
                                      const scene::Scene& scene) {
    const double scale = MappedDevice::scaleFor(openSimulatedArm(spec)->physics(), settings, scene);
    const double half = std::min(scene.rules.columns, scene.rules.rows) * scene.terrain.cellSize() / 2;
    const StrokeSpace space{half / scale, scene.toolRadius() / (scale * settings.verticalScale)};
    return std::make_unique<MappedDevice>(openSimulatedArm(spec, space), settings, scene);
}

std::unique_ptr<Device> openTrace(const std::string& what, const HandSettings& settings, const scene::Scene& scene) {
    if (settings.engage == HandSettings::Engage::button) {
        throw base::InputError("--map engage=button: a trace records no buttons; give near or always");
    }
    std::ifstream file = openToRead(what);
    const double cell = scene.terrain.cellSize();
    return std::make_unique<TraceDevice>(Trace::parse(file, what, settings), settings, scene.rules.columns * cell,
                                         scene.rules.rows * cell, scene.toolRadius());
}

}  // namespace

bool isRealDevice(std::string_view spec) {
    const std::string_view kind = spec.substr(0, spec.find(':'));
    return kind == "driver" || kind == "spacenav";
}

std::unique_ptr<Device> openDevice(const std::string& spec, const HandSettings& settings, const scene::Scene& scene) {
    const auto colon = spec.find(':');
    const std::string kind = spec.substr(0, colon);
    const std::string what = colon == std::string::npos ? "" : spec.substr(colon + 1);
    if (kind == "script" && what == "gis") {
        return std::make_unique<StrokeDevice>(Strokes::parse(gisStrokes(), "gis.strokes"));
    }
    if (kind == "script" && !what.empty()) {
        std::ifstream file = openToRead(what);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        return std::make_unique<StrokeDevice>(Strokes::parse(text, what));
    }
    if (kind == "trace" && !what.empty()) {
        return openTrace(what, settings, scene);
    }
    if (kind == "driver" && !what.empty()) {
        MappedDevice::requireSettingsOfAnArm(settings);
        return std::make_unique<MappedDevice>(openArmModule(what), settings, scene);
    }
    if (kind == "sim") {
        return openSimulated(spec, settings, scene);
    }
    if (spec == "pointer") {
        throw base::InputError("--device pointer: needs no haptic server; give it to scripts/sandwall run");
    }
    if (kind == "spacenav" && (spec == kind || !what.empty())) {
        return std::make_unique<SpacenavDevice>(what);
    }
    throw base::InputError("--device " + spec +
                           ": unknown device; give script:gis, script:FILE, trace:FILE.csv, driver:FILE.so, "
                           "sim:PRESET or spacenav");
}

}  // namespace haptic_bridge
