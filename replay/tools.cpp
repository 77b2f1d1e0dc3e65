// SPDX-License-Identifier: Apache-2.0
#include "replay/tools.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "base/input_error.hpp"
#include "host/print_line.hpp"
#include "host/regular_file.hpp"
#include "host/whole_file.hpp"
#include "master/journal/journal.hpp"
#include "sand/force/vec3.hpp"
#include "scene/import/raster_memory.hpp"
#include "scene/load/memory.hpp"
#include "scene/model/scene.hpp"

namespace replay {
namespace {

constexpr std::array<std::string_view, sand::kEdits> kEditNames{"", "settle", "reset", "undo", "tune", "load"};

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

void requireMemory(const std::filesystem::path& journal, DecodedFor use, std::int64_t freeBytes) {
    const master::JournalReader reader(journal);
    const sand::FieldSize size = sand::FieldSize::of(master::rulesOf(reader));
    if (!size.bytesOfReplica()) {
        if (use == DecodedFor::replica) {
            scene::requireReplica(master::sceneOf(reader), journal.string(), freeBytes);
        }
    } else if (use == DecodedFor::replica) {
        scene::requireReplica(size, journal.string(), freeBytes);
    } else {
        scene::requireBytes(size.bytesOfHeights(), freeBytes, journal.string(),
                            fmt::format("{} x {} heights", size.columns, size.rows), "take a machine with more memory");
    }
}

void sayWhatIsMissing(const std::filesystem::path& journal, std::int64_t tornBytes, bool orderlyEnd) {
    if (tornBytes > 0) {
        host::printLine("{}: the last {} bytes are an incomplete write and were left out", journal.string(), tornBytes);
    }
    if (!orderlyEnd) {
        host::printLine("{}: has no orderly end; the session was cut off", journal.string());
    }
}

void requireStep(const std::filesystem::path& journal, std::uint64_t last, std::optional<std::uint64_t> until) {
    if (until && last < *until) {
        throw base::InputError(fmt::format("{}: ends at step {}, before --until {}", journal.string(), last, *until));
    }
}

void exportSteps(const std::filesystem::path& journal, const std::filesystem::path& file,
                 std::optional<std::uint64_t> until) {
    master::JournalReader reader(journal);
    ExportedTool tool(master::sceneOf(reader));
    host::WholeFile out(file);
    out.stream() << "epoch,number,frame,engaged,tool,radius,heading,path,edit\n";
    bool orderlyEnd = false;
    std::uint64_t last = 0;
    while (const auto record = reader.next()) {
        orderlyEnd = std::holds_alternative<master::JournalEnd>(*record) ||
                     (orderlyEnd && !std::holds_alternative<master::JournalResumed>(*record));
        const auto* frame = std::get_if<master::JournalFrame>(&*record);
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
                       step.engaged ? 1 : 0, tool.text(), pathText(step, tool.unit()),
                       kEditNames.at(static_cast<std::size_t>(step.edit.kind)));
            tool.end(step);
        }
    }
    requireStep(journal, last, until);
    out.keep();
    sayWhatIsMissing(journal, reader.tornBytes(), orderlyEnd);
}

void recoverJournal(const std::filesystem::path& journal, const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::exists(file, error)) {
        throw base::InputError(fmt::format("{}: is there already; choose another file", file.string()));
    }
    master::JournalReader reader(journal);
    scene::Scene scene = master::sceneOf(reader);
    scene.material = reader.header().material.value_or(scene::Material());
    if (file.has_parent_path()) {
        try {
            host::makeFolders(file.parent_path());
        } catch (const std::filesystem::filesystem_error&) {
            error.clear();  // the writer reports it
        }
    }
    master::JournalWriter writer(file, scene, reader.header().buildId);
    std::uint64_t records = 0, step = 0;
    std::string damage;
    try {
        while (const auto record = reader.next()) {
            ++records;
            const auto* frame = std::get_if<master::JournalFrame>(&*record);
            step = frame != nullptr && !frame->steps.empty() ? frame->steps.back().number : step;
            writer.keep(*record);
        }
    } catch (const base::InputError& found) {
        damage = found.what();
    }
    writer.sync();
    const std::int64_t lost = reader.allBytes() - reader.wholeBytes();
    if (!damage.empty()) {
        fmt::print("{}\n", damage);
    }
    fmt::print("{}: {} records, to step {}; {} of {} bytes are lost\n", file.string(), records, step, lost,
               reader.allBytes());
}

}  // namespace replay
