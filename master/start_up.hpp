// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "journal/reader.hpp"
#include "lockstep/cluster.hpp"
#include "lockstep/session_message.hpp"
#include "scene/import/raster_check.hpp"
#include "scene/model/scene.hpp"
#include "scene/model/session_memory.hpp"
#include "walls/wall.hpp"

/// The master's checks before the first frame: the hosts can hold the sand, and every rank can take part.
namespace master {

/// Ranks and wall of a session, as far as memory depends on them.
struct MemoryUse {
    const std::vector<lockstep::RankHost>& hosts;  // of all ranks
    const walls::Wall& wall;                       // each rank draws one of its tiles
    bool checkpoints = true;                       // whether the master writes checkpoints
};

/// Throws base::InputError if a host lacks memory for its ranks on this sand with all of it moving. The haptic server,
/// which takes its memory meanwhile, does not count: the launcher has counted it. `text` names the sand and `file` its
/// file in the message.
void requireMemory(const MemoryUse& use, const scene::SandSize& sand, const sand::SizeText& text,
                   const std::string& file);
/// Checks the memory for a field before its heights are made.
void requireMemory(const MemoryUse& use, const scene::SandSize& sand, const std::string& file);
/// Checks the memory for a scene after its heights were made: also that of its tool, or of its TIN.
void requireMemory(const MemoryUse& use, const scene::Scene& scene, const std::string& file);
/// Checks the memory for the pixels of a raster file before they are read. Only the master holds them.
void requireMemoryOfRaster(const std::vector<lockstep::RankHost>& ranks, const scene::RasterSize& size,
                           const std::string& file);
/// Checks the memory for the sand of a journal before it is made. `reader` may have returned records.
void requireMemoryOfJournal(const MemoryUse& use, const journal::JournalReader& reader);
/// Throws base::InputError if the master itself may not take the memory for this sand, because it has a limit
/// (ulimit -v).
void requireMasterFits(const MemoryUse& use, const scene::SandSize& sand, const std::string& file);

/// Throws base::InputError if `out` exists and is not a folder.
void requireFolder(const std::filesystem::path& out);

/// Machine on which ranks must run, as the launcher's option --place names it.
struct RankMachine {
    std::vector<int> ranks;
    std::string host;     // name by which the launcher reaches it
    std::string machine;  // lockstep::machineId() there

    /// Reads "1,2,5=node01=node01.lan/3f2a…". Throws base::InputError for other texts.
    static RankMachine parse(const std::string& text);
};

/// Throws base::InputError if a rank runs on another machine than the launcher asked for, because it would draw another
/// screen. mpirun decides where a rank runs, and its rules differ between versions. Ranks without a RankMachine are not
/// checked.
void requirePlaces(const std::vector<lockstep::RankHost>& ranks, const walls::Wall& wall,
                   const std::vector<RankMachine>& places);
/// Throws base::InputError if a rank draws another tile than that of its number in the wall.
void requireTiles(const std::vector<lockstep::Readiness>& ranks, const walls::Wall& wall);

/// Throws base::InputError with the reason if a rank cannot take part: base::NotYetError if a later start may find what
/// all such ranks miss. Otherwise prints the requests of the wall file
/// that ranks cannot meet. `names` are the names of the ranks in messages.
void requireReady(const std::vector<lockstep::Readiness>& ranks, const std::vector<std::string>& names);

}  // namespace master
