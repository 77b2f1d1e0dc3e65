// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

#include "lockstep/frame_barrier.hpp"
#include "master/operator/background_jobs.hpp"
#include "master/steps/master_sand.hpp"
#include "walls/wall.hpp"

namespace master {

/// The folder of one capture: capture_001, or the first later one that does not exist. So the pictures of an earlier
/// session stay.
class CaptureFolder {
public:
    /// Makes the folder. If that fails, writing the first picture into it fails too.
    explicit CaptureFolder(const std::filesystem::path& out);
    /// Removes the folder with all pictures, unless keep() was called.
    ~CaptureFolder();
    CaptureFolder(const CaptureFolder&) = delete;
    CaptureFolder& operator=(const CaptureFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Called when all pictures are written.
    void keep() { whole_ = true; }

private:
    std::filesystem::path path_;
    bool made_ = false, whole_ = false;
};

/// Pictures of a running session that an operator asks for. Each capture gets a folder of its own: OUT/capture_001,
/// OUT/capture_002 and so on. Main thread only.
class Captures {
public:
    explicit Captures(std::filesystem::path out) : out_(std::move(out)) {}

    void ask(const Asker& asker) { askers_.push_back(asker); }
    /// Returns whether pictures of the next frame are wanted. Only one capture is written at a time.
    [[nodiscard]] bool wanted(const BackgroundJobs& jobs) const { return !askers_.empty() && !jobs.capturing(); }
    /// Receives the pictures of frame `frame`, which the ranks are sending, and starts a job that answers the askers.
    /// If the pictures fit into memory, the job also writes them, while the next frames are shown. Otherwise this
    /// function writes them at once.
    void take(std::uint64_t frame, const MasterSand& sand, const walls::Wall& wall, lockstep::FrameBarrier& barrier,
              BackgroundJobs& jobs);

private:
    const std::filesystem::path out_;
    Askers askers_;
};

}  // namespace master
