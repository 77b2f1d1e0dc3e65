// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lockstep/cluster.hpp"
#include "lockstep/session_message.hpp"
#include "scene/scene.hpp"

/// What the master asks before the first frame: that the job can hold the sand, and that every rank can take part.
namespace master {

/// Throws base::InputError unless every host has memory for the replicas of its ranks, and for what those that draw a
/// TIN keep of its nominal cells. `file` is the scene's.
void requireMemory(const std::vector<lockstep::RankHost>& ranks, const scene::Scene& scene, const std::string& file);
/// Checks the size of a height field before it is made. With `tin` it becomes a TIN whose vertices are not known yet;
/// every rank then needs a height for each nominal cell.
void requireMemory(const std::vector<lockstep::RankHost>& ranks, int columns, int rows, bool tin,
                   const std::string& file);
/// Checks the pixels of a raster file before they are read: the master alone holds them, and all of them.
void requireMemoryOfRaster(const std::vector<lockstep::RankHost>& ranks, int columns, int rows,
                           const std::string& file);
/// Checks the sand in a journal before it is made. Also throws base::InputError if the journal cannot be read.
void requireMemoryOfJournal(const std::vector<lockstep::RankHost>& ranks, const std::filesystem::path& journal);

/// Throws base::InputError if `out` exists and is not a folder.
void requireFolder(const std::filesystem::path& out);

/// Throws base::InputError for the first rank that cannot take part, in its own words; prints what the others cannot
/// do of what the wall file asks for.
void requireReady(const std::vector<lockstep::Readiness>& ranks, const std::vector<std::string>& names);

}  // namespace master
