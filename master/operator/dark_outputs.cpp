// SPDX-License-Identifier: Apache-2.0
#include "master/operator/dark_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "host/event.hpp"
#include "host/print_line.hpp"

namespace master {

using base::MonitorState;

DarkOutputs::DarkOutputs(const walls::Wall& wall, std::vector<std::string> rankNames)
    : rankNames_(std::move(rankNames)) {
    for (const walls::Tile& tile : wall.tiles) {
        std::vector<Output>& ofTile = outputs_.emplace_back();
        for (const walls::Output& output : tile.outputs) {
            Output& kept = ofTile.emplace_back();
            kept.kept = {output.name, tile.name, output.monitor, tile.rank};
            kept.pixels = walls::outputPixels(wall.stereo, tile.pixels);
        }
    }
}

void DarkOutputs::add(const std::vector<lockstep::Arrival>& arrivals, std::int64_t nowNs) {
    const double passed = lastNs_ == 0 ? 0 : static_cast<double>(nowNs - lastNs_) * 1e-9;
    lastNs_ = nowNs;
    for (std::size_t tile = 0; tile < outputs_.size() && tile + 1 < arrivals.size(); ++tile) {
        for (std::size_t i = 0; i < outputs_[tile].size(); ++i) {
            Output& output = outputs_[tile][i];
            if (output.state != MonitorState::on) {
                output.kept.seconds += passed;
                output.lastSeconds += passed;
            }
            const auto state = static_cast<MonitorState>(arrivals[tile + 1].monitors.at(i));
            if (state != output.state) {
                change(output, state);
            }
        }
    }
}

void DarkOutputs::change(Output& output, MonitorState state) const {
    const bool wasDark = std::exchange(output.state, state) != MonitorState::on;
    DarkOutput& kept = output.kept;
    kept.atEnd = state != MonitorState::on;
    if (kept.atEnd && !wasDark) {
        ++kept.times;
        output.lastSeconds = 0;
    }
    const std::string monitor = kept.monitor.empty() ? "its monitor" : "monitor " + kept.monitor;
    const std::string what =
        state == MonitorState::on ? fmt::format("is on {} again, after {:.1f} s", monitor, output.lastSeconds)
        : state == MonitorState::off
            ? fmt::format("is dark, because {} is off; the session continues, and the window comes back with it",
                          monitor)
            : fmt::format("is dark, because {} shows another number of pixels than {} x {}; set it to that mode",
                          monitor, output.pixels.x, output.pixels.y);
    host::printLine("{}: output {} {}", rankNames_.at(static_cast<std::size_t>(kept.rank)), kept.output, what);
    host::emitEvent("monitor", {{"rank", kept.rank},
                                {"tile", kept.tile},
                                {"output", kept.output},
                                {"monitor", kept.monitor},
                                {"state", base::nameOf(state)},
                                {"dark_seconds", kept.seconds}});
}

std::vector<std::uint32_t> DarkOutputs::ranks() const {
    std::vector<std::uint32_t> ranks;
    for (const std::vector<Output>& ofTile : outputs_) {
        if (std::ranges::any_of(ofTile, [](const Output& output) { return output.kept.atEnd; })) {
            ranks.push_back(static_cast<std::uint32_t>(ofTile.front().kept.rank));
        }
    }
    return ranks;
}

std::vector<std::string> DarkOutputs::names() const {
    std::vector<std::string> names;
    for (const DarkOutput& output : history()) {
        if (output.atEnd) {
            names.push_back(output.output);
        }
    }
    return names;
}

std::vector<DarkOutput> DarkOutputs::history() const {
    std::vector<DarkOutput> dark;
    for (const std::vector<Output>& ofTile : outputs_) {
        for (const Output& output : ofTile) {
            if (output.kept.times > 0) {
                dark.push_back(output.kept);
            }
        }
    }
    return dark;
}

}  // namespace master
