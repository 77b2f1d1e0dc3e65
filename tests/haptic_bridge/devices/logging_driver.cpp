// SPDX-License-Identifier: Apache-2.0
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>

#include "haptic_bridge/devices/driver.hpp"

namespace {

using haptic_bridge::ArmReading;
using sand::force::Vec3;

int logDescriptor = -1;

[[noreturn]] void hang() {
    [[maybe_unused]] const ssize_t written = write(logDescriptor, "hangs\n", 6);
    while (true) {
        pause();
    }
}

/// An arm that presses into the sand. It writes the time [ns] and the parts of each force that it takes [N] to a file.
///
/// `what` is FAULT:FILE. The fault happens as soon as FILE.now exists:
/// - "none"
/// - "read throws", "read throws 7": read() throws an error of two lines, or a number
/// - "push throws": push() throws once; "push throws again": from then on
/// - "main hangs", "read hangs": the main thread or the force thread writes "hangs", and never continues
/// - "zero waits": a push of 0 writes "waits", and waits until FILE.go exists
class LoggingArm : public haptic_bridge::Arm {
public:
    explicit LoggingArm(const std::string& what)
        : fault_(what.substr(0, what.find(':'))), file_(what.substr(what.find(':') + 1)) {
        log_ = std::fopen(file_.c_str(), "w");
        if (log_ == nullptr || std::setvbuf(log_, nullptr, _IOLBF, 1024) != 0) {
            throw std::runtime_error("the log cannot be written");
        }
        logDescriptor = fileno(log_);
        physics_.name = "logging";
        physics_.mass = 0.1;
        physics_.damping = 1;
        physics_.friction = 0.1;
        physics_.resolution = 1e-5;
        physics_.maxForce = 5;
        physics_.reach = 0.1;
        physics_.maxStiffness = 2000;
        physics_.delayTicks = 1;
    }
    ~LoggingArm() override { std::fclose(log_); }

    [[nodiscard]] const haptic_bridge::ArmPhysics& physics() const override { return physics_; }
    [[nodiscard]] ArmReading read(double) override {
        if (fault_ != "none" && !broken_ && there(".now")) {
            broken_ = true;
            if (fault_ == "main hangs") {
                signal(SIGUSR1, [](int) { hang(); });
                syscall(SYS_tgkill, getpid(), getpid(), SIGUSR1);
            }
        }
        if (broken_ && fault_ == "read throws") {
            throw std::runtime_error("the cable\nis out");
        }
        if (broken_ && fault_ == "read throws 7") {
            throw 7;
        }
        if (broken_ && fault_ == "read hangs") {
            hang();
        }
        ArmReading reading;
        reading.place = {0, 0, -0.002};
        return reading;
    }
    void push(Vec3 force) override {
        if (broken_ && (fault_ == "push throws again" || (fault_ == "push throws" && !thrown_))) {
            thrown_ = true;
            throw std::runtime_error("the motor is hot");
        }
        if (broken_ && fault_ == "zero waits" && norm(force) == 0) {
            std::fputs("waits\n", log_);
            while (!there(".go")) {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
        }
        std::fprintf(log_, "%lld %.9g %.9g %.9g\n", static_cast<long long>(host::monotonicNs()), force.x, force.y,
                     force.z);
    }

private:
    [[nodiscard]] bool there(const char* ending) const { return access((file_ + ending).c_str(), F_OK) == 0; }

    std::string fault_, file_;
    haptic_bridge::ArmPhysics physics_;
    std::FILE* log_ = nullptr;
    bool broken_ = false, thrown_ = false;
};

}  // namespace

SANDWALL_DRIVER(LoggingArm)
