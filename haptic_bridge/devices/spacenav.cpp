// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/devices/spacenav.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>

#include "base/input_error.hpp"

namespace haptic_bridge {

/// The parts of libspnav that are used, as its manual describes them. They are declared here, so that a build does not
/// need the library's header.
struct SpacenavDevice::Library {
    enum Type { kMotion = 1, kButton = 2 };
    struct Motion {
        int type, x, y, z, rx, ry, rz;
        unsigned int period;
        int* data;
    };
    struct Button {
        int type, press, bnum;
    };
    union Event {
        int type;
        Motion motion;
        Button button;
    };
    int (*open)() = nullptr;
    int (*close)() = nullptr;
    int (*poll)(Event*) = nullptr;

    static const Library& load(const std::string& name);
};

/// Loads the library `name` once, and never closes it.
const SpacenavDevice::Library& SpacenavDevice::Library::load(const std::string& name) {
    static std::map<std::string, Library> loaded;
    if (const auto known = loaded.find(name); known != loaded.end()) {
        return known->second;
    }
    void* handle = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        throw base::InputError(
            fmt::format("--device spacenav: {} cannot be loaded; install Debian's libspnav0 and spacenavd", name));
    }
    Library library;
    const auto find = [&](auto& function, const char* symbol) {
        void* address = dlsym(handle, symbol);
        if (address == nullptr) {
            throw base::InputError(fmt::format("--device spacenav: {} has no {}", name, symbol));
        }
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(address);
    };
    find(library.open, "spnav_open");
    find(library.close, "spnav_close");
    find(library.poll, "spnav_poll_event");
    return loaded.emplace(name, library).first->second;
}

SpacenavDevice::SpacenavDevice(const std::string& library) : library_(&Library::load(library)) {
    if (library_->open() == -1) {
        throw base::InputError("--device spacenav: no daemon answers; start spacenavd");
    }
    thread_ = std::thread([this] { listen(); });
}

SpacenavDevice::~SpacenavDevice() {
    stopping_ = true;
    thread_.join();
    library_->close();
}

void SpacenavDevice::listen() {
    while (!stopping_) {
        Library::Event event{};
        while (library_->poll(&event) != 0) {
            if (event.type == Library::kMotion) {
                push_[0] = event.motion.x;
                push_[1] = event.motion.y;
                push_[2] = event.motion.z;
            } else if (event.type == Library::kButton && event.button.bnum == 0) {
                touches_ = event.button.press != 0;
            } else if (event.type == Library::kButton && event.button.press != 0) {
                ++homings_;
            }
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

Pose SpacenavDevice::read(double time) {
    const double passed = std::clamp(time - time_, 0.0, 0.1);
    time_ = std::max(time_, time);
    const auto speed = [&](std::size_t axis) {
        return std::clamp(push_[axis].load(std::memory_order_relaxed) / kFullDeflection, -1.0, 1.0);
    };
    // Covers any field whose sides have a ratio of up to 1 to 8. The tool cannot touch sand farther out.
    pose_.x = std::clamp(pose_.x + kSpeed * speed(0) * passed, -8.0, 8.0);
    pose_.y = std::clamp(pose_.y + kSpeed * speed(2) * passed, -8.0, 8.0);
    pose_.z = std::clamp(pose_.z + kClimb * speed(1) * passed, -3.0, 20.0);
    if (const int homings = homings_; homings != homed_) {
        homed_ = homings;
        pose_ = {};
    }
    pose_.engaged = touches_;
    return pose_;
}

}  // namespace haptic_bridge
