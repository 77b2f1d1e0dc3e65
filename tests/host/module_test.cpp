// SPDX-License-Identifier: Apache-2.0
#include "host/module.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "base/input_error.hpp"
#include "host/build_id.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/run_program.hpp"

namespace {

namespace fs = std::filesystem;

/// Returns the error line with which loading this module is refused, or "loaded".
std::string refusal(const host::Module& module, const std::vector<fs::path>& folders) {
    try {
        (void)host::loadModule(module, folders);
    } catch (const base::InputError& error) {
        return error.what();
    }
    return "loaded";
}

class Modules : public test::FolderTest {
protected:
    /// Puts a module of another build into the test's folder, under the name of one of our modules.
    fs::path foreign(const std::string& name) const {
        fs::copy_file(fs::path(SANDWALL_BIN_DIR) / "foreign-module.so", folder_ / name,
                      fs::copy_options::overwrite_existing);
        return folder_ / name;
    }
    /// A copy of a program beside the foreign module must refuse it, in one line that names the file and both builds.
    void expectRefused(const std::string& module, const std::string& program, const std::string& arguments) const {
        const fs::path file = foreign(module);
        fs::copy_file(fs::path(SANDWALL_BIN_DIR) / program, folder_ / program, fs::copy_options::overwrite_existing);
        const support::Ran ran = support::runCommand((folder_ / program).string() + " " + arguments);
        EXPECT_EQ(ran.status, 2) << ran.output;
        EXPECT_EQ(std::count(ran.output.begin(), ran.output.end(), '\n'), 1) << ran.output;
        for (const std::string& part : {file.string(), std::string("f0f0f0f0f0f0f0f0"), std::string(host::buildId())}) {
            EXPECT_NE(ran.output.find(part), std::string::npos) << part << " in: " << ran.output;
        }
    }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
};

TEST_F(Modules, OfAnotherBuildAreRefusedWithBothIds) {
    const fs::path file = foreign("sandwall-any.so");
    EXPECT_EQ(refusal({"sandwall-any.so", "symbol", "--any", "", ""}, {folder_}),
              file.string() + ": is of build f0f0f0f0f0f0f0f0, and this program of " + host::buildId() +
                  "; install programs and modules of one build");
}

TEST_F(Modules, ThatAreMissingAreNamedWithTheFoldersAndWhatToDo) {
    EXPECT_EQ(refusal({"sandwall-any.so", "symbol", "--any", "build it", ""}, {folder_, "/nowhere"}),
              "--any: there is no sandwall-any.so in " + folder_.string() + " and /nowhere; build it");
}

TEST_F(Modules, ThatAreNoLibrariesAreRefused) {
    write("sandwall-any.so", "text");
    const std::string line = refusal({"sandwall-any.so", "symbol", "--any", "", "install it"}, {folder_});
    EXPECT_TRUE(line.starts_with("--any: " + (folder_ / "sandwall-any.so").string())) << line;
    EXPECT_TRUE(line.ends_with("; install it")) << line;
}

// Runs every program that loads modules beside a module of another build.
TEST_F(Modules, OfAnotherBuildAreRefusedByEveryLoader) {
    const std::string head = "[field]\ncolumns = 64\nrows = 64\n[material]\n[tool]\nradius = 0.1\n";
    const std::string formula =
        write("f.toml", "[terrain]\nkind = \"function\"\nx = [0.0, 1.0]\ny = [0.0, 1.0]\nz = \"x\"\n" + head);
    const std::string server = "--device script:gis --listen 127.0.0.1:0 --scene ";
    expectRefused("sandwall-import.so", "sandwall-haptic-server", server + formula);
    const std::string flat = write("flat.toml", "[terrain]\nheight = 0.2\n" + head);
    const std::string secret = write("secret", "move 0123456789abcdef0123456789abcdef\n");
    fs::permissions(secret, fs::perms::owner_read | fs::perms::owner_write);
    expectRefused("sandwall-security.so", "sandwall-haptic-server", server + flat + " --secret-file " + secret);
    for (const std::string gl : {"osmesa", "egl", "glfw"}) {
        const std::string wall = SANDWALL_SOURCE_DIR "/walls/configs/desktop.toml";
        expectRefused("sandwall-gl-" + gl + ".so", "sandwall-render-node",
                      fmt::format("--probe 1 --gl {} < {}", gl, wall));
    }
}

}  // namespace
