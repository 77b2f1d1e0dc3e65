// SPDX-License-Identifier: Apache-2.0
#include "host/version.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "host/build_id.hpp"

namespace host {

std::string_view release() { return SANDWALL_VERSION; }

std::string versionText(std::string_view program, const KnownVersions& known, bool json) {
    if (json) {
        nlohmann::ordered_json object{{"program", program}, {"version", release()}, {"build", buildId()}};
        for (const auto& [name, number] : known) {
            object[std::string(name)] = number;
        }
        return object.dump();
    }
    std::string text = std::string(program) + " " + std::string(release()) + ", build " + buildId();
    for (const auto& [name, number] : known) {
        text += ", " + std::string(name) + " " + std::to_string(number);
    }
    return text;
}

bool answersVersion(int argc, char** argv, std::string_view program, const KnownVersions& known) {
    const auto given = [&](std::string_view option) {
        return std::any_of(argv + std::min(argc, 1), argv + argc, [&](const char* word) { return option == word; });
    };
    if (!given("--version")) {
        return false;
    }
    std::puts(versionText(program, known, given("--json")).c_str());
    return true;
}

}  // namespace host
