// SPDX-License-Identifier: Apache-2.0
#include "master/drills.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <set>

#include "host/event.hpp"
#include "host/print_line.hpp"

namespace master {
namespace {

constexpr const char* kDone = "drills.done";

void keep(const std::string& text, const std::filesystem::path& file) {
    const std::string line = text + "\n";
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    const bool kept = descriptor >= 0 &&
                      write(descriptor, line.data(), line.size()) == static_cast<ssize_t>(line.size()) &&
                      fdatasync(descriptor) == 0;
    if (!kept) {
        host::printLine("{}: cannot be written ({}); after a restart the drill happens again", file.string(),
                        std::strerror(errno));
    }
    if (descriptor >= 0) {
        close(descriptor);
    }
}

}  // namespace

std::vector<Drill> withoutDone(std::vector<Drill> drills, const std::filesystem::path& folder, bool resumed) {
    if (!resumed) {
        std::error_code none;  // ignored, because the file usually does not exist
        std::filesystem::remove(folder / kDone, none);
        return drills;
    }
    std::set<std::string> done;
    std::ifstream stream(folder / kDone);
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
