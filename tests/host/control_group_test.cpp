// SPDX-License-Identifier: Apache-2.0
#include "host/control_group.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/files/folder_test.hpp"

namespace {

namespace fs = std::filesystem;

constexpr const char* kRoot1 = "35 31 0:32 / /sys/fs/cgroup/memory rw,relatime shared:9 - cgroup cgroup rw,memory\n";
constexpr const char* kRoot2 = "41 31 0:38 / /sys/fs/cgroup rw,relatime - cgroup2 cgroup2 rw\n";

/// A folder with the files of /proc and /sys that a process of some control groups sees.
class ControlGroups : public test::FolderTest {
protected:
    void SetUp() override {
        write("proc/self/mountinfo", "22 1 254:0 / / rw - ext4 /dev/root rw\nshort line\n");
        write("proc/self/cgroup", "nonsense\n9:name=systemd:/\n");
    }
    void write(const std::string& name, const std::string& text) {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::app) << text;
    }
    void group1(const std::string& name, const std::string& limit, const std::string& used, const std::string& stat) {
        write(name + "/memory.limit_in_bytes", limit);
        write(name + "/memory.usage_in_bytes", used);
        write(name + "/memory.stat", stat);
    }
    void group2(const std::string& name, const std::string& limit, const std::string& used, const std::string& stat) {
        write(name + "/memory.max", limit);
        write(name + "/memory.current", used);
        write(name + "/memory.stat", stat);
    }
    std::optional<std::int64_t> free() { return host::freeInControlGroups(folder_); }
};

TEST_F(ControlGroups, NoGroupsGiveNoLimit) {
    EXPECT_EQ(free(), std::nullopt);
    EXPECT_EQ(host::freeInControlGroups(folder_ / "missing"), std::nullopt);
    write("proc/self/mountinfo", kRoot2);
    EXPECT_EQ(free(), std::nullopt) << "a mount without a group of this process";
}

TEST_F(ControlGroups, Version2CountsTheNearestLimitOfAllGroupsAround) {
    write("proc/self/mountinfo", kRoot2);
    write("proc/self/cgroup", "0::/user.slice/a.scope\n");
    group2("sys/fs/cgroup/user.slice/a.scope", "max\n", "700\n", "anon 1\ninactive_file 50\n");
    EXPECT_EQ(free(), std::nullopt) << "no group has a limit";
    group2("sys/fs/cgroup/user.slice", "1000\n", "900\n", "anon 1\ntext x\ninactive_file 50\nactive_file 7\n");
    EXPECT_EQ(free(), 150) << "unused files count as free";
    group2("sys/fs/cgroup", "100\n", "90\n", "");
    EXPECT_EQ(free(), 10);
}

TEST_F(ControlGroups, Version1CountsOnlyTheGroupsOfMemory) {
    write("proc/self/mountinfo", "32 31 0:29 / /sys/fs/cgroup/cpu rw - cgroup cgroup rw,cpu\n");
    write("proc/self/mountinfo", kRoot1);
    write("proc/self/cgroup", "5:cpu:/other\n4:cpuset,memory:/jobs/one\n0::/\n");
    group1("sys/fs/cgroup/cpu/other", "5\n", "4\n", "");
    EXPECT_EQ(free(), std::nullopt);
    group1("sys/fs/cgroup/memory", "9223372036854771712\n", "4096\n", "total_inactive_file 8192\n");
    EXPECT_GT(free().value(), std::int64_t{1} << 60);
    group1("sys/fs/cgroup/memory/jobs/one", "1000\n", "900\n", "inactive_file 1\ntotal_inactive_file 20\n");
    EXPECT_EQ(free(), 120);
    group1("sys/fs/cgroup/memory/jobs", "50\n", "70\n", "");
    EXPECT_EQ(free(), 0) << "above its limit";
}

TEST_F(ControlGroups, BothVersionsMayHaveALimit) {
    write("proc/self/mountinfo", kRoot1);
    write("proc/self/mountinfo", "41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
    write("proc/self/cgroup", "4:memory:/a\n0::/b\n");
    group1("sys/fs/cgroup/memory/a", "1000\n", "900\n", "");
    EXPECT_EQ(free(), 100);
    group2("sys/fs/cgroup/unified/b", "1000\n", "960\n", "");
    EXPECT_EQ(free(), 40);
}

// A container sees its own group as the root of the mount. Its group may have the name that it has outside.
TEST_F(ControlGroups, AContainerSeesOnlyItsOwnGroup) {
    write("proc/self/mountinfo", "41 31 0:38 /docker/one /sys/fs/cgroup ro - cgroup2 cgroup ro\n");
    write("proc/self/cgroup", "0::/docker/one/inner\n");
    group2("sys/fs/cgroup", "1000\n", "900\n", "");
    EXPECT_EQ(free(), 100) << "the group has no folder here";
    group2("sys/fs/cgroup/inner", "500\n", "470\n", "");
    EXPECT_EQ(free(), 30);
    group2("sys/fs/cgroup/docker/one/inner", "5\n", "5\n", "");
    EXPECT_EQ(free(), 30) << "the folder of the group begins at the root of the mount";
}

TEST_F(ControlGroups, AGroupOutsideTheMountCountsTheMount) {
    write("proc/self/mountinfo", "41 31 0:38 /docker/one /sys/fs/cgroup ro - cgroup2 cgroup ro\n");
    write("proc/self/cgroup", "0::/docker/two\n");
    group2("sys/fs/cgroup", "1000\n", "900\n", "");
    group2("sys/fs/two", "5\n", "5\n", "");
    EXPECT_EQ(free(), 100);
}

}  // namespace
