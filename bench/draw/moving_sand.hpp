// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace bench {

struct MovingSandOptions {
    std::string wall;
    std::string row;  // name of a row of movingSandRows()
    int frames = 0;
    std::vector<int> pixelsPerQuad;  // rules that are compared with the rule of sand at rest
    bool errors = false;             // also compares the pictures with pictures of every cell
    std::string folder;              // gets the frames of the first rule, as a window shows them; empty: none
};

/// Returns the names of the rows, such as "dunes-4096".
[[nodiscard]] std::vector<std::string> movingSandRows();

/// Prints, for one row and each rule, CPU times of the frames of moving sand, and the work in them. All rules draw the
/// same sand, in an order that changes from frame to frame.
void measureMovingSand(const MovingSandOptions& options);

}  // namespace bench
