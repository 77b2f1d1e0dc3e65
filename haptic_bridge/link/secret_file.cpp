// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/link/secret_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/byte_stream.hpp"
#include "base/input_error.hpp"
#include "host/core_dump.hpp"
#include "host/regular_file.hpp"

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

void requireOpen(const host::RegularFile& opened, const std::string& file, const std::string& option) {
    if (!opened.error().empty()) {
        throw base::InputError(
            fmt::format("{}: cannot be read ({}); give {} a file that you can read", file, opened.error(), option));
    }
}

void requirePrivate(const host::RegularFile& opened, const std::string& file, const std::string& option,
                    const std::string& thing) {
    requireOpen(opened, file, option);
    if (const std::string why = opened.whyNotPrivate(); !why.empty()) {
        throw base::InputError(
            fmt::format("{}: {}; make a new {} in a file of your own, and run chmod 600 on it", file, why, thing));
    }
}

Secrets readSecrets(const std::string& file) {
    host::forbidCoreDumps();
    const host::RegularFile opened(file);
    requirePrivate(opened, file, "--secret-file", "secret");
    if (opened.size() > kMaxSecretFile) {
        throw base::InputError(
            fmt::format("{}: is larger than {} bytes; a secret file has two lines at most", file, kMaxSecretFile));
    }
    const std::optional<base::Bytes> bytes = opened.read(kMaxSecretFile);
    if (!bytes) {
        throw base::InputError(file + ": cannot be read; check the disk");
    }
    return parseSecrets({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file);
}

}  // namespace haptic_bridge
