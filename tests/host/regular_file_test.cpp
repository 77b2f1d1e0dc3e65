// SPDX-License-Identifier: Apache-2.0
#include "host/regular_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "base/input_error.hpp"
#include "host/whole_file.hpp"
#include "tests/support/blocked_child.hpp"
#include "tests/support/folder_test.hpp"

namespace {

class Files : public test::FolderTest {
protected:
    std::filesystem::path written(const char* name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
    [[nodiscard]] static std::string textOf(const std::filesystem::path& path) {
        std::ifstream stream(path);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
};

TEST_F(Files, ARegularFileIsReadUpToALimit) {
    const host::RegularFile file(written("text", "sand and rock"));
    EXPECT_EQ(file.error(), "");
    EXPECT_EQ(file.size(), 13U);
    const auto whole = file.read(100);
    ASSERT_TRUE(whole.has_value());
    EXPECT_EQ(std::string(whole->begin(), whole->end()), "sand and rock");
    EXPECT_EQ(file.read(4)->size(), 4U);
    EXPECT_EQ(host::RegularFile(folder_ / "none").error(), "No such file or directory");
}

TEST_F(Files, APipeADeviceAndAFolderAreRefusedWithoutWaiting) {
    support::makePipe(folder_ / "pipe");
    EXPECT_TRUE(support::endsByItself([this] {
        for (const std::filesystem::path& other : {folder_ / "pipe", std::filesystem::path("/dev/zero"), folder_}) {
            EXPECT_EQ(host::RegularFile(other).error(), "is not a regular file") << other;
        }
        EXPECT_FALSE(host::appendText(folder_ / "pipe", "x"));
        EXPECT_THROW(host::WholeFile(folder_ / "pipe", host::WholeFile::Other::refused), base::InputError);
    }));
}

TEST_F(Files, TextIsAppendedToAnOldOrNewFile) {
    EXPECT_TRUE(host::appendText(folder_ / "log", "one\n"));
    EXPECT_TRUE(host::appendText(folder_ / "log", "two\n"));
    EXPECT_EQ(textOf(folder_ / "log"), "one\ntwo\n");
    EXPECT_FALSE(host::appendText(folder_ / "none" / "log", "x"));
    EXPECT_EQ(errno, ENOENT);
    std::filesystem::create_symlink(folder_ / "log", folder_ / "link");
    EXPECT_FALSE(host::appendText(folder_ / "link", "x")) << "a link of another program";
    EXPECT_EQ(textOf(folder_ / "log"), "one\ntwo\n");
}

TEST_F(Files, AWholeFileThatCannotBeKeptLeavesNoPart) {
    host::WholeFile whole(folder_ / "file");
    whole.stream() << "text";
    std::filesystem::create_directory(folder_ / "file");  // which a file cannot replace
    EXPECT_THROW(whole.keep(), base::InputError);
    std::filesystem::remove(folder_ / "file");
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(Files, OnlyAFolderThatMustNotBeReadIsNotSynced) {
    EXPECT_TRUE(host::syncFolderOf(folder_ / "file"));
    EXPECT_FALSE(host::syncFolderOf(folder_ / "none" / "file"));
    EXPECT_FALSE(host::syncFolderOf(written("text", "x") / "file"));
}

TEST_F(Files, ANewFileReplacesAPipeOrLinkOfItsName) {
    const std::filesystem::path other = written("other", "of another program");
    std::filesystem::create_symlink(other, folder_ / "new");
    EXPECT_TRUE(support::endsByItself([this] {
        for (int turn = 0; turn < 2; ++turn) {
            const int made = host::makeFile(folder_ / "new");
            ASSERT_GE(made, 0);
            EXPECT_EQ(write(made, "new", 3), 3);
            close(made);
            EXPECT_EQ(textOf(folder_ / "new"), "new");
            std::filesystem::remove(folder_ / "new");
            support::makePipe(folder_ / "new");
        }
    }));
    EXPECT_EQ(textOf(other), "of another program") << "the link was followed";
}

TEST_F(Files, APrivateFileBelongsToThisUserAlone) {
    const std::filesystem::path file = written("secret", "x");
    chmod(file.c_str(), 0600);
    EXPECT_EQ(host::RegularFile(file).whyNotPrivate(), "");
    chmod(file.c_str(), 0640);
    EXPECT_EQ(host::RegularFile(file).whyNotPrivate(), "other users may read or change it");
    chmod(file.c_str(), 0600);
    if (geteuid() != 0) {
        GTEST_SKIP() << "only root can give a file to another user";
    }
    ASSERT_EQ(chown(file.c_str(), 1, 1), 0);
    EXPECT_EQ(host::RegularFile(file).whyNotPrivate(), "belongs to another user");
}

TEST_F(Files, AFolderThatOtherUsersMayWriteToIsUnsafe) {
    EXPECT_EQ(host::whyUnsafeFolder(folder_), "");
    EXPECT_EQ(host::whyUnsafeFolder(folder_ / "none"), "") << "it is made by this user";
    for (const mode_t mode : {0775U, 0757U, 0777U}) {
        chmod(folder_.c_str(), mode);
        EXPECT_EQ(host::whyUnsafeFolder(folder_), "other users may write to it") << mode;
        std::filesystem::remove(folder_ / "link");
        std::filesystem::create_directory_symlink(folder_, folder_ / "link");
        EXPECT_EQ(host::whyUnsafeFolder(folder_ / "link"), "other users may write to it") << "through a link";
    }
    chmod(folder_.c_str(), 0755);
    EXPECT_EQ(host::whyUnsafeFolder(folder_), "");
    EXPECT_EQ(host::whyUnsafeFolder(folder_ / "link"), "");
}

TEST_F(Files, AFolderOrLinkOfAnotherUserIsUnsafe) {
    if (geteuid() != 0) {
        GTEST_SKIP() << "only root can give a folder to another user";
    }
    const std::filesystem::path theirs = folder_ / "theirs", ours = folder_ / "ours", link = folder_ / "link";
    std::filesystem::create_directory(theirs);
    std::filesystem::create_directory(ours);
    ASSERT_EQ(chown(theirs.c_str(), 1, 1), 0);
    EXPECT_EQ(host::whyUnsafeFolder(theirs), "belongs to another user");
    std::filesystem::create_directory_symlink(theirs, link);
    EXPECT_EQ(host::whyUnsafeFolder(link), "leads to a folder of another user");
    std::filesystem::remove(link);
    std::filesystem::create_directory_symlink(ours, link);
    EXPECT_EQ(host::whyUnsafeFolder(link), "");
    ASSERT_EQ(lchown(link.c_str(), 1, 1), 0);
    for (const char* end : {"", "/", "//", "/.", "/./"}) {
        EXPECT_EQ(host::whyUnsafeFolder(link.string() + end), "is a link of another user") << end;
    }
}

TEST_F(Files, NewFoldersAreWritableForThisUserAlone) {
    const mode_t before = umask(002);
    host::makeFolders(folder_ / "a" / "b" / "c" / "");
    umask(before);
    for (const char* made : {"a", "a/b", "a/b/c"}) {
        EXPECT_EQ(host::whyUnsafeFolder(folder_ / made), "") << made;
        EXPECT_TRUE(std::filesystem::is_directory(folder_ / made));
    }
    host::makeFolders(folder_ / "a" / "b");
    std::filesystem::create_directory_symlink(folder_ / "a" / "b" / "c", folder_ / "link");
    host::makeFolders(folder_ / "link" / ".." / "d");
    EXPECT_TRUE(std::filesystem::is_directory(folder_ / "a" / "b" / "d")) << "beside the folder that the link names";
    EXPECT_THROW(host::makeFolders(written("file", "x") / "d"), std::filesystem::filesystem_error);
}

}  // namespace
