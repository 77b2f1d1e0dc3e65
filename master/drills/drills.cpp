// SPDX-License-Identifier: Apache-2.0
#include "master/drills/drills.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <set>
#include <sstream>

#include "base/byte_stream.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "host/regular_file.hpp"

namespace master {
namespace {

constexpr const char* kDone = "drills.done";

void keep(const std::string& text, const std::filesystem::path& file) {
    if (!host::appendLines(file, text + "\n")) {
        host::printLine("{}: cannot be written ({}); after a restart the drill happens again", file.string(),
                        std::strerror(errno));
    }
}

}  // namespace

std::vector<Drill> withoutDone(std::vector<Drill> drills, const std::filesystem::path& folder, bool resumed) {
    if (!resumed) {
        host::forgetFile(folder / kDone);
        return drills;
    }
    std::set<std::string> done;
    const host::RegularFile opened(folder / kDone, host::RegularFile::Links::refused);
    const std::optional<base::Bytes> text = opened.error().empty() ? opened.read(opened.size()) : std::nullopt;
    std::istringstream stream(text ? std::string(text->begin(), text->end()) : "");
    for (std::string line; std::getline(stream, line);) {
        done.insert(line);
    }
    std::erase_if(drills, [&](const Drill& drill) { return done.count(drill.text) > 0; });
    return drills;
}

std::vector<lockstep::Fault> beginDrills(const std::vector<Drill>& drills, std::uint64_t frame,
                                         const std::filesystem::path& folder) {
    std::vector<lockstep::Fault> ofLink;
    for (const Drill& drill : drills) {
        if (drill.fault.frame != frame || drill.fault.kind == lockstep::Fault::Kind::slow) {
            continue;
        }
        keep(drill.text, folder / kDone);
        host::printLine("drill in frame {}: {}", frame, drill.text);
        host::emitEvent("drill", {{"frame", frame}, {"fault", drill.text}});
        if (drill.fault.rank == lockstep::Fault::kLink) {
            ofLink.push_back(drill.fault);
        }
    }
    return ofLink;
}

}  // namespace master
