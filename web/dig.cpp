// SPDX-License-Identifier: Apache-2.0
// The functions with which web/hand/hand_source.ts digs. They fail as those of replica.cpp do.
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

#include "base/input_error.hpp"
#include "web/exported.hpp"
#include "web/hand/grid_scene.hpp"
#include "web/hand/notches.hpp"
#include "web/replica/opening.hpp"
#include "web/words.hpp"

#define API SANDWALL_PAGE_API

namespace {

auto& digs = web::exported;

std::string_view textOf(const base::Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Begins to dig. `high` and `low` are the two halves of the session's random number.
int begin(scene::Scene scene, std::uint32_t high, std::uint32_t low) {
    const std::uint64_t session = std::uint64_t{high} << 32 | low;
    digs.show(std::make_unique<web::DugSession>(std::move(scene), session, SANDWALL_RELEASE_NAME));
    return 0;
}

/// Returns the only part that was added, and drops it.
base::Bytes onlyPart(const char* name) {
    std::vector<base::Bytes> parts = std::exchange(digs.parts, {});
    if (parts.size() != 1) {
        throw base::InputError(fmt::format("{}: drop one file", name));
    }
    return std::move(parts.front());
}

}  // namespace

/// Begins on the scene of a journal, which was added as a part. Only its header counts.
API int sw_dig_scene(const char* name, std::uint32_t high, std::uint32_t low) {
    return digs.guarded([=] {
        std::vector<base::Bytes> parts;
        parts.push_back(onlyPart(name));
        return begin(web::sceneWithMaterial(
                         web::openedJournal(name, std::move(parts), SANDWALL_RELEASE_NAME, web::Exported::kMemory)),
                     high, low);
    });
}
/// Begins on the sand with which the session that is dug now began.
API int sw_dig_again(std::uint32_t high, std::uint32_t low) {
    return digs.guarded([=] {
        if (digs.dug == nullptr) {
            throw base::InputError("there is no sand to begin again with");
        }
        return begin(digs.dug->scene(), high, low);
    });
}
/// Begins to continue with a journal of this page, whose parts were added. sw_return_on() computes its steps.
API int sw_return(const char* name) {
    return digs.guarded([=] {
        digs.show(std::make_unique<web::DugSession>(
            web::openedJournal(name, std::exchange(digs.parts, {}), SANDWALL_RELEASE_NAME, web::Exported::kMemory),
            SANDWALL_RELEASE_NAME));
        return 0;
    });
}
/// Puts the state in sw_room_for_state() in the place of all steps up to `step`. `high` and `low` are the two halves of
/// the state hash there.
API int sw_return_from(double step, std::uint32_t high, std::uint32_t low) {
    return digs.guarded([=] {
        digs.dug->returnFrom({static_cast<std::uint64_t>(step), std::uint64_t{high} << 32 | low}, digs.bytes);
        return 0;
    });
}
/// Takes the next record of the journal to continue with. Returns 1, or 0 behind the last one.
API int sw_return_on() {
    return digs.guarded([] { return digs.dug->returnOn() ? 1 : 0; });
}
/// Begins on an ESRI ASCII grid, whose text was added as a part.
API int sw_dig_grid(const char* name, std::uint32_t high, std::uint32_t low) {
    return digs.guarded([=] {
        const base::Bytes text = onlyPart(name);
        return begin(web::sceneOfGrid(textOf(text), name, web::Exported::kMemory), high, low);
    });
}
/// Checks the size of a grid. Its first bytes were added as a part; all of it has `bytes`.
API int sw_check_grid(const char* name, double bytes) {
    return digs.guarded([=] {
        const base::Bytes text = onlyPart(name);
        web::requireGridFits(textOf(text), static_cast<std::int64_t>(bytes), name, web::Exported::kMemory);
        return 0;
    });
}

/// Takes a reading of the pointer at `ms` [ms]: the eye, the direction of its sight [cell], and whether it is pressed.
API int sw_point(double ms, double fromX, double fromY, double fromZ, double alongX, double alongY, double alongZ,
                 int pressed) {
    return digs.guarded([=] {
        constexpr double kLatest = 1e12;  // [ms]
        if (ms >= 0 && ms < kLatest) {
            digs.dug->point(static_cast<std::int64_t>(ms * 1e6), {{fromX, fromY, fromZ}, {alongX, alongY, alongZ}},
                            pressed != 0);
        }
        return 0;
    });
}
API int sw_set_depth(double depth) {
    return digs.guarded([=] {
        digs.dug->setDepth(depth);
        return 0;
    });
}
/// Applies the next step. Returns 1 if the picture may have changed, or else 0.
API int sw_dig_on() {
    return digs.guarded([] { return digs.dug->advance() ? 1 : 0; });
}
/// Returns 1 if the next step is a settle that blocks this thread.
API int sw_settles_next() { return digs.dug->settlesNext() ? 1 : 0; }

/// Asks for an edit by its name, or for a redo.
API int sw_ask(const char* edit) {
    return digs.guarded([=] {
        if (std::string_view(edit) == web::kRedo) {
            digs.dug->redo();
        } else {
            digs.dug->ask(web::editNamed(edit));
        }
        return 0;
    });
}
/// Sets a number of the material by the word of an operator's command.
API int sw_set_material(const char* word, double value) {
    return digs.guarded([=] {
        digs.dug->setNumber(word, value);
        return 0;
    });
}
/// Changes a part of the tool, as web::toolChange() says.
API int sw_set_tool(const char* part, const char* value) {
    return digs.guarded([=] {
        digs.dug->setTool(web::toolChange(part, value));
        return 0;
    });
}
/// Changes the tool or the material by notches, as web::changeByNotches() says.
API int sw_change_by_notches(const char* what, double notches) {
    return digs.guarded([=] {
        web::changeByNotches(*digs.dug, what, notches);
        return 0;
    });
}
/// Gives a tool that is too small to be seen the usual size of the field.
API int sw_enlarge_tool() {
    return digs.guarded([] {
        web::enlargeTool(*digs.dug);
        return 0;
    });
}
/// Returns what a hand can choose, as JSON (web::wordsOfPage()).
API const char* sw_words() { return digs.textAt(web::wordsOfPage()); }
/// Returns the material with all changes that were asked for, as JSON (web::materialText()).
API const char* sw_material() { return digs.textAt(web::materialText(digs.dug->material())); }
/// Returns the material of the scene, as JSON.
API const char* sw_scene_material() { return digs.textAt(web::materialText(digs.dug->scene().material)); }
/// Returns 1 if a stroke or an edit can be undone.
API int sw_can_undo() { return digs.dug->canUndo() ? 1 : 0; }
/// Returns 1 if an undo can be redone.
API int sw_can_redo() { return digs.dug->canRedo() ? 1 : 0; }

/// Encodes the journal of all steps. Returns its length [byte]; the bytes are at sw_state_bytes().
API int sw_journal() {
    return digs.guarded([] {
        digs.bytes = digs.dug->journal();
        return static_cast<int>(digs.bytes.size());
    });
}
/// Returns the length of the journal so far [byte], without an end. Later steps change no byte of it.
API int sw_written() { return static_cast<int>(digs.dug->written().size()); }
API const std::uint8_t* sw_written_bytes() { return digs.dug->written().data(); }
/// Returns how many steps the hand or an edit has changed.
API double sw_touched() { return static_cast<double>(digs.dug->touched()); }
/// Returns 1 if the scene's sand has been changed.
API int sw_dug() { return digs.dug->dug() ? 1 : 0; }
/// Returns 1 if the next step changes nothing but its number.
API int sw_rests() { return digs.dug->rests() ? 1 : 0; }
