// SPDX-License-Identifier: Apache-2.0
// The functions that web/worker.ts calls: one session at a time. Functions that can fail return -1, or nullptr
// for an address, and sw_problem() then has the sentence for the user. Pointers stay valid until the next call that
// changes what they name.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "web/drawn_sand.hpp"
#include "web/exported.hpp"

#define API SANDWALL_PAGE_API

namespace {

std::vector<std::int32_t> marks;
web::DrawnSand drawn;
std::string text;

auto& page = web::exported;
const std::unique_ptr<web::StepSource>& session = web::exported.session;

template <class Work>
int guarded(Work&& work) {
    return page.guarded(std::forward<Work>(work));
}

}  // namespace

API const char* sw_problem() { return page.problem.c_str(); }

/// Drops the parts of a journal that was not opened.
API void sw_begin() { page.parts.clear(); }
/// Adds the next part of a journal. Returns where its bytes go. If there is no memory, drops all parts.
API std::uint8_t* sw_add_part(std::uint32_t size) {
    base::Bytes part;
    std::uint8_t* const at = page.resized(part, size);
    const auto add = [&part] {
        page.parts.push_back(std::move(part));
        return 0;
    };
    if (at == nullptr || guarded(add) != 0) {
        page.parts = {};
        return nullptr;
    }
    return at;
}
/// Opens the journal of all parts. If it fails, the session before stays open.
API int sw_open(const char* name) {
    return guarded([name] {
        auto opened = std::make_unique<web::PageSession>(name, std::exchange(page.parts, {}), SANDWALL_RELEASE_NAME,
                                                         web::Exported::kMemory);
        marks.clear();
        for (const web::Mark& mark : opened->marks()) {
            marks.push_back(static_cast<std::int32_t>(mark.step));
            marks.push_back(static_cast<std::int32_t>(mark.kind));
        }
        page.show(std::move(opened));
        return 0;
    });
}

API const char* sw_name() { return session->scene().name.c_str(); }
API const char* sw_shortcoming() { return session->shortcoming().c_str(); }
API int sw_columns() { return session->scene().rules.columns; }
API int sw_rows() { return session->scene().rules.rows; }
API double sw_cell_size() { return session->replica().cellSize(); }  // [scene unit]
API int sw_steps_per_second() { return session->scene().rules.stepsPerSecond; }
API int sw_last_step() { return static_cast<int>(page.recorded->lastStep()); }
API int sw_hashes() { return static_cast<int>(page.recorded->hashes()); }
/// Pairs of a step and a web::Mark::Kind.
API const std::int32_t* sw_marks() { return marks.data(); }
API int sw_mark_count() { return static_cast<int>(marks.size() / 2); }
/// Linear-light RGB of sand and of background, and the direction to the sun. Behind them: 1 if the field has boards
/// around it, and the height that lies in the middle of the room [cell].
API const float* sw_look() {
    static std::vector<float> look;
    look.clear();
    const scene::Look& from = session->scene().look;
    for (const auto* triple : {&from.sandColour, &from.backgroundColour, &from.sunDirection}) {
        look.insert(look.end(), triple->begin(), triple->end());
    }
    look.push_back(session->scene().rules.rim == sand::Rim::closed ? 1.0F : 0.0F);
    look.push_back(static_cast<float>(session->scene().referenceHeight()) / float{sand::kUnitsPerCell});
    return look.data();
}

/// Takes the next record of the first pass. Returns 1, or 0 behind the last one.
API int sw_advance() {
    return guarded([] { return page.recorded->advance() ? 1 : 0; });
}
/// Applies the next step after the first pass. Returns 1, or 0 behind the last one.
API int sw_step_on() {
    return guarded([] { return page.recorded->stepOn() ? 1 : 0; });
}
API int sw_step() { return static_cast<int>(session->replica().stepNumber()); }
API int sw_matches() { return static_cast<int>(page.recorded->matches()); }
API int sw_mismatches() { return static_cast<int>(page.recorded->mismatches()); }
API const char* sw_hash() {
    text = fmt::format("{:016x}", session->replica().stateHash());
    return text.c_str();
}

/// Encodes the whole state. Returns its length [byte]; the bytes are at sw_state_bytes().
API int sw_state() {
    return guarded([] {
        page.bytes = session->replica().encodeState();
        return static_cast<int>(page.bytes.size());
    });
}
API const std::uint8_t* sw_state_bytes() { return page.bytes.data(); }
/// Makes room for a state, which sw_restore() then puts back.
API std::uint8_t* sw_room_for_state(std::uint32_t size) { return page.resized(page.bytes, size); }
API int sw_restore() {
    return guarded([] {
        session->replica().decodeState(page.bytes);
        return 0;
    });
}

/// Takes the present sand to draw it. Returns 1 for a TIN, 0 for a grid.
API int sw_draw() {
    return guarded([] {
        drawn.take(session->replica().surface());
        return drawn.meshed ? 1 : 0;
    });
}
API const std::int32_t* sw_heights() { return drawn.heights.data(); }
/// Takes the cells without ground, which never change in a session. Returns 1 if there are any.
API int sw_take_holes() {
    return guarded([] { return drawn.takeHoles(session->replica().surface()) ? 1 : 0; });
}
/// One byte for each cell: 1 if it has no ground.
API const std::uint8_t* sw_holes() { return drawn.holes.data(); }
API const float* sw_places() { return drawn.places.data(); }
API int sw_vertices() { return static_cast<int>(drawn.places.size() / 3); }
API const std::int32_t* sw_corners() { return drawn.corners.data(); }
API int sw_triangles() { return static_cast<int>(drawn.corners.size() / 3); }
/// Centre x, y, z and radius of the tool [cell], and 1 if it is engaged. Behind them: its sand::ToolKind, its half
/// width [cell], its heading to the east and to the north, and 1 if it is mirrored.
API const float* sw_tool() {
    static float numbers[10];
    const sand::ProbePoint probe = session->replica().probe();
    const sand::Tool tool = session->replica().tool();
    const auto cells = [](std::int32_t length) { return static_cast<float>(length) / float{sand::kProbePerCell}; };
    const float all[10]{cells(probe.x),
                        cells(probe.y),
                        cells(probe.z),
                        cells(tool.radius),
                        session->replica().engaged() ? 1.0F : 0.0F,
                        static_cast<float>(tool.kind),
                        cells(tool.halfWidth),
                        static_cast<float>(tool.heading.x),
                        static_cast<float>(tool.heading.y),
                        tool.heading.mirrored ? 1.0F : 0.0F};
    std::copy(std::begin(all), std::end(all), numbers);
    return numbers;
}
/// Humidity of the sand, 0 to 1.
API double sw_humidity() { return session->humidity(); }
