// SPDX-License-Identifier: Apache-2.0
#include "master/incidents.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "files/input_error.hpp"
#include "files/whole_file.hpp"

namespace master {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t kSeldomNs = 250'000'000;  // a flood must not become one of files

ordered_json jsonOf(const Incidents& incidents) {
    ordered_json json{{"divergences", incidents.divergences},
                      {"healed", incidents.healed},
                      {"server_divergences", incidents.serverDivergences},
                      {"reconnects", incidents.reconnects},
                      {"stands", incidents.stands}};
    for (std::size_t i = 0; i < incidents.refused.size(); ++i) {
        json["refused"][std::string(haptic_bridge::kRefusalNames[i])] = incidents.refused[i];
    }
    return json;
}

Incidents incidentsOf(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream) {
        return {};
    }
    const ordered_json json = ordered_json::parse(stream);
    Incidents incidents{.divergences = json.at("divergences"),
                        .healed = json.at("healed"),
                        .serverDivergences = json.at("server_divergences"),
                        .reconnects = json.at("reconnects"),
                        .stands = json.at("stands")};
    for (std::size_t i = 0; i < incidents.refused.size(); ++i) {
        incidents.refused[i] = json.at("refused").at(std::string(haptic_bridge::kRefusalNames[i]));
    }
    return incidents;
}

}  // namespace

IncidentFile::IncidentFile(const std::filesystem::path& folder, bool resumed) : file_(folder / "incidents.json") {
    if (!resumed) {
        std::error_code none;
        std::filesystem::remove(file_, none);
        return;
    }
    try {
        before_ = kept_ = incidentsOf(file_);
    } catch (const nlohmann::json::exception& error) {
        fmt::print(stderr, "sandwall: {}: {}; the summary counts from here on\n", file_.string(), error.what());
    }
}

void IncidentFile::keep(const Incidents& sinceTheBeginning, std::int64_t nowNs) {
    if (sinceTheBeginning == kept_ || (writtenNs_ != 0 && nowNs - writtenNs_ < kSeldomNs)) {
        return;
    }
    writtenNs_ = nowNs;
    kept_ = sinceTheBeginning;
    try {
        files::WholeFile whole(file_);
        whole.stream() << jsonOf(sinceTheBeginning).dump() << '\n';
        whole.keep();
    } catch (const files::InputError&) {
        // The journal's complaint about the same disk is enough.
    }
}

}  // namespace master
