// SPDX-License-Identifier: Apache-2.0
/// The one header that a driver of your own includes: `sandwall-haptic-server --device driver:FILE.so`.
///
/// Derive a class from haptic_bridge::Arm, with a constructor that takes `const char* what` (the text behind the file's
/// name in --device; it may be empty) and throws std::exception with one line for a person if the device is not there.
/// Name it in SANDWALL_DRIVER at the end of the source. haptic_bridge/examples/driver_arm.cpp is a whole driver.
#pragma once

#include "base/triple_buffer.hpp"
#include "haptic_bridge/hand/arm.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

/// Grows whenever a driver must be built again: when Arm, ArmPhysics, ArmReading or the symbols below change.
inline constexpr int kDriverInterface = 1;

inline constexpr const char* kDriverInterfaceSymbol = "sandwallDriverInterface";
using DriverInterface = int();
inline constexpr const char* kArmSymbol = "sandwallArm1";
using OpenArm = Arm*(const char* what);

}  // namespace haptic_bridge

/// Defines what the haptic server looks for in a driver's module.
#define SANDWALL_DRIVER(Type)                                                            \
    extern "C" int sandwallDriverInterface() { return haptic_bridge::kDriverInterface; } \
    extern "C" haptic_bridge::Arm* sandwallArm1(const char* what) { return new Type(what); }
