// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <string>

#include "sand/start.hpp"
#include "scene/model/scene.hpp"

namespace master {

/// Compares the scene in a file with the scene of a journal. A thread of its own reads the file, so that the caller can
/// decode the journal at the same time. Both take seconds for a large raster.
///
/// The constructor returns at once. The destructor waits for the thread. Used by one thread.
class SceneCheck {
public:
    /// Begins to read `file`. An empty name makes a check that accepts every scene. `recorded` is the size of the
    /// journal's field: a file of another size is refused before its heights are made. `journal` names the journal in
    /// messages.
    SceneCheck(std::string file, sand::FieldSize recorded, std::string journal);

    /// Returns when the file is read and describes the scene `recorded`. Throws base::InputError if it describes
    /// another one or cannot be read. Calls `progress` with the part of the file that is read, 0 to 1, several times a
    /// second. Later calls return at once.
    void require(const scene::Scene& recorded, const std::function<void(double)>& progress = {});
    /// Does so only if the file has been read already.
    void requireIfRead(const scene::Scene& recorded);

private:
    [[nodiscard]] scene::Scene read(const sand::FieldSize& recorded);
    [[noreturn]] void refuse() const;

    std::string file_, journal_;
    std::atomic<double> share_ = 0;   // of the file, that is read
    std::future<scene::Scene> read_;  // the last member, so that its thread ends first
};

}  // namespace master
