// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace support {

/// A program that runs beside the test, its output in a file. Killed with all its descendants when this goes.
class ChildProcess {
public:
    static constexpr double kPatience = 120;  // [s]: a bound for a very busy machine, never a measurement

    /// `command[0]` is a path. Throws std::runtime_error when it cannot be started.
    ChildProcess(const std::vector<std::string>& command, std::filesystem::path outputFile);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    [[nodiscard]] pid_t pid() const { return pid_; }
    /// Everything it and its children have printed so far, stdout and stderr together.
    [[nodiscard]] std::string output() const;
    /// Waits until `condition` is true; false if it is not in time, or still is not when the program has ended.
    [[nodiscard]] bool waitUntil(const std::function<bool()>& condition, double seconds = kPatience);
    /// Its events of one name so far; it and its children run with SANDWALL_EVENTS=1.
    [[nodiscard]] std::vector<nlohmann::json> events(const std::string& name) const;
    /// Waits for an event of this name that has the fields of `wanted` (support::holds), and returns the first one;
    /// null when there is none in time or the program has ended without.
    [[nodiscard]] nlohmann::json waitForEvent(const std::string& name, const nlohmann::json& wanted = {},
                                              double seconds = kPatience);
    /// The same for the first event that `wanted` accepts.
    [[nodiscard]] nlohmann::json waitForEvent(const std::string& name,
                                              const std::function<bool(const nlohmann::json&)>& wanted,
                                              double seconds = kPatience);
    /// Exit status, 128 + signal when a signal ended it; nothing when it still runs after `seconds`.
    [[nodiscard]] std::optional<int> wait(double seconds);
    void signal(int number) const;
    /// Types a line on its standard input.
    void type(const std::string& line) const;

    /// Itself and every process that it or a descendant has started, at this moment: also those that have left their
    /// parents, as the daemons that start the ranks of another host do.
    [[nodiscard]] std::vector<pid_t> family() const;

private:
    pid_t pid_;
    std::string mark_;  // NAME=value in the environment of the whole family
    int input_ = -1;    // our end of its standard input
    std::filesystem::path outputFile_;
    std::optional<int> status_;
};

/// Those of the processes that still run; a zombie does not.
[[nodiscard]] std::vector<pid_t> alive(const std::vector<pid_t>& processes);
/// Waits until none runs; returns those left over.
[[nodiscard]] std::vector<pid_t> waitUntilGone(const std::vector<pid_t>& processes, double seconds);
/// The first of `processes` whose program is called `name`.
[[nodiscard]] std::optional<pid_t> findProgram(const std::vector<pid_t>& processes, const std::string& name);

}  // namespace support
