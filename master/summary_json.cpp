// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "host/json_fields.hpp"
#include "host/whole_file.hpp"
#include "master/summary.hpp"

namespace master {

std::string hashText(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

std::optional<SlowestRank> slowestRank(const std::optional<lockstep::Drag>& drag,
                                       const std::vector<std::string>& rankNames) {
    return drag ? std::optional(SlowestRank{*drag, rankNames[static_cast<std::size_t>(drag->rank)]}) : std::nullopt;
}

std::optional<double> Summary::period(double haptic_bridge::Report::*value) const {
    return haptic && haptic->hapticPeriodUsMax > 0 ? std::optional((*haptic).*value) : std::nullopt;
}

std::vector<RankPart> Summary::rankParts() const {
    std::vector<RankPart> parts;
    for (std::size_t i = 0; i < ranksReports.size(); ++i) {
        parts.push_back({i + 1, tileNames[i], ranksReports[i], rankStatistics[i + 1], frames - framesBefore});
    }
    return parts;
}

void writeSummary(const Summary& summary, const std::filesystem::path& file) {
    host::WholeFile whole(file, host::WholeFile::Other::refused);
    // A server may have sent any bytes as the text of its refusal.
    whole.stream() << host::jsonOf(summary).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
                   << '\n';
    whole.keep();
}

}  // namespace master
