// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lockstep/cluster.hpp"
#include "lockstep/session_message.hpp"
#include "scene/scene.hpp"
#include "walls/wall.hpp"

/// What the master asks before the first frame: that the job can hold the sand, and that every rank can take part.
namespace master {

/// How each rank is spoken of, by rank: "rank 5 (tile r2c1) on node3".
[[nodiscard]] std::vector<std::string> namesOf(const lockstep::Cluster& cluster, const walls::Wall& wall);

/// Throws base::InputError unless every host has memory for the replicas of its ranks, and for what those that draw a
/// TIN keep of its nominal cells. `file` is the scene's.
void requireMemory(const std::vector<lockstep::RankHost>& ranks, const scene::Scene& scene, const std::string& file);
/// The same of a height field of this size, which need not be made for it. `tin`: a TIN is made of it, whose vertices
/// are not known yet; every rank needs a height for each nominal cell.
void requireMemory(const std::vector<lockstep::RankHost>& ranks, int columns, int rows, bool tin,
                   const std::string& file);
/// The same of the sand in a journal, before it is made. Throws base::InputError for a journal that cannot be read.
void requireMemoryOfJournal(const std::vector<lockstep::RankHost>& ranks, const std::filesystem::path& journal);

/// Throws base::InputError where --out names something that is there and is no folder.
void requireFolder(const std::filesystem::path& out);

/// Throws base::InputError for the first rank that cannot take part, in its own words; prints what the others cannot
/// do of what the wall file asks for.
void requireReady(const std::vector<lockstep::Readiness>& ranks, const std::vector<std::string>& names);

}  // namespace master
