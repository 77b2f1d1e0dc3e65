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

/// A program that runs beside the test and writes its output into a file. The destructor kills it with all its
/// descendants.
class ChildProcess {
public:
    static constexpr double kPatience = 120;  // [s]: a bound for a very busy machine, never a measurement

    /// Starts `command`, whose first element is a path. Throws std::runtime_error if the program cannot be started.
    ChildProcess(const std::vector<std::string>& command, std::filesystem::path outputFile);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    [[nodiscard]] pid_t pid() const { return pid_; }
    /// Returns all output so far of the program and its children, stdout and stderr together.
    [[nodiscard]] std::string output() const;
    /// Waits until `condition` is true. Returns false if it is still false after `seconds`, or when the program has
    /// ended.
    [[nodiscard]] bool waitUntil(const std::function<bool()>& condition, double seconds = kPatience);
    /// Returns the events of one name so far. The program and its children run with SANDWALL_EVENTS=1.
    [[nodiscard]] std::vector<nlohmann::json> events(const std::string& name) const;
    /// Waits for an event of this name that has the fields of `wanted` (support::holds), and returns the first one.
    /// Returns null if the event does not come in time or before the program ends.
    [[nodiscard]] nlohmann::json waitForEvent(const std::string& name, const nlohmann::json& wanted = {},
                                              double seconds = kPatience);
    /// Waits for an event of this name that `wanted` accepts, and returns the first one. Returns null if the event does
    /// not come in time or before the program ends.
    [[nodiscard]] nlohmann::json waitForEvent(const std::string& name,
                                              const std::function<bool(const nlohmann::json&)>& wanted,
                                              double seconds = kPatience);
    /// Waits for the end of the program. Returns its exit status, 128 + signal if a signal ended it, or nullopt if it
    /// still runs after `seconds`.
    [[nodiscard]] std::optional<int> wait(double seconds);
    void signal(int number) const;
    /// Writes a line to the standard input of the program.
    void type(const std::string& line) const;

    /// Returns the program and every running process that it or a descendant has started. The list includes processes
    /// that have left their parents, such as the daemons that start the ranks of another host.
    [[nodiscard]] std::vector<pid_t> family() const;

private:
    pid_t pid_;
    std::string mark_;  // NAME=value in the environment of the whole family
    int input_ = -1;    // our end of the standard input's pipe
    std::filesystem::path outputFile_;
    std::optional<int> status_;
};

/// Returns the processes that still run. A zombie does not run.
[[nodiscard]] std::vector<pid_t> alive(const std::vector<pid_t>& processes);
/// Waits until all processes have ended. Returns the ones that still run after `seconds`.
[[nodiscard]] std::vector<pid_t> waitUntilGone(const std::vector<pid_t>& processes, double seconds);
/// Returns the first of `processes` whose program is called `name`, or nullopt.
[[nodiscard]] std::optional<pid_t> findProgram(const std::vector<pid_t>& processes, const std::string& name);

}  // namespace support
