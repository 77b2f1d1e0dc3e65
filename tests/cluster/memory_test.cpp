// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "tests/cluster/session_fixture.hpp"
#include "tests/support/processes/mpirun.hpp"
#include "tests/support/screens/x_server.hpp"

namespace {

/// Returns the largest memory of a rank without its frame buffers [byte]. It also holds at the peak, while shaders
/// compile.
///
/// The parts were measured one by one (docs/figures.md). A rank that only starts MPI and waits takes 13.6 MB with Open
/// MPI 4.1.4 and 17.1 MB with 5.0.7, nearly all of it in libraries. A process that draws without MPI holds 50 to 60 MB
/// with Mesa 22.3 and LLVM 15, and 65 to 77 MB with Mesa 25.0 and LLVM 19. The compiler of LLVM 19 takes more,
/// too. At their peaks, ranks of Debian 13 take 120 MB with osmesa, 125 MB with egl and 141 MB with glfw.
double mostOf(const std::string& renderer) {
    const auto mesa = renderer.find("Mesa ");
    const bool newMesa = mesa != std::string::npos && std::atoi(renderer.c_str() + mesa + 5) >= 25;
    return 120e6 + (support::hasOpenMpi5() ? 4e6 : 0) + (newMesa ? 24e6 : 0);
}

/// Returns the files that a process has mapped, such as the libraries of Mesa and of windows, as names up to the first
/// dot.
std::set<std::string> librariesOf(pid_t process) {
    std::ifstream maps(fmt::format("/proc/{}/maps", process));
    std::set<std::string> names;
    for (std::string line; std::getline(maps, line);) {
        const std::string file = line.substr(std::min(line.rfind('/'), line.size() - 1) + 1);
        names.insert(file.substr(0, file.find('.')));
    }
    return names;
}

/// Returns the value of `key` in /proc/PID/status, which is in kibibytes there [byte].
double statusOf(pid_t process, const std::string& key) {
    std::ifstream status(fmt::format("/proc/{}/status", process));
    for (std::string word; status >> word;) {
        if (double kibibytes = 0; word == key + ":" && status >> kibibytes) {
            return kibibytes * 1024;
        }
    }
    return 0;
}

/// Ranks that draw tiles and a field of real size. Their drivers compile every shader, as at the first start.
class Memory : public SessionTest, public testing::WithParamInterface<std::string> {
protected:
    void SetUp() override {
        server_ = std::make_unique<support::XServer>(folder_, std::vector<std::string>{"2048x1536x24"});
        environment_ = {"DISPLAY=" + server_->display(), "MESA_SHADER_CACHE_DISABLE=true"};
    }
    /// Starts a session on one tile as large as those of Dorjgotov et al. 2007. A hand digs until the session is
    /// stopped.
    std::unique_ptr<support::ChildProcess> dig(const std::string& stereo) {
        const std::string file = write("wall.toml", "[viewer]\neye = [0.0, 1.6, 2.0]\n[stereo]\nmode = \"" + stereo +
                                                        "\"\n[grid]\nrows = 1\ncolumns = 1\ntile_size = [1.024, "
                                                        "0.768]\ntile_pixels = [1024, 768]\nlower_left = [-0.512, "
                                                        "0.9, 0.0]\n[stage]\ncentre = [0.0, 1.25, -0.3]\nwidth = "
                                                        "1.0\ntilt_deg = 40\n");
        auto session = start({"--wall", file, "--scene", (SANDWALL_SOURCE_DIR "/scenes/writing.toml"), "--device",
                              "script:gis", "--gl", GetParam(), "--out", out()});
        expectHand(*session);
        EXPECT_FALSE(
            session->waitForEvent("progress", [](const auto& event) { return event["frame"] >= 20; }).is_null())
            << session->output();
        return session;
    }
    std::unique_ptr<support::XServer> server_;
};

// A rank draws at most two eyes. The buffers of other modes are counted in tests/render_node.
TEST_P(Memory, OfARankIsSmallBesideItsFrameBuffersAndHoldsTheLibrariesOfItsBackendAlone) {
    const auto session = dig("passive");
    const std::vector<pid_t> family = session->family();
    const auto rank = support::findProgram(family, "sandwall-render-node");
    const auto master = support::findProgram(family, "sandwall-master");
    ASSERT_TRUE(rank && master);
    const double peak = statusOf(*rank, "VmHWM");
    const std::set<std::string> drawing = librariesOf(*rank);
    const std::set<std::string> bridging = librariesOf(*master);
    session->type("stop");
    expectInOrder(*session);
    const auto report = summary()["per_rank"][0];
    const double frameBuffers = report["frame_buffer_bytes"];
    // Each eye has colour and depth, and in a window also a back buffer.
    EXPECT_EQ(frameBuffers, 2 * (GetParam() == "glfw" ? 12.0 : 8.0) * 1024 * 768);
    const double held = report["memory_bytes"].get<double>() - frameBuffers;
    fmt::print("{}: {:.0f} MB beside {:.0f} MB of frame buffers, at its peak {:.0f} MB\n", GetParam(), held * 1e-6,
               frameBuffers * 1e-6, (peak - frameBuffers) * 1e-6);
    const double most = mostOf(report["renderer"]);
    EXPECT_LE(held, most);
    EXPECT_LE(peak - frameBuffers, most) << "while shaders compile";
    // Not libX11: Open MPI's own plug-ins bring it into every process.
    const std::vector<std::pair<std::string, std::string>> owners{
        {"libOSMesa", "osmesa"}, {"libEGL", "egl"}, {"libglfw", "glfw"}, {"libGLX", "glfw"}};
    for (const auto& [library, owner] : owners) {
        EXPECT_EQ(drawing.contains(library), owner == GetParam()) << library << " with " << GetParam();
        EXPECT_FALSE(bridging.contains(library)) << library << " in the master";
    }
    EXPECT_FALSE(drawing.contains("libpng16")) << "a rank writes no pictures";
}

INSTANTIATE_TEST_SUITE_P(Backends, Memory, testing::Values("osmesa", "egl", "glfw"),
                         [](const auto& backend) { return backend.param; });

}  // namespace
