// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <string>

#include "scene/model/scene.hpp"

namespace master {

/// Compares the scene in a file with the scene of a journal, in a thread of low priority. This takes seconds for a
/// large raster, and the session can begin meanwhile: its sand comes from the journal.
///
/// The constructor returns at once. The destructor stops the comparison. Used by one thread.
class SceneCheck {
public:
    /// Begins to read `file`. An empty name makes a check that accepts every scene. `recorded` is the journal's scene.
    /// A file of another size is refused before its heights are made. `journal` names the journal in messages.
    SceneCheck(std::string file, const scene::Scene& recorded, std::string journal);
    SceneCheck(const SceneCheck&) = delete;
    SceneCheck& operator=(const SceneCheck&) = delete;
    ~SceneCheck() { stop_ = true; }

    /// Returns whether the file is small enough to wait for it before the session begins.
    [[nodiscard]] bool isShort() const;
    /// Returns when the scenes are compared. Throws base::InputError if the file describes another scene or cannot be
    /// read. Calls `progress` with the part of the file that is read, 0 to 1, several times a second. Later calls
    /// return at once.
    void require(const std::function<void(double)>& progress = {});
    /// Does so only if the scenes have been compared already.
    void requireIfCompared();

private:
    void compare();
    [[noreturn]] void refuse() const;

    std::string file_, journal_;
    scene::SceneIdentity recorded_;
    std::atomic<double> share_ = 0;  // of the file, that is read
    std::atomic<bool> stop_ = false;
    std::future<void> compared_;  // the last member, so that its thread ends first
};

}  // namespace master
