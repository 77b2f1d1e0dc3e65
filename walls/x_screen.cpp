// SPDX-License-Identifier: Apache-2.0
#include "walls/x_screen.hpp"

#include <algorithm>
#include <string_view>

namespace walls {
namespace {

std::string lowered(std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return lower;
}

/// Returns a number without zeros before it. Returns "0" for an empty text.
std::string plainNumber(std::string_view digits) {
    digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
    return digits.empty() ? "0" : std::string(digits);
}

/// Returns whether the name of a display's host means the machine of the program itself, over TCP. Such a server is
/// usually a tunnel of ssh to another machine, and not the server of ":0".
bool isLoopback(const std::string& host) {
    return host == "localhost" || host == "127.0.0.1" || host == "::1" || host == "[::1]";
}

}  // namespace

std::string xScreenOf(const Place& place, const std::string& host) {
    const std::string machine = lowered(host);
    if (place.display.empty()) {
        return machine + " $DISPLAY";
    }
    // A display is [PROTOCOL/][HOST]:NUMBER[.SCREEN].
    const std::string_view display = place.display;
    const std::size_t colon = display.rfind(':');
    const std::string_view numbers = display.substr(colon + 1);
    const std::size_t dot = std::min(numbers.find('.'), numbers.size());
    const std::string screen = ":" + plainNumber(numbers.substr(0, dot)) + "." +
                               plainNumber(numbers.substr(std::min(dot + 1, numbers.size())));
    std::string server = lowered(display.substr(0, colon));
    const bool local = server == "unix" || server.starts_with("unix/") || server.starts_with("local/");
    if (local || server.empty()) {
        return machine + " " + screen;
    }
    if (server.front() != '/' && server.find('/') != std::string::npos) {
        server.erase(0, server.find('/') + 1);
    }
    return isLoopback(server) || server.front() == '/' ? machine + " " + server + screen : server + " " + screen;
}

}  // namespace walls
