// SPDX-License-Identifier: Apache-2.0
#include "master/journal/scene_check.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "base/float_environment.hpp"
#include "base/input_error.hpp"
#include "host/memory.hpp"
#include "scene/load/memory.hpp"

namespace master {

SceneCheck::SceneCheck(std::string file, sand::FieldSize recorded, std::string journal)
    : file_(std::move(file)), journal_(std::move(journal)) {
    if (!file_.empty()) {
        read_ = std::async(std::launch::async, [this, recorded] { return read(recorded); });
    }
}

scene::Scene SceneCheck::read(const sand::FieldSize& recorded) {
    base::needDefaultFloats();
    return scene::loadScene(file_, {.raster = scene::checksOfOneReplica(file_, host::freeMemoryOfProcess()).raster,
                                    .field =
                                        [&](const sand::FieldSize& size) {
                                            if (size != recorded) {
                                                refuse();
                                            }
                                        },
                                    .progress = [this](double share) { share_ = share; }});
}

void SceneCheck::require(const scene::Scene& recorded, const std::function<void(double)>& progress) {
    if (!read_.valid()) {
        return;
    }
    constexpr std::chrono::milliseconds kWait{100};
    while (progress && read_.wait_for(kWait) != std::future_status::ready) {
        progress(share_);
    }
    if (!read_.get().isSameAs(recorded)) {
        refuse();
    }
    if (progress) {
        progress(1);
    }
}

void SceneCheck::requireIfRead(const scene::Scene& recorded) {
    if (read_.valid() && read_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        require(recorded);
    }
}

void SceneCheck::refuse() const {
    throw base::InputError(
        fmt::format("{}: is not the scene of the session in {}; leave --scene out to continue that session, or choose "
                    "another --out",
                    file_, journal_));
}

}  // namespace master
