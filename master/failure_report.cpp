// SPDX-License-Identifier: Apache-2.0
#include "master/failure_report.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

namespace master {

bool writeFailure(const FailureReport& failure, const std::filesystem::path& folder) {
    const nlohmann::ordered_json json{{"what", failure.what},
                                      {"rank", failure.rank},
                                      {"host", failure.host},
                                      {"tile", failure.tile},
                                      {"message", failure.message}};
    const std::string text = json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    const std::filesystem::path file = folder / "failure.json";
    const std::filesystem::path half = folder / "failure.json.new";
    const int descriptor = open(half.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    bool written = descriptor >= 0 &&
                   write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                   fdatasync(descriptor) == 0;
    if (descriptor >= 0) {
        close(descriptor);
    }
    written = written && rename(half.c_str(), file.c_str()) == 0;
    if (!written) {
        fmt::print(stderr, "sandwall: {}: cannot be written ({})\n", file.string(), std::strerror(errno));
    }
    return written;
}

}  // namespace master
