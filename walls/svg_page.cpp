// SPDX-License-Identifier: Apache-2.0
#include "walls/svg_page.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace walls {
namespace {

std::string look(const SvgPage::Style& style) {
    return fmt::format(R"(stroke="{}" fill="{}" stroke-width="{:g}"{})", style.stroke, style.fill, style.width,
                       style.dash.empty() ? "" : fmt::format(R"( stroke-dasharray="{}")", style.dash));
}

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

}  // namespace

void SvgPage::polygon(const std::vector<glm::dvec2>& points, const Style& style) {
    body_ += "<polygon points=\"";
    for (const glm::dvec2 p : points) {
        body_ += fmt::format("{:.2f},{:.2f} ", p.x, p.y);
    }
    body_ += fmt::format("\" {}/>\n", look(style));
}

void SvgPage::line(glm::dvec2 from, glm::dvec2 to, const Style& style) {
    body_ += fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" {}/>\n", from.x, from.y, to.x,
                         to.y, look(style));
}

void SvgPage::circle(glm::dvec2 centre, double radius, const Style& style) {
    body_ +=
        fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" {}/>\n", centre.x, centre.y, radius, look(style));
}

void SvgPage::text(glm::dvec2 at, double size, Anchor anchor, std::string_view text, std::string_view colour) {
    constexpr std::array<std::string_view, 3> kAnchors{"start", "middle", "end"};
    body_ += fmt::format(
        "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.1f}\" text-anchor=\"{}\" stroke=\"none\" "
        "fill=\"{}\">{}</text>\n",
        at.x, at.y, size, kAnchors.at(static_cast<std::size_t>(anchor)), colour, escaped(text));
}

void SvgPage::dimension(glm::dvec2 from, glm::dvec2 to, const std::string& text, double size) {
    constexpr double kTick = 4;  // [pixel]
    const Style style{"#1560a8", "none", "", 1};
    const glm::dvec2 along = to - from;
    const glm::dvec2 across =
        glm::length(along) > 0 ? glm::dvec2(-along.y, along.x) / glm::length(along) : glm::dvec2(0, 1);
    line(from, to, style);
    line(from - across * kTick, from + across * kTick, style);
    line(to - across * kTick, to + across * kTick, style);
    const glm::dvec2 middle = (from + to) / 2.0;
    if (std::abs(along.x) >= std::abs(along.y)) {
        this->text(middle - glm::dvec2(0, kTick + 2), size, Anchor::middle, text, style.stroke);
    } else {
        this->text(middle + glm::dvec2(6, size / 3), size, Anchor::start, text, style.stroke);
    }
}

std::string SvgPage::finished(glm::dvec2 size) const {
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" "
        "height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\">\n"
        "<rect x=\"0\" y=\"0\" width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n{2}</svg>\n",
        size.x, size.y, body_);
}

}  // namespace walls
