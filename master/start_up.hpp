// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lockstep/cluster.hpp"
#include "lockstep/session_message.hpp"
#include "scene/scene.hpp"

/// The master's checks before the first frame: the hosts can hold the sand, and every rank can take part.
namespace master {

/// Throws base::InputError if a host lacks memory for the replicas of its ranks. A render rank of a TIN also needs a
/// height for each nominal cell. `file` is the scene's file.
void requireMemory(const std::vector<lockstep::RankHost>& ranks, const scene::Scene& scene, const std::string& file);
/// Checks the memory for a height field before it is made. With `tin` the field becomes a TIN whose vertices are not
/// known yet, and every rank needs a height for each nominal cell.
void requireMemory(const std::vector<lockstep::RankHost>& ranks, int columns, int rows, bool tin,
                   const std::string& file);
/// Checks the memory for the pixels of a raster file before they are read. Only the master holds them.
void requireMemoryOfRaster(const std::vector<lockstep::RankHost>& ranks, int columns, int rows,
                           const std::string& file);
/// Checks the memory for the sand of a journal before it is made. Also throws base::InputError if the journal cannot be
/// read.
void requireMemoryOfJournal(const std::vector<lockstep::RankHost>& ranks, const std::filesystem::path& journal);

/// Throws base::InputError if `out` exists and is not a folder.
void requireFolder(const std::filesystem::path& out);

/// Throws base::InputError with the reason if a rank cannot take part. Otherwise prints the requests of the wall file
/// that ranks cannot meet. `names` are the names of the ranks in messages.
void requireReady(const std::vector<lockstep::Readiness>& ranks, const std::vector<std::string>& names);

}  // namespace master
