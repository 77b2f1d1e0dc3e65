// SPDX-License-Identifier: Apache-2.0
#include "host/regular_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "base/input_error.hpp"
#include "host/whole_file.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/blocked_child.hpp"

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

TEST_F(Files, ARegularFileIsReadFromAnyPlace) {
    const host::RegularFile file(written("text", "sand and rock"));
    std::vector<std::uint8_t> bytes;
    const auto from = [&](std::uint64_t offset, std::size_t size) {
        EXPECT_TRUE(file.readAt(offset, size, bytes));
        return std::string(bytes.begin(), bytes.end());
    };
    EXPECT_EQ(from(5, 3), "and");
    EXPECT_EQ(from(9, 100), "rock") << "fewer bytes at the end";
    EXPECT_EQ(from(13, 4), "");
    EXPECT_EQ(from(1000, 4), "");
    EXPECT_FALSE(host::RegularFile(folder_ / "none").readAt(0, 1, bytes));
}

TEST_F(Files, AFileOfAFolderIsOpenedThroughNoLinkInTheFolder) {
    using Links = host::RegularFile::Links;
    std::filesystem::create_directories(folder_ / "real" / "saves");
    written("real/saves/a", "sand");
    written("real/b", "rock");
    std::filesystem::create_directory_symlink("real", folder_ / "link");
    EXPECT_EQ(host::RegularFile(folder_ / "link", "saves/a").error(), "") << "a link to the folder itself";
    EXPECT_EQ(host::RegularFile(folder_ / "link", "b").error(), "");
    EXPECT_EQ(host::RegularFile(folder_ / "link", "saves/none").error(), "No such file or directory");
    EXPECT_EQ(host::RegularFile(folder_ / "link", "none/a").error(), "No such file or directory");
    EXPECT_EQ(host::RegularFile(folder_ / "link", "b/a").error(), "Not a directory");
    EXPECT_EQ(host::RegularFile(folder_ / "none", "a").error(), "No such file or directory");
    EXPECT_EQ(host::RegularFile(folder_ / "real", "saves").error(), "is not a regular file");
    std::filesystem::create_symlink(folder_ / "real" / "b", folder_ / "real" / "saves" / "c");
    std::filesystem::create_directory_symlink("saves", folder_ / "real" / "loads");
    for (const char* name : {"saves/c", "loads/a"}) {
        EXPECT_EQ(host::RegularFile(folder_ / "real", name).error(), "is a link, which is not followed") << name;
    }
    const auto path = folder_ / "real" / "saves" / "c";
    EXPECT_EQ(host::RegularFile(path, Links::refused).error(), "is a link, which is not followed");
    EXPECT_EQ(host::RegularFile(path).error(), "");
}

TEST_F(Files, APipeADeviceAndAFolderAreRefusedWithoutWaiting) {
    support::makePipe(folder_ / "pipe");
    EXPECT_TRUE(support::endsByItself([this] {
        for (const std::filesystem::path& other : {folder_ / "pipe", std::filesystem::path("/dev/zero"), folder_}) {
            EXPECT_EQ(host::RegularFile(other).error(), "is not a regular file") << other;
        }
        EXPECT_FALSE(host::appendLines(folder_ / "pipe", "x"));
        EXPECT_THROW(host::WholeFile(folder_ / "pipe", host::WholeFile::Other::refused), base::InputError);
    }));
}

TEST_F(Files, WhetherAPipeCanBeWrittenIsAskedWithoutWaitingForItsReader) {
    support::makePipe(folder_ / "pipe");
    EXPECT_TRUE(support::endsByItself([this] { host::requireWritable(folder_ / "pipe"); }));
    EXPECT_THROW(host::requireWritable(folder_ / "none" / "file"), base::InputError);
    EXPECT_THROW(host::requireWritable(folder_), base::InputError);
    host::requireWritable(folder_ / "file");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "file"));
}

