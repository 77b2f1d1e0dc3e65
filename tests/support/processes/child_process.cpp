// SPDX-License-Identifier: Apache-2.0
#include "tests/support/processes/child_process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "tests/support/processes/events.hpp"

namespace support {
namespace {

using Clock = std::chrono::steady_clock;

Clock::time_point deadline(double seconds) {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(20)); }

struct Stat {
    std::string name;
    char state = 'X';
    pid_t parent = 0;
};

/// Returns the kernel's record of a process; its state is X if the process does not exist.
Stat statOf(pid_t pid) {
    std::ifstream stream("/proc/" + std::to_string(pid) + "/stat");
    // Reads with getline(), because it fails quietly if the process ends meanwhile. An iterator over the stream's
    // buffer would throw.
    std::string text;
    std::getline(stream, text, '\0');
    Stat stat;
    const auto open = text.find('(');
    const auto close = text.rfind(')');
    if (open != std::string::npos && close != std::string::npos) {
        stat.name = text.substr(open + 1, close - open - 1);
        std::istringstream(text.substr(close + 1)) >> stat.state >> stat.parent;
    }
    return stat;
}

/// Returns true if the process was started with `mark` (NAME=value) in its environment.
bool carries(pid_t pid, const std::string& mark) {
    std::ifstream stream("/proc/" + std::to_string(pid) + "/environ");
    for (std::string variable; std::getline(stream, variable, '\0');) {
        if (variable == mark) {
            return true;
        }
    }
    return false;
}

bool runs(pid_t pid) {
    const char state = statOf(pid).state;
    return state != 'X' && state != 'Z';
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, std::filesystem::path outputFile)
    : outputFile_(std::move(outputFile)) {
    static int started = 0;
    const std::string name = "SANDWALL_TEST_FAMILY";
    const std::string value = std::to_string(getpid()) + "-" + std::to_string(++started);
    mark_ = name + "=" + value;
    std::vector<char*> words;
    words.reserve(command.size() + 1);
    for (const std::string& word : command) {
        words.push_back(const_cast<char*>(word.c_str()));
    }
    words.push_back(nullptr);
    std::array<int, 2> input{};
    if (pipe2(input.data(), O_CLOEXEC) != 0) {
        throw std::runtime_error("cannot make a pipe for " + command.at(0));
    }
    pid_ = fork();
    if (pid_ < 0) {
        throw std::runtime_error("cannot start " + command.at(0));
    }
    if (pid_ == 0) {
        const int file = open(outputFile_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(input[0], STDIN_FILENO);
        dup2(file, STDOUT_FILENO);
        dup2(file, STDERR_FILENO);
        setenv(name.c_str(), value.c_str(), 1);
        setenv("SANDWALL_EVENTS", "1", 1);
        execv(words[0], words.data());
        _exit(127);
    }
    close(input[0]);
    input_ = input[1];
}

ChildProcess::~ChildProcess() {
    const std::vector<pid_t> all = family();
    for (const pid_t process : all) {
        if (!status_ || process != pid_) {
            kill(process, SIGKILL);
        }
    }
    (void)wait(5);
    close(input_);
}

void ChildProcess::type(const std::string& line) const {
    const std::string text = line + "\n";
    if (write(input_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
        throw std::runtime_error("no process reads the line '" + line + "'");
    }
}

std::string ChildProcess::output() const {
    std::ifstream stream(outputFile_);
    return {std::istreambuf_iterator<char>(stream), {}};
}

bool ChildProcess::waitUntil(const std::function<bool()>& condition, double seconds) {
    const auto until = deadline(seconds);
    while (true) {
        // Asked before the condition is checked, so that the last output counts.
        const bool last = wait(0).has_value() || Clock::now() > until;
        if (condition()) {
            return true;
        }
        if (last) {
            return false;
        }
        pause();
    }
}

std::vector<nlohmann::json> ChildProcess::events(const std::string& name) const { return eventsIn(output(), name); }

nlohmann::json ChildProcess::waitForEvent(const std::string& name, const nlohmann::json& wanted, double seconds) {
    return waitForEvent(
        name, [&](const nlohmann::json& event) { return wanted.is_null() || holds(event, wanted); }, seconds);
}

nlohmann::json ChildProcess::waitForEvent(const std::string& name,
                                          const std::function<bool(const nlohmann::json&)>& wanted, double seconds) {
    nlohmann::json found;
    (void)waitUntil(
        [&] {
            const std::vector<nlohmann::json> all = events(name);
            const auto first = std::find_if(all.begin(), all.end(), wanted);
            found = first == all.end() ? nlohmann::json() : *first;
            return first != all.end();
        },
        seconds);
    return found;
}

std::optional<int> ChildProcess::wait(double seconds) {
    const auto until = deadline(seconds);
    while (!status_) {
        int ended = 0;
        if (waitpid(pid_, &ended, WNOHANG) == pid_) {
            status_ = WIFEXITED(ended) ? WEXITSTATUS(ended) : 128 + WTERMSIG(ended);
        } else if (Clock::now() > until) {
            break;
        } else {
            pause();
        }
    }
    return status_;
}

void ChildProcess::signal(int number) const { kill(pid_, number); }

std::vector<pid_t> ChildProcess::family() const {
    std::multimap<pid_t, pid_t> children;
    std::vector<pid_t> all{pid_};
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        const std::string name = entry.path().filename();
        if (std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; })) {
            const pid_t pid = static_cast<pid_t>(std::stol(name));
            children.emplace(statOf(pid).parent, pid);
            if (pid != pid_ && carries(pid, mark_)) {
                all.push_back(pid);
            }
        }
    }
    // A child between fork and exec, or with an environment of its own, is found by its parent.
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto [first, last] = children.equal_range(all[i]);
        std::for_each(first, last, [&](const auto& pair) {
            if (std::find(all.begin(), all.end(), pair.second) == all.end()) {
                all.push_back(pair.second);
            }
        });
    }
    return all;
}

std::vector<pid_t> alive(const std::vector<pid_t>& processes) {
    std::vector<pid_t> result;
    std::copy_if(processes.begin(), processes.end(), std::back_inserter(result), runs);
    return result;
}

std::vector<pid_t> waitUntilGone(const std::vector<pid_t>& processes, double seconds) {
    const auto until = deadline(seconds);
    std::vector<pid_t> left = alive(processes);
    while (!left.empty() && Clock::now() < until) {
        pause();
        left = alive(left);
    }
    return left;
}

std::optional<pid_t> findProgram(const std::vector<pid_t>& processes, const std::string& name) {
    // The kernel stores fifteen letters of a name.
    const auto found = std::find_if(processes.begin(), processes.end(),
                                    [&](pid_t pid) { return statOf(pid).name == name.substr(0, 15); });
    return found == processes.end() ? std::nullopt : std::optional(*found);
}

}  // namespace support
