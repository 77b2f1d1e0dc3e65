// SPDX-License-Identifier: Apache-2.0
#include "master/start_up.hpp"

#include <fmt/format.h>

#include "base/input_error.hpp"
#include "host/build_id.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "host/regular_file.hpp"
#include "master/journal/journal.hpp"
#include "sand/replica.hpp"
#include "scene/import/raster_memory.hpp"
#include "scene/load/memory.hpp"

namespace master {

void requireMemory(const std::vector<lockstep::RankHost>& ranks, int columns, int rows, bool tin,
                   const std::string& file) {
    // The master computes the heights from which a TIN's vertices are chosen. A render rank needs as much memory.
    if (const auto lack = lockstep::lackOfMemory(ranks, scene::bytesOfField(columns, rows, tin))) {
        throw base::InputError(fmt::format("{}: {} x {} {} need {}; use fewer cells, or more hosts", file, columns,
                                           rows, tin ? "nominal cells of a TIN" : "cells", *lack));
    }
}

void requireMemory(const std::vector<lockstep::RankHost>& ranks, const scene::Scene& scene, const std::string& file) {
    if (scene.tin == nullptr) {
        return requireMemory(ranks, scene.rules.columns, scene.rules.rows, false, file);
    }
    const int columns = scene.rules.columns;
    const int rows = scene.rules.rows;
    // A render rank keeps a height for each nominal cell. From these heights it computes how much sky each place sees.
    const std::int64_t toDraw = std::int64_t{sizeof(float)} * columns * rows;
    const auto lack = lockstep::lackOfMemory(ranks, sand::Replica::leastBytes(scene), toDraw);
    if (lack) {
        throw base::InputError(fmt::format(
            "{}: a TIN of {} vertices over {} x {} nominal cells needs {}; use fewer of either, or more hosts", file,
            scene.tin->places.size(), columns, rows, *lack));
    }
}

void requireMemoryOfRaster(const std::vector<lockstep::RankHost>& ranks, int columns, int rows,
                           const std::string& file) {
    const std::vector<lockstep::RankHost> master(ranks.begin(), ranks.begin() + (ranks.empty() ? 0 : 1));
    if (const auto lack = lockstep::lackOfMemory(master, scene::bytesToRead(columns, rows))) {
        throw base::InputError(
            fmt::format("{}: {} x {} pixels of a raster need {}; coarsen it", file, columns, rows, *lack));
    }
}

void requireMemoryOfJournal(const std::vector<lockstep::RankHost>& ranks, const std::filesystem::path& journal) {
    const JournalReader reader(journal);
    const sand::Rules rules = rulesOf(reader);
    if (rules.tin == 0) {
        requireMemory(ranks, rules.columns, rules.rows, false, journal.string());
    } else {
        // A journal holds only a TIN's vertices, a small part of what a replica takes, so the scene may be decoded.
        requireMemory(ranks, sceneOf(reader), journal.string());
    }
}

void requireFolder(const std::filesystem::path& out) {
    std::error_code none;
    if (std::filesystem::exists(out, none) && !std::filesystem::is_directory(out, none)) {
        throw base::InputError(fmt::format("{}: is not a folder, and --out must be one; choose another", out.string()));
    }
    // scripts/session_folder.py has the same check and messages.
    if (const std::string why = host::whyUnsafeFolder(out); !why.empty()) {
        throw base::InputError(fmt::format("{}: {}; {}choose another --out", out.string(), why,
                                           why.starts_with("other users") ? "run chmod go-w on it, or " : ""));
    }
    if (const std::string why = host::whyUnsafeContent(out); !why.empty()) {
        throw base::InputError(why);
    }
}

void requireReady(const std::vector<lockstep::Readiness>& ranks, const std::vector<std::string>& names) {
    for (std::size_t rank = 1; rank < ranks.size(); ++rank) {
        if (ranks[rank].buildId != host::buildId()) {
            throw base::InputError(
                fmt::format("{}: is of build {}, but the master is of build {}; install the same build on every host",
                            names[rank], ranks[rank].buildId, host::buildId()));
        }
        if (!ranks[rank].error.empty()) {
            throw base::InputError(fmt::format("{}: {}", names[rank], ranks[rank].error));
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
