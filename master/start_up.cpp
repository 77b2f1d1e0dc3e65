// SPDX-License-Identifier: Apache-2.0
#include "master/start_up.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/not_yet_error.hpp"
#include "base/number.hpp"
#include "base/text.hpp"
#include "host/build_id.hpp"
#include "host/event.hpp"
#include "host/memory.hpp"
#include "host/print_line.hpp"
#include "host/regular_file.hpp"
#include "master/journal/journal.hpp"
#include "scene/load/memory.hpp"
#include "walls/window_size.hpp"

namespace master {

namespace {

std::vector<lockstep::RankNeed> needsOf(const MemoryUse& use, const scene::SandSize& sand) {
    const auto needOf = [](const scene::ProcessMemory& process) {
        return lockstep::RankNeed{process.figures().most(), process.shared()};
    };
    std::vector<lockstep::RankNeed> needs{needOf(scene::ProcessMemory::ofMaster(sand, use.checkpoints))};
    for (std::size_t rank = 1; rank < use.hosts.size(); ++rank) {
        const bool draws = rank <= use.wall.tiles.size();  // requireRanks() refuses other numbers later
        needs.push_back(needOf(scene::ProcessMemory::ofRank(
            sand, draws ? walls::frameBufferBytes(use.wall, use.wall.tiles[rank - 1]) : 0)));
    }
    return needs;
}

scene::SandSize sizeOf(const sand::Rules& rules) { return {sand::FieldSize::of(rules), rules.ground != 0}; }

}  // namespace

void requireMemory(const MemoryUse& use, const scene::SandSize& sand, const sand::SizeText& text,
                   const std::string& file) {
    if (const auto lack = lockstep::lackOfMemory(use.hosts, needsOf(use, sand))) {
        throw base::InputError(
            fmt::format("{}: {} need {}; use {}, or more hosts", file, text.what, *lack, text.fewer));
    }
}

void requireMemory(const MemoryUse& use, const scene::SandSize& sand, const std::string& file) {
    requireMemory(use, sand, {sand.field.text(), "fewer cells"}, file);
}

void requireMemory(const MemoryUse& use, const scene::Scene& scene, const std::string& file) {
    requireMemory(use, scene::SandSize::of(scene), scene.sizeText(), file);
}

void requireMemoryOfRaster(const std::vector<lockstep::RankHost>& ranks, const scene::RasterSize& size,
                           const std::string& file) {
    const std::vector<lockstep::RankHost> master(ranks.begin(), ranks.begin() + (ranks.empty() ? 0 : 1));
    if (const auto lack = lockstep::lackOfMemory(master, {{size.bytes()}})) {
        throw base::InputError(
            fmt::format("{}: {} x {} pixels of a raster need {}; coarsen it", file, size.columns, size.rows, *lack));
    }
}

void requireMemoryOfJournal(const MemoryUse& use, const journal::JournalReader& reader) {
    const std::string& journal = reader.place().journal;
    const scene::SandSize size = sizeOf(journal::rulesOf(reader));
    if (size.field.bytesOfReplica()) {
        requireMemory(use, size, journal);
        requireMasterFits(use, size, journal);
    } else {
        requireMemory(use, journal::sceneOf(reader), journal);
    }
}

void requireMasterFits(const MemoryUse& use, const scene::SandSize& sand, const std::string& file) {
    scene::requireProcess(scene::ProcessMemory::ofMaster(sand, use.checkpoints).figures().most(),
                          host::freeMemoryOfProcess(), file, {sand.field.text(), "fewer cells"}, "master");
}

void requireFolder(const std::filesystem::path& out) {
    std::error_code none;
    if (std::filesystem::exists(out, none) && !std::filesystem::is_directory(out, none)) {
        throw base::InputError(fmt::format("{}: is not a folder, and --out must be one; choose another", out.string()));
    }
    // scripts/launcher/base/session_folder.py has the same check and messages.
    if (const std::string why = host::whyUnsafeFolder(out); !why.empty()) {
        throw base::InputError(fmt::format("{}: {}; {}choose another --out", out.string(), why,
                                           why.starts_with("other users") ? "run chmod go-w on it, or " : ""));
    }
    if (const std::string why = host::whyUnsafeContent(out); !why.empty()) {
        throw base::InputError(why);
    }
}

RankMachine RankMachine::parse(const std::string& text) {
    const auto first = text.find('=');
    const auto second = first == std::string::npos ? first : text.find('=', first + 1);
    RankMachine place;
    if (second != std::string::npos) {
        place.host = text.substr(first + 1, second - first - 1);
        place.machine = text.substr(second + 1);
        for (const std::string_view word : base::split(std::string_view(text).substr(0, first), ',')) {
            const double rank = base::numberOf(word).value_or(0);
            place.ranks.push_back(rank >= 1 && rank <= walls::kMaxTiles ? static_cast<int>(rank) : 0);
        }
    }
    if (place.host.empty() || place.machine.empty() ||
        std::find(place.ranks.begin(), place.ranks.end(), 0) != place.ranks.end()) {
        throw base::InputError(
            fmt::format("--place: write RANK,RANK=HOST=MACHINE, as scripts/sandwall does, got '{}'", text));
    }
    return place;
}

void requirePlaces(const std::vector<lockstep::RankHost>& ranks, const walls::Wall& wall,
                   const std::vector<RankMachine>& places) {
    for (const RankMachine& place : places) {
        for (const int rank : place.ranks) {
            const auto index = static_cast<std::size_t>(rank);
            if (index >= ranks.size() || ranks[index].machine == place.machine) {
                continue;
            }
            throw base::InputError(
                fmt::format("rank {} (tile {}): mpirun has started it on {}, but its host is {}, which is {}; look at "
                            "the command with --print-command (docs/hosts.md)",
                            rank, wall.tiles[index - 1].name, ranks[index].name, place.host,
                            place.machine.substr(0, place.machine.find('/'))));
        }
    }
}

void requireTiles(const std::vector<lockstep::Readiness>& ranks, const walls::Wall& wall) {
    for (std::size_t rank = 1; rank < ranks.size(); ++rank) {
        if (const std::string& name = wall.tiles[rank - 1].name; ranks[rank].tile != name) {
            throw base::InputError(
                fmt::format("rank {} on {}: draws the tile {} in place of {}; run the programs of one build", rank,
                            ranks[rank].host, ranks[rank].tile, name));
        }
    }
}

void requireReady(const std::vector<lockstep::Readiness>& ranks, const std::vector<std::string>& names) {
    for (std::size_t rank = 1; rank < ranks.size(); ++rank) {
        if (ranks[rank].buildId != host::buildId()) {
            throw base::InputError(
                fmt::format("{}: is of build {}, but the master is of build {}; install the same build on every host",
                            names[rank], ranks[rank].buildId, host::buildId()));
        }
        if (!ranks[rank].error.empty() && !ranks[rank].mayStillCome) {
            throw base::InputError(fmt::format("{}: {}", names[rank], ranks[rank].error));
        }
    }
    for (std::size_t rank = 1; rank < ranks.size(); ++rank) {
        if (!ranks[rank].error.empty()) {
            throw base::NotYetError(fmt::format("{}: {}", names[rank], ranks[rank].error));
        }
    }
    for (std::size_t rank = 1; rank < ranks.size(); ++rank) {
        for (const std::string& line : ranks[rank].shortcomings) {
            host::printLine("{}: {}", names[rank], line);
        }
        if (const std::string& was = ranks[rank].otherFloats; !was.empty()) {
            host::printLine("{}: its OpenGL driver changed how the rank computes: it {}; the rank has set this back",
                            names[rank], was);
            host::emitEvent("floats", {{"rank", static_cast<int>(rank)}, {"was", was}});
        }
    }
}

}  // namespace master
