// SPDX-License-Identifier: Apache-2.0
// Simulates a module of another build.
extern "C" const char* sandwallBuildId() { return "f0f0f0f0f0f0f0f0"; }
