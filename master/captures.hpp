// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

#include "lockstep/cluster.hpp"
#include "lockstep/watchdog.hpp"
#include "master/master_sand.hpp"
#include "master/operator/background_jobs.hpp"
#include "walls/wall.hpp"

namespace master {

/// Pictures of a running session that somebody asks for: each goes into a folder of its own, OUT/capture_001 and so on.
/// Main thread only.
class Captures {
public:
    explicit Captures(std::filesystem::path out) : out_(std::move(out)) {}

    void ask(std::optional<ControlSocket::Client> client) { clients_.push_back(client); }
    /// Whether pictures of the next frame are wanted. One capture is written at a time.
    [[nodiscard]] bool wanted(const BackgroundJobs& jobs) const { return !clients_.empty() && !jobs.capturing(); }
    /// Receives the pictures of `frame`, which the ranks are sending, and lets a job write them and answer: beside the
    /// next frames, where memory holds them, else at once.
    void take(std::uint64_t frame, const MasterSand& sand, const walls::Wall& wall, const lockstep::Cluster& cluster,
              lockstep::Watchdog& watchdog, BackgroundJobs& jobs);

private:
    const std::filesystem::path out_;
    Clients clients_;
};

}  // namespace master
