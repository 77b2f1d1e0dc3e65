// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>

#include "render_node/gl/gl_context.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/sample_scene.hpp"

int main() try {
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    const scene::Scene scene = sample::duneScene(200);
    render_node::ScenePainter view(scene, glm::dmat4(1));
    view.setTool(sample::probeAt(scene, {1, 1, 0.05}), true);
    const render_node::EyeTarget target(320, 240);
    std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
    for (const std::uint8_t byte : sample::draw(view, sample::camera({1, -0.6, 1.2}, {1, 1, 0}), target)) {
        hash = (hash ^ byte) * 0x100000001b3ULL;
    }
    std::printf("%016llx\n", static_cast<unsigned long long>(hash));
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
