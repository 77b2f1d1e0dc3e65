// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace walls {

/// A picture in lines, written as SVG. Points are in pixels of the page, from its top left.
class SvgPage {
public:
    enum class Anchor { start, middle, end };
    /// A line's or area's look: CSS colours, "none" for no filling; `dash` as SVG writes it, empty for a whole line.
    struct Style {
        std::string_view stroke = "#333333", fill = "none", dash{};
        double width = 1;  // [pixel]
    };

    void polygon(const std::vector<glm::dvec2>& points, const Style& style);
    void line(glm::dvec2 from, glm::dvec2 to, const Style& style);
    void circle(glm::dvec2 centre, double radius, const Style& style);
    /// `size` is the height of the letters' line; characters that mean something in XML are written as entities.
    void text(glm::dvec2 at, double size, Anchor anchor, std::string_view text, std::string_view colour = "#222222");
    /// A length between two points: a line with a tick across each end and its text beside the middle.
    void dimension(glm::dvec2 from, glm::dvec2 to, const std::string& text, double size);

    /// The whole file.
    [[nodiscard]] std::string finished(glm::dvec2 size) const;

private:
    std::string body_;
};

}  // namespace walls
