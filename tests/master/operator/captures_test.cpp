// SPDX-License-Identifier: Apache-2.0
#include "master/operator/captures.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/files/folder_test.hpp"

namespace {

using master::CaptureFolder;

class CaptureFolderTest : public test::FolderTest {
protected:
    static void write(const CaptureFolder& capture) { std::ofstream(capture.path() / "tile_a_left.png") << "pixels"; }
    [[nodiscard]] bool has(const char* name) const { return std::filesystem::exists(folder_ / name); }
};

TEST_F(CaptureFolderTest, StaysOnlyWhenAllPicturesAreInIt) {
    {
        CaptureFolder first(folder_);
        write(first);
        first.keep();
        const CaptureFolder failed(folder_);
        write(failed);
        EXPECT_EQ(failed.path(), folder_ / "capture_002");
    }
    EXPECT_TRUE(has("capture_001/tile_a_left.png"));
    EXPECT_FALSE(has("capture_002")) << "it holds a part of the pictures";
    EXPECT_EQ(CaptureFolder(folder_).path(), folder_ / "capture_002");
}

TEST_F(CaptureFolderTest, ThatCouldNotBeMadeIsNotRemoved) {
    std::ofstream(folder_ / "out") << "a file in place of the session's folder";
    { const CaptureFolder failed(folder_ / "out"); }
    EXPECT_TRUE(has("out"));
}

}  // namespace
