// SPDX-License-Identifier: Apache-2.0
#include "master/journal/scene_check.hpp"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "base/float_environment.hpp"
#include "base/input_error.hpp"
#include "host/memory.hpp"
#include "host/priority.hpp"
#include "scene/load/memory.hpp"

namespace master {

SceneCheck::SceneCheck(std::string file, const scene::Scene& recorded, std::string journal)
    : file_(std::move(file)), journal_(std::move(journal)), recorded_(recorded) {
    if (!file_.empty()) {
        compared_ = std::async(std::launch::async, [this] { compare(); });
    }
}

bool SceneCheck::isShort() const {
    constexpr std::int64_t kBytes = std::int64_t{16} << 20;  // of 2048 x 2048 heights, read in tenths of a second
    return recorded_.size().bytesOfHeights() <= kBytes;
}

void SceneCheck::compare() {
    base::needDefaultFloats();
    if (!isShort()) {
        host::lowerPriority();
    }
    const auto progress = [this](double share) {
        share_ = share;
        if (stop_) {
            throw std::runtime_error("the session has ended");  // require() is not called any more
        }
    };
    const scene::Scene read =
        scene::loadScene(file_, {.raster = scene::checksOfOneReplica(file_, host::freeMemoryOfProcess()).raster,
                                 .field =
                                     [&](const sand::FieldSize& size) {
                                         if (size != recorded_.size()) {
                                             refuse();
                                         }
                                     },
                                 .progress = progress});
    if (!recorded_.isOf(read)) {
        refuse();
    }
}

void SceneCheck::require(const std::function<void(double)>& progress) {
    if (!compared_.valid()) {
        return;
    }
    constexpr std::chrono::milliseconds kWait{100};
    while (progress && compared_.wait_for(kWait) != std::future_status::ready) {
        progress(share_);
    }
    compared_.get();
    if (progress) {
        progress(1);
    }
}

void SceneCheck::requireIfCompared() {
    if (compared_.valid() && compared_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        compared_.get();
    }
}

void SceneCheck::refuse() const {
    throw base::InputError(
        fmt::format("{}: is not the scene of the session in {}; leave --scene out to continue that session, or choose "
                    "another --out",
                    file_, journal_));
}

}  // namespace master
