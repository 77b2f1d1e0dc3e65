// SPDX-License-Identifier: Apache-2.0
#include "replay/export.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <array>
#include <string>
#include <string_view>
#include <variant>

#include "host/whole_file.hpp"
#include "master/journal/journal.hpp"
#include "replay/checks.hpp"
#include "sand/force/vec3.hpp"
#include "scene/model/scene.hpp"

namespace replay {
namespace {

/// The tool, as the steps so far have changed it.
class ExportedTool {
public:
    explicit ExportedTool(const scene::Scene& scene)
        : ofRules_(scene.rules.tuning.tool),
          heading_(ofRules_.heading),
          unit_(sand::probeUnit(scene.terrain.cellSize())) {}

    /// Takes the heading with which the hand moves in `step`.
    void begin(const sand::Step& step) { heading_ = step.heading.value_or(heading_); }
    /// Applies the tuning of `step` to later steps, as sand::Replica does.
    void end(const sand::Step& step) {
        if (step.edit.kind == sand::Edit::tune) {
            heading_ = sand::headingAfter(ofRules_, step.edit.tuning.tool, heading_);
            ofRules_ = step.edit.tuning.tool;
        }
    }
    [[nodiscard]] std::string text() const {
        return fmt::format("{},{},{:.6g}", base::nameOf(ofRules_.kind), ofRules_.radius * unit_,
                           sand::degreesOf(heading_));
    }
    [[nodiscard]] double unit() const { return unit_; }

private:
    sand::Tool ofRules_;
    sand::Heading heading_;
    double unit_;  // [scene unit], length of a probe unit
};

std::string pathText(const sand::Step& step, double unit) {
    std::string text;
    for (const sand::ProbePoint& point : step.path) {
        const sand::force::Vec3 place = sand::force::placeOf(point, unit);
        text += fmt::format("{}{} {} {}", text.empty() ? "" : ";", place.x, place.y, place.z);
    }
    return text;
}

}  // namespace

void exportSteps(const std::filesystem::path& journal, const std::filesystem::path& file,
                 std::optional<std::uint64_t> until) {
    journal::JournalReader reader = master::openJournal(journal);
    ExportedTool tool(journal::sceneOf(reader));
    host::WholeFile out(file);
    out.stream() << "epoch,number,frame,engaged,tool,radius,heading,path,edit\n";
    bool orderlyEnd = false;
    std::uint64_t last = 0;
    while (const auto record = reader.next()) {
        orderlyEnd = std::holds_alternative<journal::JournalEnd>(*record) ||
                     (orderlyEnd && !std::holds_alternative<journal::JournalResumed>(*record));
        const auto* frame = std::get_if<journal::JournalFrame>(&*record);
        if (frame == nullptr) {
            continue;
        }
        for (const sand::Step& step : frame->steps) {
            if (until && step.number > *until) {
                break;
            }
            last = step.number;
            tool.begin(step);
            fmt::print(out.stream(), "{},{},{},{},{},{},{}\n", step.epoch, step.number, frame->frame,
                       step.engaged ? 1 : 0, tool.text(), pathText(step, tool.unit()), base::nameOf(step.edit.kind));
            tool.end(step);
        }
    }
    requireStep(journal, last, until);
    out.keep();
    printMissing(journal, reader.tornBytes(), orderlyEnd);
}

}  // namespace replay
