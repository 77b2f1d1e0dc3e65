// SPDX-License-Identifier: Apache-2.0
#include "lockstep/sibling_watch.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

namespace lockstep {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kLook{100};
constexpr int kPatience = 10;  // looks at a sleeping mpirun; the second process of a host waits for as many more
constexpr const char* kRank = "OMPI_COMM_WORLD_RANK=";

/// Returns the number in an environment variable that mpirun sets, or -1.
int given(const char* variable) {
    const char* const value = std::getenv(variable);
    return value == nullptr ? -1 : std::atoi(value);
}

/// State of a process as in /proc/PID/stat.
struct State {
    char state = 0;
    std::string parent;
    std::int64_t ticks = 0;  // processor time
    [[nodiscard]] bool runs() const { return state != 'Z' && state != 'X'; }
    friend bool operator==(const State&, const State&) = default;
};

/// Returns nullopt if there is no such process.
std::optional<State> stateOf(const std::string& process) {
    std::ifstream stream("/proc/" + process + "/stat");
    std::string line;
    if (!std::getline(stream, line)) {
        return std::nullopt;
    }
    // The program's name is in parentheses, and may itself have blanks and parentheses.
    std::istringstream fields(line.substr(line.rfind(')') + 1));
    State found;
    std::string other;
    fields >> found.state >> found.parent;
    for (int field = 0; field < 9; ++field) {
        fields >> other;
    }
    std::int64_t user = 0, system = 0;
    fields >> user >> system;
    found.ticks = user + system;
    return found;
}

/// Returns whether mpirun has started this process as one of the job. mpirun may have other children, such as ssh.
bool isOfJob(const std::string& process) {
    std::ifstream stream("/proc/" + process + "/environ", std::ios::binary);
    const std::string environment{std::istreambuf_iterator<char>(stream), {}};
    return environment.starts_with(kRank) || environment.find(std::string(1, '\0') + kRank) != std::string::npos;
}

/// Returns the children of a process with their states.
std::map<std::string, State> childrenOf(const std::string& process) {
    std::map<std::string, State> children;
    std::error_code none;
    for (fs::directory_iterator entry("/proc", none); !none && entry != fs::directory_iterator();
         entry.increment(none)) {
        const std::string name = entry->path().filename().string();
        if (name.front() < '1' || name.front() > '9') {
            continue;  // no process
        }
        if (const auto state = stateOf(name); state && state->parent == process) {
            children.emplace(name, *state);
        }
    }
    return children;
}

/// Counts the processes of a job on this host that run.
class Siblings {
public:
    explicit Siblings(std::string parent) : parent_(std::move(parent)) {}

    /// Returns nullopt if this process itself is not found, so that the others would not be found either.
    std::optional<int> running() {
        const std::string self = std::to_string(getpid());
        const std::map<std::string, State> children = childrenOf(parent_);
        if (children.count(self) == 0) {
            return std::nullopt;
        }
        int count = 1;
        for (const auto& [child, state] : children) {
            if (child == self || (known_.count(child) == 0 && !isOfJob(child))) {
                continue;
            }
            known_.insert(child);
            count += state.runs() ? 1 : 0;
        }
        return count;
    }

private:
    std::string parent_;
    std::set<std::string> known_;  // that are of the job
};

}  // namespace

SiblingWatch::SiblingWatch(std::function<void()> missing) : missing_(std::move(missing)) {
    const int announced = given("OMPI_COMM_WORLD_LOCAL_SIZE"), place = given("OMPI_COMM_WORLD_LOCAL_RANK");
    if (announced > 1 && (place == 0 || place == 1)) {
        thread_ = std::thread([this, announced, place] { watch(announced, kPatience * (1 + place)); });
    }
}

SiblingWatch::~SiblingWatch() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    stop_.notify_all();
    if (thread_.joinable()) {
        thread_.join();
    }
}

void SiblingWatch::watch(int announced, int patience) {
    const std::string parent = std::to_string(getppid());
    if (isOfJob(parent)) {
        return;  // a script that mpirun has started stands between, so that the others are not among its children
    }
    Siblings siblings(parent);
    std::optional<State> before;
    int asleep = 0;  // looks in a row at which mpirun slept and a process was missing
    std::unique_lock lock(mutex_);
    while (!stop_.wait_for(lock, kLook, [this] { return stopping_; })) {
        const std::optional<int> running = siblings.running();
        const std::optional<State> mpirun = stateOf(parent);
        // An mpirun on a busy machine may still start processes, or end them. It then runs or waits for a processor.
        const bool sleeps = mpirun && mpirun->state == 'S' && mpirun == before;
        before = mpirun;
        asleep = running && *running < announced && sleeps ? asleep + 1 : 0;
        if (asleep >= patience) {
            missing_();
            return;
        }
    }
}

}  // namespace lockstep
