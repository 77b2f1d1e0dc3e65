// SPDX-License-Identifier: Apache-2.0
#include "scene/raster_statement.hpp"

#include <fmt/format.h>

namespace scene {
namespace {

constexpr std::size_t kLongestPart = 1 << 16;  // [byte] of one text; a path takes less

std::string textOf(base::ByteReader& reader) {
    std::string text = reader.getText();
    if (text.size() > kLongestPart) {
        throw base::FormatError("a terrain's file with a text too long");
    }
    return text;
}

std::string withOrigin(const std::string& what, const std::string& origin) {
    return origin.empty() ? what : fmt::format("{} ({})", what, origin);
}

}  // namespace

std::string RasterStatement::text() const {
    const std::string result = withOrigin(across + " across", acrossFrom) + ", " + withOrigin(up + " up", upFrom);
    if (!noData && noDataShare == 0) {
        return result + ", no cells without data";
    }
    const double percent = 100 * noDataShare;
    return result + fmt::format(", no data{} in {} % of cells", noData ? " " + *noData : "",
                                percent > 0 && percent < 0.1 ? "less than 0.1" : fmt::format("{:.3g}", percent));
}

void RasterStatement::encode(base::ByteWriter& writer) const {
    for (const std::string* text : {&file, &across, &acrossFrom, &up, &upFrom}) {
        writer.putText(*text);
    }
    writer.put(static_cast<std::uint8_t>(noData ? 1 : 0));
    if (noData) {
        writer.putText(*noData);
    }
    writer.put(noDataShare);
}

RasterStatement RasterStatement::decode(base::ByteReader& reader) {
    RasterStatement result;
    for (std::string* text : {&result.file, &result.across, &result.acrossFrom, &result.up, &result.upFrom}) {
        *text = textOf(reader);
    }
    if (reader.get<std::uint8_t>() != 0) {
        result.noData = textOf(reader);
    }
    result.noDataShare = reader.get<double>();
    if (!(result.noDataShare >= 0 && result.noDataShare <= 1)) {
        throw base::FormatError("a terrain's file with a share outside 0 to 1");
    }
    return result;
}

}  // namespace scene
