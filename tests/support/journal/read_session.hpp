// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "master/journal/resume.hpp"

namespace test {

/// All that master::openSession() and master::resumeSession() return.
struct ReadSession : master::ResumedSession {
    scene::Scene scene;
    std::shared_ptr<master::SceneCheck> check;
    base::Bytes state;
};

/// Opens and resumes the session in `journal`; nullopt if the file does not exist. `scene` may name a file.
inline std::optional<ReadSession> readSession(const std::filesystem::path& journal, const std::string& scene = "",
                                              const master::ResumeProgress& progress = {}) {
    std::optional<master::StoppedSession> stopped = master::openSession(journal, scene);
    if (!stopped) {
        return std::nullopt;
    }
    scene::Scene taken = stopped->scene;
    master::ResumedState resumed = master::resumeSession(*stopped, taken, progress);
    return ReadSession{std::move(resumed.session), std::move(stopped->scene), std::move(stopped->check),
                       std::move(resumed.state)};
}

}  // namespace test
