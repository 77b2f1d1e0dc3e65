// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <future>
#include <string>
#include <vector>

#include "master/operator/asker.hpp"
#include "sand/model/step.hpp"

namespace master {

/// Work that no frame waits for, such as writing and reading files. Each job has a thread of its own. A later frame
/// answers its askers. Only the main thread calls this class.
class BackgroundJobs {
public:
    static constexpr std::size_t kMost = 4;  // at once, because each save holds a copy of the sand

    /// Result of a job: an answer as a line of JSON and in words for a window, or an edit to ask for.
    struct Result {
        std::string json;
        sand::Edit edit;
        std::string words{};
    };
    enum class Kind { file, capture, undo };
    /// A job that has ended. `error` is empty if it succeeded.
    struct Done {
        Askers askers;
        Result result;
        std::string error;
        Kind kind = Kind::file;
    };

    /// Throws base::InputError if kMost jobs are running.
    void requireRoom() const;
    void start(std::function<Result()> work, Askers askers, Kind kind = Kind::file);
    /// Returns whether pictures are being written.
    [[nodiscard]] bool capturing() const;
    /// Returns the jobs that have ended since the last call. With `wait`, waits until all jobs have ended.
    [[nodiscard]] std::vector<Done> finished(bool wait);

private:
    struct Job {
        std::future<Result> work;
        Askers askers;
        Kind kind;
    };
    std::vector<Job> jobs_;
};

}  // namespace master
