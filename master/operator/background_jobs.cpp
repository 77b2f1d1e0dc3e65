// SPDX-License-Identifier: Apache-2.0
#include "master/operator/background_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/input_error.hpp"

namespace master {

void BackgroundJobs::requireRoom() const {
    if (jobs_.size() >= kMost) {
        throw base::InputError(fmt::format("{} files are being written or read already; try again", jobs_.size()));
    }
}

void BackgroundJobs::start(std::function<Result()> work, Askers askers, Kind kind) {
    jobs_.push_back({std::async(std::launch::async, std::move(work)), std::move(askers), kind});
}

bool BackgroundJobs::capturing() const {
    return std::any_of(jobs_.begin(), jobs_.end(), [](const Job& job) { return job.kind == Kind::capture; });
}

std::vector<BackgroundJobs::Done> BackgroundJobs::finished(bool wait) {
    std::vector<Done> done;
    std::vector<Job> left;
    for (Job& job : jobs_) {
        if (!wait && job.work.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
            left.push_back(std::move(job));
            continue;
        }
        Done& ended = done.emplace_back();
        ended.askers = std::move(job.askers);
        ended.kind = job.kind;
        try {
            ended.result = job.work.get();
        } catch (const std::exception& error) {  // frames continue after every error of a job
            ended.error = error.what();
        }
    }
    jobs_ = std::move(left);
    return done;
}

}  // namespace master
