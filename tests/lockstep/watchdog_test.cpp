// SPDX-License-Identifier: Apache-2.0
#include "lockstep/watchdog.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <string>
#include <thread>

#include "base/input_error.hpp"
#include "tests/support/machine/virtual_time.hpp"
#include "tests/support/processes/blocked_child.hpp"

namespace {

using lockstep::Wait;
using lockstep::Watchdog;

TEST(Watchdog, HasARolePerRank) {
    EXPECT_EQ(Watchdog::roleOf(0), Watchdog::Role::master);
    EXPECT_EQ(Watchdog::roleOf(1), Watchdog::Role::firstRank);
    EXPECT_EQ(Watchdog::roleOf(2), Watchdog::Role::otherRank);
    EXPECT_EQ(Watchdog::roleOf(12), Watchdog::Role::otherRank);
}

TEST(Watchdog, RefusesAStartTimeoutThatIsNoNumberOfSecondsInItsRange) {
    const auto refused = [](const char* value) -> std::string {
        setenv("SANDWALL_START_TIMEOUT", value, 1);
        try {
            lockstep::requireStartUpLimit();
        } catch (const base::InputError& error) {
            return error.what();
        }
        return "";
    };
    for (const char* good : {"", "1", "20.5", "3600", "3e2"}) {
        EXPECT_EQ(refused(good), "");
    }
    for (const char* bad : {"abc", "0.9", "3601", "-5", "nan", "inf", "20s", " 20"}) {
        EXPECT_EQ(refused(bad), std::string("SANDWALL_START_TIMEOUT: must be a number from 1 to 3600 [s], got '") +
                                    bad + "'; unset it for 120 s");
    }
    unsetenv("SANDWALL_START_TIMEOUT");
    EXPECT_NO_THROW(lockstep::requireStartUpLimit());
}

// Each description takes place after the limit, and another wait begins during it. The job must not end.
TEST(Watchdog, EndsNoJobForAWaitThatHasEndedMeanwhile) {
    EXPECT_TRUE(support::endsByItself([] {
        std::atomic<int> described{0};
        Watchdog* watched = nullptr;
        Watchdog watchdog(
            [&] {
                ++described;
                watched->arm();
                return Wait();
            },
            0.2, Watchdog::Role::master);
        watched = &watchdog;
        watchdog.startUpIsOver();
        watchdog.arm();
        while (described < 3) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        watchdog.disarm();
    }));
}

/// Options of a watchdog, and events of its process.
struct Setting {
    Watchdog::Role role = Watchdog::Role::master;
    double limit = 5;         // [s]
    bool startsUp = false;    // no frame has been shown yet
    bool patient = false;     // see Watchdog::setPatient()
    double stopped = 0;       // [s] for which the process is stopped, after the first two seconds of the wait
    double startTimeout = 0;  // [s], of the environment; 0: not set
};

/// Times of a watchdog's actions, in seconds since the begin of a wait that never ends. `spoke`: it described the wait
/// for the first time; 0: it did not. `ended`: it ended the process.
struct Course {
    double spoke = 0, ended = 0;
};

/// Memory that the child process shares.
struct Times {
    std::atomic<std::int64_t> now{kBegin}, spoke{0};  // [ns]
    static constexpr std::int64_t kBegin = 1'000'000'000'000;
    static double sinceBegin(std::int64_t time) { return static_cast<double>(time - kBegin) * 1e-9; }
};

Course courseOf(const Setting& setting) {
    void* const memory = mmap(nullptr, sizeof(Times), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    EXPECT_NE(memory, MAP_FAILED);
    Times& times = *new (memory) Times;
    EXPECT_EQ(support::statusOfChild([&] {
                  alarm(60);
                  if (setting.startTimeout > 0) {
                      setenv("SANDWALL_START_TIMEOUT", std::to_string(setting.startTimeout).c_str(), 1);
                  }
                  support::VirtualTime time(times.now);
                  Watchdog watchdog(
                      [&times] {
                          times.spoke = times.spoke == 0 ? times.now.load() : times.spoke.load();
                          return Wait();
                      },
                      setting.limit, setting.role);
                  watchdog.setPatient(setting.patient);
                  if (!setting.startsUp) {
                      watchdog.startUpIsOver();
                  }
                  watchdog.arm();
                  time.pass(2);
                  time.jump(setting.stopped);
                  time.pass(10'000);
                  time.end();
              }),
              1)
        << "the watchdog ends the process";
    const Course course{times.spoke == 0 ? 0 : Times::sinceBegin(times.spoke), Times::sinceBegin(times.now)};
    munmap(memory, sizeof(Times));
    return course;
}

constexpr double kLook = 0.1;  // [s], from one look of the watchdog to the next

/// Expects that a watchdog speaks and ends the process at its first look after these times [s].
void expectCourse(const Setting& setting, double spoke, double ended) {
    const Course course = courseOf(setting);
    EXPECT_GE(course.spoke, spoke);
    EXPECT_LE(course.spoke, spoke + (spoke > 0 ? 1.5 * kLook : 0));
    EXPECT_GE(course.ended, ended);
    EXPECT_LE(course.ended, ended + 1.5 * kLook);
}

using Role = Watchdog::Role;
constexpr double kNever = 0;

TEST(Watchdog, OfTheMasterActsFirstAndThoseOfTheOtherRanksFollow) {
    expectCourse({.role = Role::master}, 1, 5);
    expectCourse({.role = Role::firstRank}, 4, 8);
    expectCourse({.role = Role::otherRank}, kNever, 9);
}

TEST(Watchdog, WaitsLongerAtTheStart) {
    expectCourse({.role = Role::master, .startsUp = true}, 10, 120);
    expectCourse({.role = Role::firstRank, .startsUp = true}, 13, 123);
    expectCourse({.role = Role::otherRank, .startsUp = true}, kNever, 124);
    expectCourse({.limit = 200, .startsUp = true}, 10, 200);
    expectCourse({.startsUp = true, .startTimeout = 20.5}, 10, 20.5);
    expectCourse({.startTimeout = 20.5}, 1, 5);
}

TEST(Watchdog, WaitsAnHourWhileTheMasterReplaysAJournal) {
    expectCourse({.startsUp = true, .patient = true}, 10, 3600);
    expectCourse({.role = Role::otherRank, .patient = true}, kNever, 3604);
}

// A process that is stopped (SIGSTOP, a suspended machine) does not know what the others did meanwhile. Half a second
// counts, because a watchdog on a busy machine looks as rarely.
TEST(Watchdog, CountsNoTimeInWhichItsOwnProcessWasStopped) {
    constexpr double kStopped = 1000, kCounted = 0.5;
    expectCourse({.role = Role::master, .stopped = kStopped}, 1, 5 + kStopped - kCounted);
    expectCourse({.role = Role::firstRank, .stopped = kStopped}, 4 + kStopped - kCounted, 8 + kStopped - kCounted);
    expectCourse({.role = Role::otherRank, .stopped = kStopped}, kNever, 9 + kStopped - kCounted);
    expectCourse({.role = Role::master, .stopped = 0.4}, 1, 5);
}

TEST(Watchdog, MeasuresEachWaitByItself) {
    EXPECT_TRUE(support::endsByItself([] {
        std::atomic<std::int64_t> now{Times::kBegin};
        support::VirtualTime time(now);
        Watchdog watchdog([] { return Wait(); }, 5, Role::master);
        watchdog.startUpIsOver();
        for (int wait = 0; wait < 10; ++wait) {
            watchdog.arm();
            time.pass(4);
        }
        watchdog.disarm();
        time.pass(100);
        watchdog.arm();
        time.pass(4);
        watchdog.disarm();
        time.end();
    }));
}

}  // namespace
