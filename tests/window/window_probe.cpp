// SPDX-License-Identifier: Apache-2.0
// Does without a cluster what a rank does with a backend. It makes the context and the windows of a tile, draws the
// sample scene for both eyes, and shows frame 0. Then it runs typed commands: "frame N", "part X0 Y0 X1 Y1", "keys",
// "monitors", "memory", "end". "monitors" shows a frame and prints the states of the outputs' monitors. In the frame of
// "part", the pictures of the eyes are exchanged, and only these pixels have changed. In the frame of "frame", nothing
// has changed.
#include <unistd.h>

#include <fstream>
#include <iostream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "host/command_line.hpp"
#include "pictures/png_file.hpp"
#include "render_node/gl/gl_context.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/sample_scene.hpp"

namespace {

using render_node::EyeTarget;

struct Options {
    std::string gl = "glfw", pictures;
    int width = 320, height = 240, device = -1, cells = 200;
    bool active = false, onDesk = false;
    double refresh = 60;  // [Hz], refresh rate of the wall
    std::string display;
    std::vector<std::string> places;  // "40,30" or the name of a monitor, one for each window
};

walls::Tile tileOf(const Options& options) {
    walls::Tile tile;
    tile.name = "r1c1";
    tile.pixels = {options.width, options.height};
    tile.place.device = options.device;
    tile.place.display = options.display;
    for (const std::string& place : options.places) {
        walls::Output output{"out" + std::to_string(tile.outputs.size() + 1), {walls::Eye::middle}, {}, {}};
        char comma = 0;
        glm::ivec2 corner;
        if (std::istringstream(place) >> corner.x >> comma >> corner.y) {
            output.window = corner;
        } else {
            output.monitor = place;
        }
        tile.outputs.push_back(output);
    }
    return tile;
}

void writePicture(const EyeTarget& target, const std::string& file) {
    pictures::Image image(target.width(), target.height());
    image.rgb = target.read();
    pictures::writePng(file, image);
}

/// Prints the shared libraries in this process, each once, such as "libX11.so.6.4.0".
void printLibraries() {
    std::ifstream maps("/proc/self/maps");
    std::set<std::string> names;
    for (std::string line; std::getline(maps, line);) {
        const auto slash = line.rfind('/');
        if (slash != std::string::npos && line.find(".so", slash) != std::string::npos) {
            names.insert(line.substr(slash + 1));
        }
    }
    for (const std::string& name : names) {
        std::cout << "library " << name << "\n";
    }
}

void printMemory(const Options& options) {
    long total = 0;
    long resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    constexpr long kTargets = 2;
    constexpr long kBytesPerPixel = 8;  // colour and depth
    std::cout << "resident " << resident * sysconf(_SC_PAGESIZE) << "\nframe_buffers "
              << kTargets * kBytesPerPixel * options.width * options.height << "\nmemory printed" << std::endl;
}

void exchangeEyes(std::vector<render_node::OutputPicture>& outputs, const EyeTarget& left, const EyeTarget& right) {
    for (render_node::OutputPicture& output : outputs) {
        output.picture = output.picture == &left ? &right : &left;
    }
}

void obey(const Options& options, render_node::GlContext& context, std::vector<render_node::OutputPicture> outputs,
          const EyeTarget& left, const EyeTarget& right) {
    for (std::string word; std::cin >> word && word != "end";) {
        if (word == "frame") {
            std::uint64_t frame = 0;
            std::cin >> frame;
            context.present(outputs, {}, frame);
            context.swap();
            std::cout << "frame " << frame << " shown" << std::endl;
        } else if (word == "part") {
            render_node::PixelRect part;
            std::cin >> part.x0 >> part.y0 >> part.x1 >> part.y1;
            exchangeEyes(outputs, left, right);
            context.present(outputs, part, 0);
            context.swap();
            std::cout << "part shown" << std::endl;
        } else if (word == "keys") {
            for (const base::Keystroke key : context.windows().takeKeys()) {
                std::cout << "key " << key.code << "\n";
            }
            std::cout << "keys taken" << std::endl;
        } else if (word == "monitors") {
            context.present(outputs, {}, 0);
            context.swap();
            std::cout << "monitors";
            for (const base::MonitorState state : context.windows().monitorStates()) {
                std::cout << ' ' << base::nameOf(state);
            }
            std::cout << std::endl;
        } else if (word == "memory") {
            printMemory(options);
        }
    }
}

int show(const Options& options) {
    walls::Wall wall;
    wall.stereo = options.active ? walls::Stereo::active : walls::Stereo::mono;
    wall.refreshHz = options.refresh;
    wall.tiles = {tileOf(options)};
    wall.onDesk = options.onDesk;
    const auto context =
        render_node::makeContext(base::valueNamed<render_node::Backend>(options.gl).value(), wall, wall.tiles[0]);
    std::cout << "context " << context->name() << "\nrenderer " << context->renderer() << "\n";

    const scene::Scene scene = sample::duneScene(options.cells);
    render_node::ScenePainter view(scene, glm::dmat4(1));
    view.setTool(sample::probeAt(scene, {1, 1, 0.05}), true);
    const EyeTarget left(options.width, options.height);
    const EyeTarget right(options.width, options.height);
    view.draw(sample::camera({0.9, -0.6, 1.2}, {1, 1, 0}), left);
    view.draw(sample::camera({1.1, -0.6, 1.2}, {1, 1, 0}), right);
    if (!options.pictures.empty()) {
        writePicture(left, options.pictures + "left.png");
        writePicture(right, options.pictures + "right.png");
    }
    // Several windows alternate between the left and the right eye's picture, as two projectors do.
    std::vector<render_node::OutputPicture> outputs;
    for (std::size_t i = 0; i < options.places.size(); ++i) {
        outputs.push_back({i % 2 == 0 ? &left : &right, options.active ? &right : nullptr});
    }
    context->present(outputs, {0, 0, options.width, options.height}, 0);
    context->swap();
    printLibraries();
    for (const std::string& line : context->windows().shortcomings()) {
        std::cout << "shortcoming " << line << "\n";
    }
    std::cout << "swap lock " << context->windows().swapLock() << ", ignore " << context->windows().framesToIgnore()
              << "\nframe 0 shown" << std::endl;
    obey(options, *context, outputs, left, right);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    host::CommandLine line("Shows the sample scene with one backend.", "window_probe");
    Options options;
    line.option("--gl", options.gl);
    line.option("--width", options.width);
    line.option("--height", options.height);
    line.option("--device", options.device);
    line.option("--display", options.display);
    line.option("--cells", options.cells);
    line.option("--pictures", options.pictures, "folder for left.png and right.png, with a slash");
    line.option("--at", options.places, "a window: x,y or a monitor");
    line.flag("--active", options.active);
    line.flag("--on-desk", options.onDesk);
    line.option("--refresh", options.refresh, "frames per second of the wall");
    return host::runMain(line, argc, argv, [&] { return show(options); });
}
