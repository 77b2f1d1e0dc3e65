// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "sand/replica.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/sand/sand_of.hpp"

namespace tin_samples {

/// A scene file as a person writes it: dunes on 64 x 64 nominal cells, as a TIN.
class TinReplica : public test::FolderTest {
protected:
    [[nodiscard]] scene::Scene scene(const std::string& tin = "max_error = 0.01\n", const std::string& more = "",
                                     const std::string& rim = "") const {
        const std::filesystem::path file = folder_ / "scene.toml";
        std::ofstream(file) << rim
                            << "[field]\ncolumns = 64\nwidth = 2.0\n[terrain]\nkind = \"dunes\"\nheight = 0.3\n"
                               "dune_height = 0.15\ndune_length = 0.8\n"
                            << more << "[tin]\n"
                            << tin << "[material]\ntalus_deg = 34\nsettling_time = 0.1\n[tool]\nradius = 0.1\n";
        return scene::loadScene(file);
    }
};

inline int verticesOf(const sand::Replica& replica) {
    const auto& alive = samples::tinOf(replica).triangles.triangleAt;
    return static_cast<int>(std::count_if(alive.begin(), alive.end(), [](std::int32_t at) { return at >= 0; }));
}

/// Returns random strokes, with all edits that a hand and an operator can make.
inline std::vector<sand::Step> session(std::uint32_t seed, int steps) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t most) { return static_cast<std::int32_t>(random() % most); };
    std::vector<sand::Step> all;
    sand::ProbePoint probe{64 * 128, 64 * 128, 2600};
    for (int i = 0; i < steps; ++i) {
        sand::Step step{.epoch = 1, .number = static_cast<std::uint64_t>(i + 1), .engaged = i % 16 < 11, .path = {}};
        for (int points = below(4); points > 0; --points) {
            probe = {std::clamp(probe.x + below(601) - 300, -2000, 64 * 256 + 2000),
                     std::clamp(probe.y + below(601) - 300, -2000, 64 * 256 + 2000), 2400 + below(1200)};
            step.path.push_back(probe);
        }
        if (i % 16 == 0) {
            probe = {below(64 * 256), below(64 * 256), 3000};
            step.path = {probe};
        }
        step.edit = i % 50 == 49 ? sand::Edit::undo : i == steps / 2 ? sand::Edit::settle : sand::Edit::none;
        all.push_back(step);
    }
    return all;
}

}  // namespace tin_samples
