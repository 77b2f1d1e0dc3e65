// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/device_module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "base/input_error.hpp"
#include "haptic_bridge/devices/driver.hpp"
#include "haptic_bridge/hand/arm_numbers.hpp"
#include "host/module.hpp"

namespace haptic_bridge {
namespace {

namespace fs = std::filesystem;

/// Loads a driver that a user has built. It need not be from this build, but must have this interface. It is never
/// closed, because drivers may leave threads that outlive any device.
void* loadDriver(const fs::path& file, const std::string& option) {
    void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        const char* reason = dlerror();
        throw base::InputError(
            fmt::format("{}: {}; give a driver's module, and its libraries where the loader finds them", option,
                        reason == nullptr ? file.string() + " cannot be loaded" : reason));
    }
    host::repairFloatsAfter(file.string());
    return handle;
}

template <class Function>
Function* find(void* handle, const char* symbol, const fs::path& file) {
    void* address = dlsym(handle, symbol);
    if (address == nullptr) {
        throw base::InputError(
            fmt::format("{}: defines no {}; build it with haptic_bridge/devices/driver.hpp of this version of Sandwall "
                        "(docs/devices.md)",
                        file.string(), symbol));
    }
    return reinterpret_cast<Function*>(address);
}

void requireInterface(void* handle, const fs::path& file) {
    const int version = find<DriverInterface>(handle, kDriverInterfaceSymbol, file)();
    if (version != kDriverInterface) {
        throw base::InputError(
            fmt::format("{}: is a driver of interface version {}, and this program takes version {}; build it with "
                        "haptic_bridge/devices/driver.hpp of this version of Sandwall (docs/devices.md)",
                        file.string(), version, kDriverInterface));
    }
}

/// Returns what `make` returns. Its exceptions become InputErrors that begin with `option`. Repairs the floats, because
/// opening a device may load further libraries.
template <class Make>
auto made(const std::string& option, const Make& make) {
    try {
        auto thing = make();
        host::repairFloatsAfter(option);
        if (!thing) {
            throw base::InputError("the driver has opened no device");
        }
        return thing;
    } catch (const std::exception& error) {
        throw base::InputError(fmt::format("{}: {}", option, error.what()));
    } catch (...) {  // a driver may throw anything
        throw base::InputError(option + ": the driver has thrown an exception without a text");
    }
}

}  // namespace

std::unique_ptr<Arm> openArmModule(const std::string& spec) {
    const std::size_t ending = spec.find(".so");
    const std::size_t colon = spec.find(':', ending == std::string::npos ? 0 : ending);
    const std::string option = "--device driver:" + spec;
    // As a path, because the loader would look for a bare name in its own folders and not in the current one.
    const fs::path file = fs::absolute(spec.substr(0, colon));
    const std::string what = colon == std::string::npos ? "" : spec.substr(colon + 1);
    void* handle = loadDriver(file, option);
    requireInterface(handle, file);
    const auto open = find<OpenArm>(handle, kArmSymbol, file);
    auto arm = made(option, [&] { return std::unique_ptr<Arm>(open(what.c_str())); });
    if (const auto complaint = complaintAbout(arm->physics(), "a driver")) {
        throw base::InputError(fmt::format("{}: {}", option, *complaint));
    }
    return arm;
}

}  // namespace haptic_bridge
