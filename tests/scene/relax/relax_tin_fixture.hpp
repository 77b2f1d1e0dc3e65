// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <random>
#include <sstream>
#include <string>

#include "scene/import/mesh_file.hpp"
#include "scene/import/points_file.hpp"
#include "tests/scene/relax/relax_fixture.hpp"

inline constexpr double kWest = 361015.25, kSouth = 5070223.5;  // somewhere in a UTM zone

/// Runs that read points and rasters and write meshes.
class RelaxTin : public Relax {
protected:
    void writePoints(const std::string& name, const scene::Points& points) const {
        std::string text = "x, y, z\n";
        for (const auto& [x, y, z] : points) {
            text += fmt::format("{}, {}, {}\n", x, y, z);
        }
        write(name, text);
    }
    [[nodiscard]] scene::Mesh readObj(const std::string& name) const {
        scene::Mesh mesh;
        std::istringstream stream(read(name));
        char kind = 0;
        while (stream >> kind) {
            if (kind == 'v') {
                auto& [x, y, z] = mesh.vertices.emplace_back();
                stream >> x >> y >> z;
            } else {
                auto& [a, b, c] = mesh.triangles.emplace_back();
                stream >> a >> b >> c;
                --a, --b, --c;
            }
        }
        return mesh;
    }
    void expectRefused(const std::string& arguments, const std::string& words) const {
        Relax::expectRefused(arguments, words, "out.ply");
    }
    void expectPointsRefused(const std::string& points, const std::string& words) const {
        write("bad.csv", points);
        expectRefused("bad.csv out.ply --talus 30", words);
    }
};

/// Returns one point in the middle half of every cell of 2 m, and the corners of the field. A function gives the
/// heights.
template <class HeightAt>
scene::Points survey(int side, unsigned seed, HeightAt heightAt) {
    std::mt19937 random(seed);
    const auto within = [&] { return 0.25 + static_cast<double>(random() % 512) / 1024; };
    scene::Points points;
    for (const double x : {0.0, 1.0}) {
        for (const double y : {0.0, 1.0}) {
            points.push_back({kWest + 2 * side * x, kSouth + 2 * side * y, heightAt(side * x, side * y)});
        }
    }
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const double east = x + within(), north = y + within();
            points.push_back({kWest + 2 * east, kSouth + 2 * north, heightAt(east, north)});
        }
    }
    return points;
}
