// SPDX-License-Identifier: Apache-2.0
// A scene that does not fit the server's memory is refused before its heights are allocated. So is the sand of a master
// that claims more than the scene allows. Sanitizers map terabytes, so their programs cannot run under a limit.
#include <regex>

#include "scene/load/scene_file.hpp"
#include "tests/haptic_bridge/link/raw_peer.hpp"
#include "tests/support/processes/run_program.hpp"
#include "tests/support/processes/server_process.hpp"
#include "tests/support/sand/hostile_sand.hpp"
#include "tests/support/sand/sand_samples.hpp"

#ifdef SANDWALL_RELEASE
namespace {

class ServerMemory : public testing::Test {
protected:
    /// Expects one line that holds `words`, and status 2, from a server that may map 2 GB.
    void expectRefused(const std::string& scene, const std::string& words) const {
        const support::Ran ran = support::runCommand("ulimit -v 2000000; exec " SANDWALL_BIN_DIR
                                                     "/sandwall-haptic-server --device script:gis --listen "
                                                     "127.0.0.1:0 --scene " +
                                                     folder_.write("s.toml", scene));
        EXPECT_EQ(ran.status, 2) << ran.output;
        EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
        EXPECT_TRUE(std::regex_search(ran.output, std::regex("s\\.toml: " + words))) << ran.output;
    }
    test::Folder folder_;
};

// 2^28 cells: heights, two fluxes, the compressed start, the datum of the hand, and a stroke with its fluxes.
TEST_F(ServerMemory, OfAFieldIsAskedBeforeItsHeightsAreMade) {
    const std::string field = "[field]\ncolumns = 16384\nrows = 16384\n";
    expectRefused(field + "[terrain]\n",
                  "16384 x 16384 cells need 8\\.[0-9] GiB in the haptic server, and .*: fewer cells, or a machine with "
                  "more memory");
    expectRefused(field + "[terrain]\nkind = \"dunes\"\n",
                  "16384 x 16384 cells need 8\\.[0-9] GiB in the haptic server, and .*: fewer cells, or a machine with "
                  "more memory");
}

// The heights of a text take 8 bytes per pixel. If the pixels were read first, the word in the file would be refused
// instead.
TEST_F(ServerMemory, OfARasterIsAskedBeforeItsPixelsAreRead) {
    folder_.write("t.asc", "ncols 16384\nnrows 16384\ncellsize 1\nNODATA_value -1\n1 word\n");
    expectRefused("[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n",
                  "16384 x 16384 pixels of a raster need at least 2.0 GiB, and ");
}

constexpr const char* kTinScene = R"(
name = "small"
[field]
columns = 64
width = 2.0
[terrain]
kind = "dunes"
height = 0.3
dune_height = 0.15
dune_length = 0.8
[tin]
max_error = 0.01
[tool]
radius = 0.1
[material]
talus_deg = 34
)";

/// A server that may map 2 GiB, and a master that sends it sand of 33 KB. The sand claims 2^30 vertices.
class HostileMaster : public testing::Test {
protected:
    /// Greets, asks for the epoch of `start`, and waits for the answer.
    template <class Answer>
    void grant(test::RawPeer& master, const haptic_bridge::StartMessage& start) {
        using namespace haptic_bridge;
        master.send(Hello{{kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(), "small"}});
        master.send(start);
        waitFor<Answer>(master);
    }
    template <class Wanted>
    Wanted waitFor(test::RawPeer& master) {
        while (auto message = master.receive()) {
            if (auto* found = std::get_if<Wanted>(&*message)) {
                return std::move(*found);
            }
        }
        ADD_FAILURE() << "the server has closed the link: " << server_.errors();
        return {};
    }
    /// Expects that the server continues with another master, and has printed one line with `words`.
    void expectGoesOn(const std::string& words) {
        haptic_bridge::Client client(server_.address(), test::offerOf(scene_));
        test::Wall wall(scene_);
        EXPECT_TRUE(wall.follow(client, 20)) << client.link().message << server_.errors();
        EXPECT_EQ(wall.divergences, 0);
        client.stop();
        ASSERT_TRUE(client.report());
        EXPECT_EQ(client.report()->refused[static_cast<std::size_t>(haptic_bridge::RefusalCode::state) - 1], 1U);
        EXPECT_EQ(server_.stop(SIGTERM), 0) << server_.errors();
        const std::string errors = server_.errors();
        const std::size_t first = errors.find(words);
        EXPECT_NE(first, std::string::npos) << errors;
        EXPECT_EQ(errors.find(words, first + 1), std::string::npos) << errors;
    }

    test::Folder folder_;
    std::string file_ = folder_.write("small.toml", kTinScene);
    scene::Scene scene_ = scene::loadScene(file_);
    base::Bytes dead_ = hostile_sand::ofDeadVertices(*scene_.tin, std::uint64_t{1} << 30);
    test::ServerProcess server_{folder_, test::ServerProcess::usual(file_, folder_), rlim_t{2} << 30};
};

TEST_F(HostileMaster, WhoseStateClaimsTooMuchIsRefused) {
    using namespace haptic_bridge;
    {
        test::RawPeer master(server_.port());
        grant<NeedState>(master, {1, 5, 12345});
        master.send(State{hostile_sand::stateWith(sand::Replica(scene_), dead_)});
        EXPECT_EQ(waitFor<Refusal>(master).code, RefusalCode::state);
    }
    expectGoesOn("the state does not fit this scene");
}

TEST_F(HostileMaster, WhoseLoadClaimsTooMuchIsRefused) {
    using namespace haptic_bridge;
    const EditRequest load{samples::withNumber(1, sand::Edit::loaded(dead_))};
    ASSERT_LT(encode(load).size(), kMaxMessage) << "an ordinary message";
    {
        test::RawPeer master(server_.port());
        grant<Ready>(master, {1, 0, sand::Replica(scene_).stateHash()});
        master.send(load);
        EXPECT_EQ(waitFor<Refusal>(master).code, RefusalCode::state);
    }
    expectGoesOn("a load does not fit this scene");
}

}  // namespace
#endif
