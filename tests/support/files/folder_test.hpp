// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>

namespace test {

/// Makes an empty folder with a name of its own, even if other processes make folders at the same time.
inline std::filesystem::path newFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "sandwall-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
        throw std::system_error(errno, std::generic_category(), name);
    }
    return name;
}

/// A test with a folder of its own, which exists before the members of a derived class are made. It is removed with the
/// test. The folder of a failed test stays, because its files may show the reason.
class FolderTest : public testing::Test {
protected:
    ~FolderTest() override {
        if (HasFailure()) {
            std::cerr << "the files of this test are left in " << folder_.string() << '\n';
        } else {
            std::error_code ignored;
            std::filesystem::remove_all(folder_, ignored);
        }
    }

    const std::filesystem::path folder_ = newFolder();
};

}  // namespace test
