// SPDX-License-Identifier: Apache-2.0
// A driver for Sandwall, as a start for your own: `sandwall-haptic-server --device driver:FILE.so`. Namespace `maker`
// has six functions, which your maker's library provides. docs/devices.md lists their names in the usual libraries.
//
//     g++ -std=c++20 -O2 -shared -fPIC -I SANDWALL driver_arm.cpp -o my_driver.so -lYOURS
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "base/triple_buffer.hpp"
#include "haptic_bridge/devices/driver.hpp"
#include "host/clock.hpp"

#ifdef MAKER_HEADER
#include MAKER_HEADER  // a file of yours that defines the six functions
#else
/// Replace these bodies by calls of your library. Unchanged, they describe an arm that no hand holds.
namespace maker {
inline bool open(const char*) { return true; }
inline void close() {}
inline bool readPlace(double& x, double& y, double& z) {
    x = y = z = 0;
    return true;
}
inline bool button(int) { return false; }
inline bool setForce(double, double, double) { return true; }
inline const char* lastError() { return "no device"; }
}  // namespace maker
#endif

namespace {

using haptic_bridge::ArmPhysics;
using haptic_bridge::ArmReading;
using sand::force::Vec3;

/// Arm that uses its device on a thread of its own, because a driver may wait for its hardware and the force loop must
/// not.
///
/// The thread also sends 0 when no new force comes. It cannot do so in a process that was killed, has crashed or is
/// stopped. Let your library switch on the watchdog of the device in maker::open(), if the device has one.
class DriverArm : public haptic_bridge::Arm {
public:
    explicit DriverArm(const char* what) {
        if (!maker::open(what)) {
            throw std::runtime_error(maker::lastError());
        }
        // From the data sheet. The guards rely on these numbers. The server refuses a number that is missing or out of
        // the bounds in docs/devices.md. If in doubt, give too little damping, not too much.
        physics_.name = "my device";
        physics_.mass = 0.2;           // [kg], apparent at the tip
        physics_.damping = 1.0;        // [N s/m]
        physics_.friction = 0.3;       // [N]
        physics_.resolution = 2e-5;    // [m]
        physics_.maxForce = 8;         // [N]
        physics_.reach = 0.06;         // [m]
        physics_.maxStiffness = 2000;  // [N/m]; infinity if the maker states none
        physics_.delayTicks = 1;       // [tick of 1 ms]; this thread adds up to one
        thread_ = std::thread([this] { talk(); });
    }
    ~DriverArm() override {
        stopping_ = true;
        thread_.join();
        maker::setForce(0, 0, 0);
        maker::close();
    }

    [[nodiscard]] const ArmPhysics& physics() const override { return physics_; }
    [[nodiscard]] ArmReading read(double) override {
        const Seen& seen = seen_.latest();
        ArmReading reading = seen.reading;
        // A library that hangs must not look like a hand that rests.
        reading.present = reading.present && host::monotonicNs() - seen.timeNs < kPatienceNs;
        return reading;
    }
    void push(Vec3 force) override {
        force_.next() = {force, host::monotonicNs()};
        force_.publish();
    }

private:
    static constexpr std::int64_t kPatienceNs = 50'000'000;
    static constexpr std::int64_t kForceNs = 10'000'000;  // a force without a successor ends then
    struct Seen {
        ArmReading reading;
        std::int64_t timeNs = host::monotonicNs();
    };
    struct Wanted {
        Vec3 force;
        std::int64_t timeNs = 0;
    };

    void talk() {
        auto due = std::chrono::steady_clock::now();
        while (!stopping_) {
            Seen& seen = seen_.next();
            ArmReading& reading = seen.reading;
            reading.present = maker::readPlace(reading.place.x, reading.place.y, reading.place.z);  // [m]
            reading.first = maker::button(0);
            reading.second = maker::button(1);
            seen.timeNs = host::monotonicNs();
            seen_.publish();
            // The device would hold the last force of a force loop that stands still.
            const Wanted& wanted = force_.latest();
            const Vec3 force = host::monotonicNs() - wanted.timeNs < kForceNs ? wanted.force : Vec3{};
            maker::setForce(force.x, force.y, force.z);  // [N]
            due += std::chrono::milliseconds(1);
            std::this_thread::sleep_until(due);
        }
    }

    ArmPhysics physics_;
    base::TripleBuffer<Seen> seen_;     // device to force loop
    base::TripleBuffer<Wanted> force_;  // force loop to device
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace

SANDWALL_DRIVER(DriverArm)
