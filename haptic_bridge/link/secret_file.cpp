// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/secret_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "base/input_error.hpp"

namespace haptic_bridge {
namespace {

constexpr std::string_view kBlanks = " \t\r";

/// Returns the next word of `line` and removes it from `line`.
std::string_view cutWord(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    line.remove_prefix(word.size());
    return word;
}

struct Line {
    std::string_view text;
    const std::string& file;
    long number;

    [[noreturn]] void fail(const std::string& what) const { throw base::InputError(file, number, what); }

    void readInto(Secrets& secrets) const {
        std::string_view rest = text;
        const std::string_view role = cutWord(rest);
        if (role.empty() || role.starts_with('#')) {
            return;
        }
        if (role != "move" && role != "watch") {  // the word may be a secret, so the message does not repeat it
            fail("does not begin with move or watch; write ROLE SECRET");
        }
        const std::string_view secret = cutWord(rest);
        if (!cutWord(rest).empty()) {
            fail("holds more than ROLE SECRET; a secret has no blanks");
        }
        if (secret.size() < kMinSecret || secret.size() > kMaxSecret) {
            fail(fmt::format("a secret of {} characters, expected {} to {}; openssl rand -hex 32 makes one",
                             secret.size(), kMinSecret, kMaxSecret));
        }
        if (std::any_of(secret.begin(), secret.end(), [](char c) { return c < 0x21 || c > 0x7e; })) {
            fail("a secret with characters that are not plain ASCII; openssl rand -hex 32 makes one");
        }
        std::optional<std::string>& place = role == "move" ? secrets.move : secrets.watch;
        if (place) {
            fail(fmt::format("a second secret of role {}; keep one", role));
        }
        place = secret;
    }
};

}  // namespace

Secrets parseSecrets(std::string_view text, const std::string& file) {
    Secrets secrets;
    for (long number = 1; !text.empty(); ++number) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        Line{line, file, number}.readInto(secrets);
    }
    if (!secrets.any()) {
        throw base::InputError(file + ": holds no secret; write a line such as: move " + "$(openssl rand -hex 32)");
    }
    if (secrets.move == secrets.watch) {
        throw base::InputError(file +
                               ": has the same secret for both roles, so a watcher could move the probe; make another");
    }
    return secrets;
}

Secrets readSecrets(const std::string& file) {
    // O_NONBLOCK is set because opening a pipe without a writer would wait. Pipes are refused below.
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (descriptor < 0) {
        throw base::InputError(file + ": cannot be read (" + std::strerror(errno) + "); check --secret-file");
    }
    struct stat about {};
    std::array<char, kMaxSecretFile + 1> bytes{};
    ssize_t count = 0;
    const bool known = fstat(descriptor, &about) == 0;
    const bool regular = known && S_ISREG(about.st_mode);
    if (regular) {
        count = read(descriptor, bytes.data(), bytes.size());
    }
    close(descriptor);
    if (!regular) {
        throw base::InputError(file + ": is not a regular file; --secret-file takes a file with lines ROLE SECRET");
    }
    if ((about.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
        throw base::InputError(file +
                               ": other users may read or change it; run chmod 600 on it, and make a new secret");
    }
    if (count < 0 || static_cast<std::size_t>(count) > kMaxSecretFile) {
        throw base::InputError(
            fmt::format("{}: is larger than {} bytes; a secret file has two lines at most", file, kMaxSecretFile));
    }
    return parseSecrets({bytes.data(), static_cast<std::size_t>(count)}, file);
}

}  // namespace haptic_bridge
