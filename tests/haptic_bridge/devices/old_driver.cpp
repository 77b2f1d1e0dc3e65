// SPDX-License-Identifier: Apache-2.0
extern "C" int sandwallDriverInterface() { return 0; }
extern "C" void* sandwallArm1(const char* /* what */) { return nullptr; }
