// SPDX-License-Identifier: Apache-2.0
#include "bench/session/latency.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "base/input_error.hpp"

namespace bench {

void becomeLatency(const std::vector<std::string>& arguments) {
    std::vector<std::string> words{"python3", SANDWALL_SOURCE_DIR "/scripts/figures/sessions/latency.py"};
    if (!std::filesystem::exists(words[1])) {
        throw base::InputError(words[1] + ": does not exist; run sandwall-bench on the machine that built it");
    }
    words.insert(words.end(), arguments.begin(), arguments.end());
    const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    setenv("SANDWALL_BIN", here.c_str(), 0);
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    execvp(pointers[0], pointers.data());
    throw base::InputError(words[0] + ": " + std::strerror(errno) + "; run scripts/install_dependencies.sh");
}

}  // namespace bench
