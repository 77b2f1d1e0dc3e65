// SPDX-License-Identifier: Apache-2.0
#include "scene/import/point_fields.hpp"

#include <algorithm>
#include <initializer_list>
#include <string>

#include "base/number.hpp"
#include "base/text.hpp"

namespace scene {
namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }
/// Bytes of other letters in UTF-8 count as letters: "L\u00e4nge" is one word.
bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (static_cast<unsigned char>(c) & 0x80U) != 0;
}

/// Returns the words of a field: "WGS84_Lat [deg]" holds wgs, lat and deg.
std::vector<std::string> wordsOf(std::string_view field) {
    std::vector<std::string> words;
    for (auto at = field.begin(); (at = std::find_if(at, field.end(), isLetter)) != field.end();) {
        const auto end = std::find_if_not(at, field.end(), isLetter);
        words.push_back(base::lowerCase({at, end}));
        at = end;
    }
    return words;
}

bool holds(const std::vector<std::string>& words, std::initializer_list<std::string_view> any) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return std::find(any.begin(), any.end(), word) != any.end(); });
}

}  // namespace

std::vector<std::string_view> pointFieldsOf(std::string_view text) {
    if (text.find(';') != std::string_view::npos) {
        return base::split(text, ';');
    }
    std::vector<std::string_view> words = base::words(text);
    if (text.find(',') == std::string_view::npos) {
        return words;
    }
    const bool decimal = words.size() > 1 && std::all_of(words.begin(), words.end(), [](std::string_view word) {
                             return base::numberOf(word) || base::commaNumberOf(word);
                         });
    return decimal ? words : base::split(text, ',');
}

bool meansNumber(std::string_view field) {
    const auto first = std::find_if(field.begin(), field.end(), [](char c) { return isDigit(c) || isLetter(c); });
    if (first == field.end() || isDigit(*first)) {
        return first != field.end();
    }
    return holds({wordsOf(field).front()}, {"nan", "inf", "infinity"});
}

bool isLatitude(std::string_view name) {
    return holds(wordsOf(name), {"lat", "latitude", "latitud", "latitudine", "breite", "breitengrad"});
}

bool isDegrees(std::string_view name) {
    return isLatitude(name) ||
           holds(wordsOf(name), {"lon", "long", "lng", "longitude", "longitud", "longitudine", "laenge", "l\u00e4nge",
                                 "l\u00c4nge", "laengengrad", "l\u00e4ngengrad", "deg", "degree", "degrees", "grad"});
}

std::vector<std::size_t> axesOf(std::string_view name) {
    const std::vector<std::string> words = wordsOf(name);
    std::vector<std::size_t> axes;
    if (holds(words, {"x", "e", "east", "easting", "eastings", "rechtswert", "rechts", "ost", "ostwert", "est", "este",
                      "xcoord", "coordx"})) {
        axes.push_back(0);
    }
    if (holds(words, {"y", "n", "north", "northing", "northings", "hochwert", "hoch", "nord", "nordwert", "norte",
                      "ycoord", "coordy"})) {
        axes.push_back(1);
    }
    if (holds(words, {"z", "h", "height", "elev", "elevation", "alt", "altitude", "hoehe", "h\u00f6he", "cota",
                      "zcoord", "coordz"})) {
        axes.push_back(2);
    }
    return axes;
}

bool isLettered(std::string_view name) { return holds(wordsOf(name), {"x", "y", "z"}); }

bool isAngle(std::string_view field) {
    if (field.find('\xB0') != std::string_view::npos || field.find("\xC2\xBA") != std::string_view::npos) {
        return true;  // a degree sign in UTF-8 or Latin-1, or the ordinal sign that is often typed for it
    }
    const bool facing = !field.empty() && std::string_view("NSEW").find(field.back()) != std::string_view::npos;
    return facing && base::numberOf(base::trimmed(field.substr(0, field.size() - 1)));
}

}  // namespace scene
