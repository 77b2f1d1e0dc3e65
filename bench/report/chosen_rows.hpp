// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/input_error.hpp"

namespace bench {

/// Returns the rows of a curve that the option --rows names, or all rows if `wanted` is empty. Each row has a member
/// `name`. Throws base::InputError if no row has a wanted name.
template <class Row>
[[nodiscard]] std::vector<Row> chosenRows(std::vector<Row> rows, const std::vector<std::string>& wanted) {
    for (const std::string& name : wanted) {
        if (std::ranges::find(rows, name, &Row::name) == rows.end()) {
            std::string names;
            for (const Row& row : rows) {
                names += (names.empty() ? "" : ", ") + row.name;
            }
            throw base::InputError(fmt::format("--rows: there is no \"{}\"; choose from {}", name, names));
        }
    }
    std::erase_if(
        rows, [&](const Row& row) { return !wanted.empty() && std::ranges::find(wanted, row.name) == wanted.end(); });
    return rows;
}

}  // namespace bench
