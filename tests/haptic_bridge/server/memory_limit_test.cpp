// SPDX-License-Identifier: Apache-2.0
// A scene that does not fit the server's memory is refused before its heights are allocated. Sanitizers map terabytes,
// so their programs cannot run under a limit.
#include "tests/haptic_bridge/server/server_process.hpp"
#include "tests/support/run_program.hpp"

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
        EXPECT_NE(ran.output.find("s.toml: " + words), std::string::npos) << ran.output;
    }
    test::Folder folder_;
};

// 16 bytes per cell: the scene's heights, the replica's heights, and two fluxes. 2^28 cells are 4 GiB.
TEST_F(ServerMemory, OfAFieldIsAskedBeforeItsHeightsAreMade) {
    const std::string field = "[field]\ncolumns = 16384\nrows = 16384\n";
    expectRefused(field + "[terrain]\n", "16384 x 16384 cells need at least 4.0 GiB, and ");
    expectRefused(field + "[terrain]\nkind = \"dunes\"\n", "16384 x 16384 cells need at least 4.0 GiB, and ");
}

// A reader holds 16 bytes per pixel. If the pixels were read first, the word in the file would be refused instead.
TEST_F(ServerMemory, OfARasterIsAskedBeforeItsPixelsAreRead) {
    folder_.write("t.asc", "ncols 16384\nnrows 16384\ncellsize 1\nNODATA_value -1\n1 word\n");
    expectRefused("[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n",
                  "16384 x 16384 pixels of a raster need at least 4.0 GiB, and ");
}

}  // namespace
#endif
