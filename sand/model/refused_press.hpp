// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "sand/model/tool.hpp"

namespace sand {

/// A press of the tool whose sand the cells around it cannot take, because they would rise above kMaxHeight. A tool of
/// a height field digs only as deep as its sand fits, and passes through the rest. In a TIN all of the sand stays.
///
/// It is no state: neither the hash nor a snapshot contains it.
struct RefusedPress {
    Tool tool;
    /// Largest radius of a tool of this shape whose press fits with its centre at the same place [probe unit], in whole
    /// cells. 0 if no radius fits; nullopt on a TIN, where it is not computed.
    std::optional<std::int32_t> largest;
};

/// Presses that were refused since the sand was made, or copied from other sand.
struct RefusedPresses {
    std::int64_t count = 0;
    std::optional<RefusedPress> first;
};

}  // namespace sand
