// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace walls {

/// Line drawing that is written as SVG. Points are in pixels of the page, from its top left.
class SvgPage {
public:
    enum class Anchor { start, middle, end };
    /// Look of a line or an area, in CSS colours. `fill` "none" means no filling. `dash` is written as in SVG; empty
    /// means a solid line.
    struct Style {
        std::string_view stroke = "#333333", fill = "none", dash{};
        double width = 1;  // [pixel]
    };

    void polygon(const std::vector<glm::dvec2>& points, const Style& style);
    void line(glm::dvec2 from, glm::dvec2 to, const Style& style);
    void circle(glm::dvec2 centre, double radius, const Style& style);
    /// Adds a text whose line is `size` pixels high. Characters with a meaning in XML are written as entities.
    void text(glm::dvec2 at, double size, Anchor anchor, std::string_view text, std::string_view colour = "#222222");
    /// Adds a length between two points: a line with a tick at each end, and its text beside the middle.
    void dimension(glm::dvec2 from, glm::dvec2 to, const std::string& text, double size);

    /// Returns the whole file.
    [[nodiscard]] std::string finished(glm::dvec2 size) const;

private:
    std::string body_;
};

}  // namespace walls
