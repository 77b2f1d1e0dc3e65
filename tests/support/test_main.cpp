// SPDX-License-Identifier: Apache-2.0
// The main function of every test program.
//
// Tests name files of the project relative to its root. Only this source holds an absolute path, so that ccache finds
// the objects of all other sources again in another clone.
#include <gtest/gtest.h>
#include <unistd.h>

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
    // gtest ends its output with the names of the skipped tests.
    if (geteuid() != 0 || std::getenv("SANDWALL_MAY_SKIP") != nullptr) {
        return kSkipped;
    }
    std::fputs(
        "A test was skipped: it needs rights that root has on Debian 12. Set SANDWALL_MAY_SKIP=1 to allow that.\n",
        stderr);
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    // Changes the folder before gtest lists the tests, because some tests have a file of the project as their
    // parameter.
    std::filesystem::current_path(SANDWALL_ROOT);
    testing::InitGoogleTest(&argc, argv);
    return exitStatus(RUN_ALL_TESTS());
}
