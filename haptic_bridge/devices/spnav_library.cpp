// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/spnav_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <type_traits>

#include "base/input_error.hpp"
#include "host/clock.hpp"
#include "host/module.hpp"

namespace haptic_bridge {
namespace {

/// Returns the file that `name` names. The loader would not look in the current folder for a name without a path.
std::string fileOf(const std::string& name) {
    std::error_code ignored;
    return std::filesystem::exists(name, ignored) ? std::filesystem::absolute(name).string() : name;
}

void* loaded(const std::string& name, const std::string& option) {
    void* handle = dlopen(fileOf(name).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        const char* reason = dlerror();
        throw base::InputError(base::InputError::oneLine(
            fmt::format("--device {}: {}; install Debian's libspnav0 and spacenavd, or name the file of libspnav",
                        option, reason == nullptr ? name + " cannot be loaded" : reason)));
    }
    host::repairFloatsAfter(name);
    return handle;
}

}  // namespace

const SpnavLibrary& SpnavLibrary::load(const std::string& name, const std::string& option) {
    static std::map<std::string, SpnavLibrary> known;
    if (const auto found = known.find(name); found != known.end()) {
        return found->second;
    }
    void* handle = loaded(name, option);
    SpnavLibrary library;
    const auto find = [&](auto& function, const char* symbol, bool required) {
        void* address = dlsym(handle, symbol);
        if (address == nullptr && required) {
            throw base::InputError(
                fmt::format("--device {}: {} has no {}; name the file of libspnav", option, name, symbol));
        }
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(address);
    };
    find(library.open, "spnav_open", true);
    find(library.close, "spnav_close", true);
    find(library.poll, "spnav_poll_event", true);
    find(library.socket, "spnav_fd", true);
    find(library.protocol, "spnav_protocol", false);
    return known.emplace(name, library).first->second;
}

SpnavLibrary::Link SpnavLibrary::link() const {
    const std::int64_t begun = host::monotonicNs();
    if (open() == -1) {
        return Link::absent;
    }
    // A daemon of version 0 does not answer, so that open() waits for the whole time.
    const double waited = static_cast<double>(host::monotonicNs() - begun) * 1e-9;
    if (protocol != nullptr && protocol() == 0 && waited < 0.9 * kAnswer) {
        close();
        return Link::early;
    }
    return Link::linked;
}

void SpnavLibrary::ask() const {
    // "Which sensitivity has this client?" in version 1 of the protocol: eight words, and as many in the answer.
    constexpr std::uint32_t kQuestion = 0x7faa0000, kSensitivity = 0x1002;
    const std::array<std::uint32_t, 8> packet{kQuestion | kSensitivity};
    (void)send(socket(), packet.data(), sizeof packet, MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace haptic_bridge
