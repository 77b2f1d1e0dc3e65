// SPDX-License-Identifier: Apache-2.0
// The main of every test program.
//
// Tests name files of the project relative to its root: this source alone holds an absolute path, so that ccache finds
// the objects of all others again in another clone.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace {

constexpr int kSkipped = 77;  // ctest's SKIP_RETURN_CODE of these programs

int exitStatus(int failed) {
    const testing::UnitTest& all = *testing::UnitTest::GetInstance();
    if (failed != 0 || all.skipped_test_count() == 0) {
        return failed;
    }
    // The last lines of a test that was skipped are gtest's list of its name.
    if (std::getenv("SANDWALL_MAY_SKIP") != nullptr) {
        return kSkipped;
    }
    std::fputs("A test was skipped: it needs what Debian 12 gives to root. Set SANDWALL_MAY_SKIP=1 to allow that.\n",
               stderr);
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    // Before the tests are listed: some have a file of the project for a parameter.
    std::filesystem::current_path(SANDWALL_ROOT);
    testing::InitGoogleTest(&argc, argv);
    return exitStatus(RUN_ALL_TESTS());
}