TEST_F(Files, LinesAreAppendedToAnOldOrNewFile) {
    EXPECT_TRUE(host::appendLines(folder_ / "log", "one\n"));
    EXPECT_TRUE(host::appendLines(folder_ / "log", "two\n"));
    EXPECT_EQ(textOf(folder_ / "log"), "one\ntwo\n");
    std::ofstream(folder_ / "torn") << "one\ntw";
    EXPECT_TRUE(host::appendLines(folder_ / "torn", "three\n"));
    EXPECT_EQ(textOf(folder_ / "torn"), "one\ntw\nthree\n") << "a crash has cut off the last line";
    EXPECT_FALSE(host::appendLines(folder_ / "none" / "log", "x"));
    EXPECT_EQ(errno, ENOENT);
    std::filesystem::create_symlink(folder_ / "log", folder_ / "link");
    EXPECT_FALSE(host::appendLines(folder_ / "link", "x")) << "a link of another program";
    EXPECT_EQ(textOf(folder_ / "log"), "one\ntwo\n");
}

TEST(WriteAll, WritesTheRestAfterASignalHasCutAWriteShort) {
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    struct sigaction nothing {};
    struct sigaction before {};
    nothing.sa_handler = [](int) {};  // without SA_RESTART, so that a signal ends the system call
    ASSERT_EQ(sigaction(SIGUSR1, &nothing, &before), 0);
    std::vector<std::uint8_t> sent(std::size_t{1} << 20);  // 16 times what a pipe holds, so that the writer waits
    for (std::size_t i = 0; i < sent.size(); ++i) {
        sent[i] = static_cast<std::uint8_t>(i % 251);
    }
    bool whole = false;
    std::thread writer([&] {
        whole = host::writeAll(ends[1], sent);
        close(ends[1]);
    });
    std::vector<std::uint8_t> got, piece(10000);
    for (ssize_t count = 1; count > 0;) {
        pthread_kill(writer.native_handle(), SIGUSR1);
        count = read(ends[0], piece.data(), piece.size());
        got.insert(got.end(), piece.begin(), piece.begin() + std::max(count, ssize_t{0}));
    }
    writer.join();
    close(ends[0]);
    sigaction(SIGUSR1, &before, nullptr);
    EXPECT_TRUE(whole);
    EXPECT_TRUE(got == sent) << got.size() << " bytes of " << sent.size();
    EXPECT_FALSE(host::writeAll(-1, sent));
    EXPECT_EQ(errno, EBADF);
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

TEST_F(Files, OnlyFilesAndLinksAreForgotten) {
    std::filesystem::create_symlink(written("file", "x"), folder_ / "link");
    support::makePipe(folder_ / "pipe");
    for (const char* name : {"file", "link", "pipe", "none"}) {
        host::forgetFile(folder_ / name);
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
    EXPECT_TRUE(std::filesystem::is_fifo(folder_ / "pipe"));
}

TEST_F(Files, AWholeFileNeverFollowsALinkAndNeverReplacesADevice) {
    using Other = host::WholeFile::Other;
    const std::filesystem::path other = written("other", "of another program");
    std::filesystem::create_symlink(other, folder_ / "link");
    std::filesystem::create_symlink(folder_ / "none", folder_ / "dangling");
    for (const char* name : {"link", "dangling"}) {
        EXPECT_THROW(host::WholeFile(folder_ / name, Other::written), base::InputError) << name;
        EXPECT_THROW(host::WholeFile(folder_ / name, Other::refused), base::InputError) << name;
    }
    EXPECT_EQ(textOf(other), "of another program");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "none"));
    host::WholeFile null("/dev/null");
    null.stream() << "text";
    null.keep();
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(Files, AWholeFileReplacesNoLinkThatCameWhileItWasWritten) {
    host::WholeFile whole(folder_ / "file");
    whole.stream() << "text";
    std::filesystem::create_symlink(written("other", "of another program"), folder_ / "file");
    EXPECT_THROW(whole.keep(), base::InputError);
    EXPECT_EQ(textOf(folder_ / "other"), "of another program");
}

TEST_F(Files, AWholeFileIsWrittenToAnOpenFileThatDevNames) {
    const int made = host::makeFile(folder_ / "out");
    host::WholeFile whole("/dev/fd/" + std::to_string(made));
    whole.stream() << "text";
    whole.keep();
    close(made);
    EXPECT_EQ(textOf(folder_ / "out"), "text");
}

/// Sets the umask, and the previous one at the end.
class Umask {
public:
    explicit Umask(mode_t mask) : before_(umask(mask)) {}
    ~Umask() { umask(before_); }
    Umask(const Umask&) = delete;
    Umask& operator=(const Umask&) = delete;

private:
    mode_t before_;
};

/// Returns the access to a file, such as 0644.
mode_t accessTo(const std::filesystem::path& path) {
    struct stat about {};
    EXPECT_EQ(lstat(path.c_str(), &about), 0) << path;
    return about.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO);
}

