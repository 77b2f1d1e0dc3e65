// SPDX-License-Identifier: Apache-2.0
#include "tracking/source.hpp"

#include <fmt/format.h>

#include <boost/asio/ip/address.hpp>
#include <charconv>
#include <cmath>

#include "base/input_error.hpp"
#include "base/text.hpp"

namespace tracking {
namespace {

constexpr double kFarthestOrigin = 1000;  // [m], the largest distance of a screen in a wall file
constexpr double kLargestHead = 1;        // [m], largest distance from a tracked point to the eyes
constexpr int kMaxBody = 999;

/// Parser of one source's text.
struct Reader {
    std::string_view text;
    const std::string& name;
    Source source{};

    [[noreturn]] void fail(const std::string& what) const {
        throw base::InputError(fmt::format("{}: '{}': {}", name, text.substr(0, 200), what));
    }

    [[nodiscard]] glm::dvec3 point(std::string_view key, std::string_view value, double most) const {
        const std::optional<glm::dvec3> result = pointOf(value);
        if (!result) {
            fail(fmt::format("{}={} is not three numbers in metres, such as {}=0,1.2,0", key, value, key));
        }
        for (int i = 0; i < 3; ++i) {
            if (!(std::abs((*result)[i]) <= most)) {
                fail(fmt::format("{} is in metres and at most {}, got {}", key, most, (*result)[i]));
            }
        }
        return *result;
    }

    /// Reads origin=, axes=, eyes= or from=. Returns false if the word is not one of them.
    bool placed(std::string_view word) {
        const auto equals = word.find('=');
        const std::string_view key = word.substr(0, equals);
        const std::string_view value = equals == std::string_view::npos ? "" : word.substr(equals + 1);
        if (equals == std::string_view::npos || (key != "origin" && key != "axes" && key != "eyes" && key != "from")) {
            return false;
        }
        if (key == "origin") {
            source.origin = point(key, value, kFarthestOrigin);
        } else if (key == "eyes") {
            source.eyes = point(key, value, kLargestHead);
        } else if (key == "from") {
            boost::system::error_code error;
            source.from = boost::asio::ip::make_address(std::string(value), error).to_string();
            if (error) {
                fail(
                    fmt::format("from={} is not an IP address; write the tracker's, such as from=192.168.1.20", value));
            }
        } else if (const std::optional<glm::dmat3> axes = axesOf(value)) {
            source.axes = *axes;
        } else {
            fail(fmt::format("axes={} does not name x, y and z once each, reversed with '-', such as axes=x,z,-y",
                             value));
        }
        return true;
    }

    void readPort(std::string_view word) {
        unsigned long port = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), port);
        if (word.empty() || error == std::errc::invalid_argument || end != word.data() + word.size()) {
            fail(fmt::format("'{}' is not a port; write [HOST:]PORT, such as 4242", word));
        }
        if (error != std::errc{} || port > 65535) {
            fail(fmt::format("port {} is beyond 65535", word));
        }
        source.port = static_cast<std::uint16_t>(port);
    }

    void readHost(std::string_view word) {
        source.host = word == "localhost" ? "127.0.0.1" : word;
        boost::system::error_code error;
        const auto address = boost::asio::ip::make_address(source.host, error);
        if (error) {
            fail(fmt::format("'{}' is not an IP address; write one of this machine, or 0.0.0.0 for every network",
                             word));
        }
        if (address.is_multicast()) {
            fail(fmt::format("{} is a multicast address; let the tracker send to this machine", word));
        }
    }

    /// Reads "[HOST:]PORT", for DTrack also ":BODY".
    void readAddress(std::string_view rest) {
        std::string_view host;
        if (rest.starts_with('[')) {
            const auto end = rest.find("]:");
            if (end == std::string_view::npos) {
                fail("write an IPv6 address as [ADDRESS]:PORT");
            }
            host = rest.substr(1, end - 1);
            rest.remove_prefix(end + 2);
        } else if (const auto colon = rest.find(':');
                   colon != std::string_view::npos && rest.find_first_not_of("0123456789") < colon) {
            host = rest.substr(0, colon);  // only digits would be the port
            rest.remove_prefix(colon + 1);
        }
        if (!host.empty()) {
            readHost(host);
        }
        const auto parts = base::split(rest, ':');
        if (parts.size() > (source.kind == Source::Kind::dtrack ? 2U : 1U)) {
            fail(fmt::format("write {} after the port",
                             source.kind == Source::Kind::dtrack ? "only a body's number" : "nothing"));
        }
        readPort(parts[0]);
        if (parts.size() == 2) {
            readBody(parts[1]);
        }
    }

    void readBody(std::string_view word) {
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), source.body);
        if (word.empty() || error != std::errc{} || end != word.data() + word.size() || source.body < 0 ||
            source.body > kMaxBody) {
            fail(
                fmt::format("'{}' is not a body; DTrack's packets count bodies from 0, to at most {}", word, kMaxBody));
        }
    }

    void readKind(std::string_view words, const std::filesystem::path& folder) {
        const auto colon = words.find(':');
        const std::string_view kind = words.substr(0, colon);
        const std::string_view rest = colon == std::string_view::npos ? "" : words.substr(colon + 1);
        if (words == "none") {
            source.kind = Source::Kind::none;
        } else if (kind == "trace" && !rest.empty()) {
            source.kind = Source::Kind::trace;
            source.file = folder / rest;
        } else if (kind == "opentrack" || kind == "dtrack") {
            source.kind = kind == "dtrack" ? Source::Kind::dtrack : Source::Kind::opentrack;
            readAddress(rest);
        } else {
            fail("is not a source; write none, trace:FILE.csv, opentrack:[HOST:]PORT or dtrack:[HOST:]PORT[:BODY]");
        }
    }
};

}  // namespace

Source Source::parse(std::string_view text, const std::string& name, const std::filesystem::path& folder) {
    Reader reader{text, name};
    // Reads from the end, so that a trace's name may contain blanks.
    std::string_view words = text;
    while (true) {
        words = base::split(words, '\n').front();
        const auto blank = words.find_last_of(" \t");
        if (blank == std::string_view::npos || !reader.placed(words.substr(blank + 1))) {
            break;
        }
        words = words.substr(0, blank);
    }
    reader.readKind(words, folder);
    reader.source.text = words;
    return reader.source;
}

RoomMapping Source::mapping(glm::dvec3 restingEye) const {
    return {origin.value_or(kind == Kind::opentrack ? restingEye : glm::dvec3(0)), axes, eyes};
}

}  // namespace tracking
