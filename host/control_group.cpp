// SPDX-License-Identifier: Apache-2.0
#include "host/control_group.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "host/kernel_numbers.hpp"

namespace host {
namespace {

namespace fs = std::filesystem;

/// Names of the files in a group that has a limit of memory, by the version of the groups.
struct Names {
    const char *type, *most, *used, *unusedFiles;
};
constexpr Names kVersion1{"cgroup", "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"},
    kVersion2{"cgroup2", "memory.max", "memory.current", "inactive_file"};

/// Returns whether `words`, which commas separate, have this word.
bool hasWord(const std::string& words, const std::string& word) {
    return ("," + words + ",").find("," + word + ",") != std::string::npos;
}

/// Returns the group of this process, as proc/self/cgroup names it: "ID:CONTROLLERS:/GROUP". Version 2 has no
/// controllers in its line.
std::optional<fs::path> groupOf(const fs::path& root, const Names& names) {
    std::ifstream stream(root / "proc/self/cgroup");
    for (std::string line; std::getline(stream, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) {
            continue;
        }
        const std::string controllers = line.substr(first + 1, second - first - 1);
        if (&names == &kVersion2 ? controllers.empty() : hasWord(controllers, "memory")) {
            return line.substr(second + 1);
        }
    }
    return std::nullopt;
}

/// A mounted tree of groups.
struct Mount {
    fs::path root, folder;  // the group that is mounted, and the folder in which it is mounted
};

/// Returns the mount of the groups, as proc/self/mountinfo names it: "ID PARENT DEVICE ROOT FOLDER OPTIONS … - TYPE
/// SOURCE OPTIONS".
std::optional<Mount> mountOf(const fs::path& root, const Names& names) {
    std::ifstream stream(root / "proc/self/mountinfo");
    for (std::string line; std::getline(stream, line);) {
        std::istringstream text(line);
        const std::vector<std::string> words{std::istream_iterator<std::string>(text), {}};
        const auto type = std::find(words.begin(), words.end(), "-");
        if (words.end() - type < 4 || type - words.begin() < 6 || type[1] != names.type ||
            (&names == &kVersion1 && !hasWord(type[3], "memory"))) {
            continue;
        }
        return Mount{words[3], words[4]};
    }
    return std::nullopt;
}

/// Returns the memory that one group leaves [byte], or nullopt if it has no limit.
std::optional<std::int64_t> freeInGroup(const fs::path& folder, const Names& names) {
    const auto most = numberIn(folder / names.most), used = numberIn(folder / names.used);
    if (!most || !used) {
        return std::nullopt;
    }
    const std::int64_t files = numberOf(names.unusedFiles, folder / "memory.stat").value_or(0);
    const std::int64_t needed = std::max<std::int64_t>(*used - files, 0);
    return std::max<std::int64_t>(*most - needed, 0);
}

std::optional<std::int64_t> freeInGroups(const fs::path& root, const Names& names) {
    const auto group = groupOf(root, names);
    const auto mount = mountOf(root, names);
    if (!group || !mount) {
        return std::nullopt;
    }
    // A container may see its own group as the root of the mount, and the name of its group as seen from outside.
    const fs::path below = group->lexically_relative(mount->root), top = root / mount->folder.relative_path();
    const bool within = !below.empty() && *below.begin() != ".." && below != ".";
    std::optional<std::int64_t> least;
    for (fs::path folder = within ? top / below : top;; folder = folder.parent_path()) {
        if (const auto free = freeInGroup(folder, names)) {
            least = std::min(least.value_or(*free), *free);
        }
        if (folder == top || !folder.has_relative_path()) {
            return least;
        }
    }
}

}  // namespace

std::optional<std::int64_t> freeInControlGroups(const fs::path& root) {
    const auto one = freeInGroups(root, kVersion1), two = freeInGroups(root, kVersion2);
    return one && two ? std::min(one, two) : one ? one : two;
}

}  // namespace host
