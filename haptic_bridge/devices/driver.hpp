// SPDX-License-Identifier: Apache-2.0
/// Header for drivers, the only one that a driver of your own includes: `sandwall-haptic-server --device
/// driver:FILE.so`.
///
/// Derive a class from haptic_bridge::Arm. Give it a constructor that takes `const char* what`: the text after the
/// file's name in --device, which may be empty. The constructor throws std::exception with one line for the user if the
/// device does not answer. It sets every number of ArmPhysics. The server reads them once, when it opens the device.
/// Name the class in SANDWALL_DRIVER at the end of the source.
///
/// A device holds its last force when this process is killed, crashes or hangs. So a driver sends 0 to its device when
/// push() was not called for 10 ms. It also switches on the watchdog of the device, if the device has one.
/// haptic_bridge/examples/driver_arm.cpp is a whole driver.
#pragma once

#include "base/triple_buffer.hpp"
#include "haptic_bridge/hand/arm.hpp"
#include "host/clock.hpp"

namespace haptic_bridge {

/// Version of the interface. It grows when drivers must be built again, because Arm, ArmPhysics, ArmReading or the
/// symbols below have changed.
inline constexpr int kDriverInterface = 2;

inline constexpr const char* kDriverInterfaceSymbol = "sandwallDriverInterface";
using DriverInterface = int();
inline constexpr const char* kArmSymbol = "sandwallArm1";
using OpenArm = Arm*(const char* what);

}  // namespace haptic_bridge

/// Defines the functions that the haptic server looks up in the module of a driver.
#define SANDWALL_DRIVER(Type)                                                            \
    extern "C" int sandwallDriverInterface() { return haptic_bridge::kDriverInterface; } \
    extern "C" haptic_bridge::Arm* sandwallArm1(const char* what) { return new Type(what); }
