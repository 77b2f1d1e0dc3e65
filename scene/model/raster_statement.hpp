// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "base/field_forms.hpp"
#include "scene/model/longest_text.hpp"

namespace scene {

/// Tells what the numbers of a terrain mean, and how the program knows it. Programs print it when they have read
/// terrain, so that a user sees a wrong unit before hours of work.
struct RasterStatement {
    std::string file;                   // as a user would name it; in an encoded scene without its folder
    std::string across, acrossFrom;     // unit of lengths, and what named it: "metres", "EPSG:32633"
    std::string up, upFrom;             // unit of heights, and what named it
    std::optional<std::string> noData;  // number of the file that means no data; nullopt if the file declares none
    double noDataShare = 0;             // cells without data [share of all]

    /// Returns "metres across (EPSG:32633), feet up (vertical datum), no data -9999 in 72 % of cells".
    [[nodiscard]] std::string text() const;

    /// The order in an encoded scene.
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("file", base::text(it.file, kLongestText));
        visit("across", base::text(it.across, kLongestText));
        visit("across_from", base::text(it.acrossFrom, kLongestText));
        visit("up", base::text(it.up, kLongestText));
        visit("up_from", base::text(it.upFrom, kLongestText));
        visit("no_data", base::optionalText(it.noData, kLongestText));
        visit("no_data_share", base::limited(it.noDataShare, 0, 1));
    }
    friend bool operator==(const RasterStatement&, const RasterStatement&) = default;
};

}  // namespace scene
