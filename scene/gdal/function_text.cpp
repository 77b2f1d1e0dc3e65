// SPDX-License-Identifier: Apache-2.0
#include "scene/gdal/function_text.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>

#include "base/input_error.hpp"

namespace scene {
namespace {

[[noreturn]] void fail(const std::string& text, const std::string& message) {
    throw base::InputError(fmt::format("z = \"{}\": {}", text, message));
}

/// Throws base::InputError about a position in the text. Users count characters from 1, muParser counts from 0. The
/// position in muParser's own message is removed.
[[noreturn]] void failAt(const std::string& text, int position, std::string message) {
    for (const char* part : {" found at position", " at position"}) {
        message.erase(std::min(message.find(part), message.size()));
    }
    if (position < 0) {
        fail(text, message);
    }
    fail(text, static_cast<std::size_t>(position) < text.size() ? fmt::format("character {}: {}", position + 1, message)
                                                                : "at its end: " + message);
}

/// Refuses assignments. muParser would take "x = 3" for one.
void refuseAssignments(const std::string& text) {
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] != '=') {
            continue;
        }
        if (text.compare(at, 2, "==") == 0) {
            ++at;
        } else if (at == 0 || std::string("<>!").find(text[at - 1]) == std::string::npos) {
            failAt(text, static_cast<int>(at), "write the expression alone; == compares");
        }
    }
}

}  // namespace

EsriGrid evaluateFunction(const Function& function, const RasterCheck& check) {
    refuseAssignments(function.text);
    EsriGrid grid;
    grid.columns = function.columns;
    grid.rows = function.rows;
    grid.cellSize = (function.east - function.west) / function.columns;
    grid.westEdge = function.west;
    grid.southEdge = function.south;
    grid.heights.reserve(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
    const double depth = (function.north - function.south) / function.rows;
    double x = 0;
    double y = 0;
    try {
        mu::Parser parser;
        parser.DefineVar("x", &x);
        parser.DefineVar("y", &y);
        parser.SetExpr(function.text);
        int results = 0;
        for (int row = 0; row < grid.rows; ++row) {
            for (int column = 0; column < grid.columns; ++column) {
                x = function.west + (column + 0.5) * grid.cellSize;
                y = function.north - (row + 0.5) * depth;
                const double z = parser.Eval(results)[0];
                if (results != 1) {
                    fail(function.text, "expected one height, but a comma gives several");
                }
                if (!std::isfinite(z)) {
                    fail(function.text, fmt::format("z is {} at x = {:.6g}, y = {:.6g}",
                                                    std::isnan(z) ? "not a number" : "infinite", x, y));
                }
                grid.heights.add(z);
            }
            check.read((row + 1.0) / grid.rows);
        }
    } catch (const mu::ParserError& error) {
        failAt(function.text, error.GetPos(), error.GetMsg());
    }
    return grid;
}

}  // namespace scene
