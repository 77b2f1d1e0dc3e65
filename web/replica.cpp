// SPDX-License-Identifier: Apache-2.0
// The functions that web/page/worker.ts calls: one session at a time. Functions that can fail return -1, or nullptr
// for an address, and sw_problem() then has the sentence for the user. Pointers stay valid until the next call that
// changes what they name.
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "web/exported.hpp"
#include "web/replica/json_text.hpp"

#define API SANDWALL_PAGE_API

namespace {

auto& page = web::exported;
const std::unique_ptr<web::StepSource>& session = web::exported.session;

template <class Work>
int guarded(Work&& work) {
    return page.guarded(std::forward<Work>(work));
}

/// The sand that is shown, for web/replica/replica.ts.
struct ShownSand {
    template <class Self, class Visit>
    static void fields(Self& /*it*/, Visit& visit) {
        const scene::Scene& scene = session->scene();
        visit("name", scene.name);
        visit("shortcoming", session->shortcoming());
        visit("hasHeights", page.drawing->hasHeights());
        visit("columns", scene.rules.columns);
        visit("rows", scene.rules.rows);
        visit("cell", session->replica().cellSize());  // [scene unit]
        visit("stepsPerSecond", scene.rules.stepsPerSecond);
        visit("middle",
              scene.referenceHeight() / double{sand::kUnitsPerCell});  // height in the middle of the room [cell]
        if (page.recorded != nullptr) {
            visit("lastStep", page.recorded->lastStep());
            visit("hashes", page.recorded->hashes());
            visit("marks", page.recorded->marks());
        }
    }
};

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
        page.show(std::make_unique<web::PageSession>(name, std::exchange(page.parts, {}), SANDWALL_RELEASE_NAME,
                                                     web::Exported::kMemory));
        return 0;
    });
}

/// Returns what is shown, as JSON (ShownSand).
API const char* sw_session() { return page.textAt(web::jsonOf(ShownSand())); }

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
/// Looks from an eye along the direction of its sight [cell]. Returns 1 if it meets the sand, or else 0. The numbers of
/// the place are at sw_place(): x and y [cell], height [scene unit, as the scene's terrain has it], height [cell].
API int sw_look(double fromX, double fromY, double fromZ, double alongX, double alongY, double alongZ) {
    return guarded([=] {
        const sand::Replica& replica = session->replica();
        const sand::HeightSpan units = replica.surface().heights();
        const haptic_bridge::TouchedSand touched;
        const auto place = touched.meet({{fromX, fromY, fromZ}, {alongX, alongY, alongZ}}, false, replica,
                                        {units.lowest / sand::kUnitsPerCell, units.highest / sand::kUnitsPerCell});
        if (place) {
            const double height =
                touched.height(replica, false, place->x * sand::kProbePerCell, place->y * sand::kProbePerCell) /
                sand::kUnitsPerCell;
            page.place = {place->x, place->y, height * replica.cellSize() + session->scene().georeference.datum,
                          height};
        }
        return place ? 1 : 0;
    });
}
API const double* sw_place() { return page.place.data(); }
API const char* sw_hash() { return page.textAt(fmt::format("{:016x}", session->replica().stateHash())); }

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

/// Takes the present sand and tool to draw them. sw_next_piece() then has what differs from before.
API int sw_draw() {
    return guarded([] {
        page.drawing->take();
        return 0;
    });
}
/// Goes to the next piece of the drawing. Returns 1, or 0 behind the last one.
API int sw_next_piece() {
    return guarded([] { return page.drawing->next(page.piece) ? 1 : 0; });
}
API int sw_arrays() { return static_cast<int>(page.piece.arrays.size()); }
API const char* sw_array_name(std::uint32_t array) { return page.piece.arrays.at(array).name.c_str(); }
/// The type of its numbers: their place in web::Piece::Numbers.
API int sw_array_type(std::uint32_t array) { return static_cast<int>(page.piece.arrays.at(array).numbers.index()); }
API int sw_array_length(std::uint32_t array) {
    return std::visit([](const auto& numbers) { return static_cast<int>(numbers.size()); },
                      page.piece.arrays.at(array).numbers);
}
API const void* sw_array(std::uint32_t array) {
    return std::visit([](const auto& numbers) { return static_cast<const void*>(numbers.data()); },
                      page.piece.arrays.at(array).numbers);
}