TEST_F(Files, NoFileIsWritableForOthersWhateverTheUmask) {
    for (const auto& [mask, file, folder] :
         {std::tuple{0000U, 0644U, 0755U}, {0027U, 0640U, 0750U}, {0077U, 0600U, 0700U}}) {
        const Umask set(mask);
        const std::filesystem::path at = folder_ / std::to_string(mask);
        host::makeFolders(at);
        close(host::makeFile(at / "made", 0666));
        EXPECT_TRUE(host::appendLines(at / "appended", "x"));
        host::WholeFile whole(at / "whole");
        whole.keep();
        for (const char* name : {"made", "appended", "whole"}) {
            EXPECT_EQ(accessTo(at / name), file) << name;
        }
        EXPECT_EQ(accessTo(at), folder);
    }
}

TEST_F(Files, AWholeFileKeepsTheAccessToThePreviousOneExceptThatOthersMayNotWrite) {
    for (const auto& [before, after] : {std::pair{0666U, 0644U}, {0620U, 0600U}, {0640U, 0640U}}) {
        chmod(written("file", "x").c_str(), before);
        host::WholeFile whole(folder_ / "file");
        whole.keep();
        EXPECT_EQ(accessTo(folder_ / "file"), after);
    }
}

TEST_F(Files, AProcessThatKeepsOthersFromWritingKeepsTheRestOfItsUmask) {
    for (const auto& [before, after] : {std::pair{0000U, 0022U}, {0077U, 0077U}, {0005U, 0027U}}) {
        const Umask set(before);
        host::keepOthersFromWriting();
        EXPECT_EQ(umask(0), after);
    }
}

TEST_F(Files, WhatEarlierSessionsLeftIsUnsafeIfOthersMayWriteToItOrItIsALink) {
    EXPECT_EQ(host::whyUnsafeContent(folder_ / "none"), "");
    written("note.txt", "of the user");
    chmod((folder_ / "note.txt").c_str(), 0666);
    EXPECT_EQ(host::whyUnsafeContent(folder_), "") << "no session reads or writes that file";
    std::vector<std::filesystem::path> all{written("session.journal", "x"), written("session.journal.2", "x")};
    const std::vector<std::filesystem::path> continued{written("divergence.txt", "x"), written("drills.done", "x"),
                                                       written("failures.jsonl", "x"), written("incidents.json", "x"),
                                                       written("recoveries.jsonl", "x")};
    all.insert(all.end(), continued.begin(), continued.end());
    for (const char* name : {"log", "checkpoints", "saves"}) {
        std::filesystem::create_directory(folder_ / name);
        all.push_back(folder_ / name);
        std::ofstream(folder_ / name / "file") << "x";
        all.push_back(folder_ / name / "file");
    }
    EXPECT_EQ(host::whyUnsafeContent(folder_), "");
    for (const std::filesystem::path& one : all) {
        const mode_t before = accessTo(one);
        for (const mode_t others : {mode_t{S_IWGRP}, mode_t{S_IWOTH}}) {
            chmod(one.c_str(), before | others);
            EXPECT_EQ(host::whyUnsafeContent(folder_),
                      one.string() +
                          ": other users may write to it; run chmod -R go-w on the session's folder, or "
                          "choose another --out");
        }
        chmod(one.c_str(), before);
        if (geteuid() == 0) {
            ASSERT_EQ(chown(one.c_str(), 1, 1), 0);
            EXPECT_EQ(host::whyUnsafeContent(folder_),
                      one.string() + ": belongs to another user; remove it, or choose another --out");
            ASSERT_EQ(chown(one.c_str(), 0, 0), 0);
        }
        std::filesystem::rename(one, folder_ / "real");
        std::filesystem::create_symlink(folder_ / "real", one);
        const bool mayStay = std::find(continued.begin(), continued.end(), one) != continued.end();
        EXPECT_EQ(host::whyUnsafeContent(folder_),
                  mayStay ? ""
                          : one.string() +
                                ": is a link, and a session follows none in its folder; remove it, or "
                                "choose another --out");
        std::filesystem::remove(one);
        std::filesystem::rename(folder_ / "real", one);
    }
    EXPECT_EQ(host::whyUnsafeContent(folder_), "");
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
