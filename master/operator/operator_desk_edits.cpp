// SPDX-License-Identifier: Apache-2.0
// Edits, undos and redos that operators ask for, and the answers to them.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/input_error.hpp"
#include "host/clock.hpp"
#include "master/operator/operator_desk.hpp"

namespace master {

void OperatorDesk::askEdit(sand::Edit edit, const Asker& asker, const std::optional<scene::Material>& material) {
    if (edit.kind == sand::Edit::undo && !session_.sand.replica().canUndo()) {
        throw base::InputError("nothing to undo");
    }
    addEdit(std::move(edit), asker, material, {});
}

void OperatorDesk::requireRoomOnDisk(const sand::Edit& edit) {
    // Refuses at once. Otherwise the client would wait until the disk has room, and the edit would come late.
    if (!session_.room(session_.edits.sandBytes(edit))) {
        if (session_.room(session_.edits.sandBytes())) {
            throw base::InputError(
                fmt::format("the disk has no room for {} bytes of sand in the journal; the edit was "
                            "refused: free disk space and try again",
                            session_.edits.sandBytes(edit) - session_.edits.sandBytes()));
        }
        answerEditsThatWaitForRoom();
        throw base::InputError(
            "the disk has no room for the journal, so the sand is stopped; the edit was refused: free disk space and "
            "try again");
    }
}

std::uint64_t OperatorDesk::addEdit(sand::Edit edit, const Asker& asker, const std::optional<scene::Material>& material,
                                    const sand::History::Intent& intent) {
    session_.edits.requireRoomFor(edit);
    requireRoomOnDisk(edit);
    std::optional<Client> client = asker.client;
    if (paused_ && client) {
        control_->answer(*client, answerLine({{"ok", true}, {"waits_for", "resume"}}));
        client.reset();
    }
    return session_.edits.add(std::move(edit), client, material, intent);
}

void OperatorDesk::askReturn(sand::History::Move move, const Asker& asker) {
    if (!paused_) {
        undo_.ask({move, asker});
        return;
    }
    undo_.ask({move, {}});  // answered now, because a paused session would let the client wait
    if (asker.client) {
        control_->answer(*asker.client, answerLine({{"ok", true}, {"waits_for", "resume"}}));
    } else if (asker.window) {
        windows_.answer(*asker.window, fmt::format("{} waits until Space resumes", nameOf(move)));
    }
}

/// Another material than the present one is another edit, before the one that restores its sand.
std::uint64_t OperatorDesk::addReturn(sand::Edit edit, const scene::UndoHistory::Return& wanted, const Asker& asker) {
    const scene::Material material = scene::withToolOf(wanted.material, material_);
    if (material != material_) {
        if (const auto fault = scene::faultOf(material, grid_)) {
            throw base::InputError(
                fmt::format("the material of that moment does not fit the tool: {}", fault->message));
        }
        session_.edits.requireRoomFor(edit, 2);
        requireRoomOnDisk(edit);
        addEdit(sand::Edit::tuned(scene::tuningOf(material, grid_)), {}, material, wanted.how.intent);
        material_ = material;
        views_.setHumidity(material_.humidity);
    }
    return addEdit(std::move(edit), asker, std::nullopt, wanted.how.intent);
}

void OperatorDesk::answerReturn(const UndoDesk::Asked& asked, const ArrivedStep& shown) {
    const std::size_t undos = undo_.entries().undosLeft(), redos = undo_.entries().redosLeft();
    const bool undoes = asked.move == sand::History::Move::undo;
    const std::string nothing = fmt::format("nothing to {}", nameOf(asked.move));
    if (!undo_.changedAnything()) {
        refuse(nothing, {{shown.client, asked.asker.window}});
    } else if (shown.client) {
        control_->answer(
            *shown.client,
            answerLine({{"ok", true}, {"step", shown.step.number}, {"undo_left", undos}, {"redo_left", redos}}));
    } else if (asked.asker.window) {
        const std::size_t left = undoes ? undos : redos;
        windows_.answer(*asked.asker.window,
                        fmt::format("{}; {} more to {}", undoes ? "undone" : "redone",
                                    left == 0 ? "nothing" : std::to_string(left), nameOf(asked.move)));
    }
}

/// Changes the material only if the edit was accepted. Later changes start from this material.
void OperatorDesk::askMaterial(const scene::Material& material, const Asker& asker) {
    askEdit(sand::Edit::tuned(scene::tuningOf(material, grid_)), asker, material);
    material_ = material;
    views_.setHumidity(material_.humidity);
}

/// The hand feels the share before the journal has it, because switching forces off must not wait for a disk.
void OperatorDesk::answerEditsThatWaitForRoom() {
    answerSettle({});
    for (const Client client : session_.edits.releaseClients()) {
        control_->answer(client, answerLine({{"ok", true}, {"waits_for", "room"}}));
    }
}

void OperatorDesk::answer(const ArrivedSteps& steps) {
    const MasterSand& sand = session_.sand;
    const auto answerIfEnded = [this, &sand] {
        if (const std::optional<SettleEnd> end = settling_ ? sand.endOfSettle(settling_->step) : std::nullopt) {
            answerSettle(end);
        }
    };
    answerIfEnded();  // one of an earlier frame
    for (const ArrivedStep& timed : steps) {
        const std::uint64_t step = timed.step.number;
        if (const std::optional<UndoDesk::Asked> ended = undo_.takeEnded(timed.step.edit.number)) {
            answerReturn(*ended, timed);
            continue;
        }
        if (!timed.client) {
            continue;
        }
        if (sand.settlingSince() == step || sand.endOfSettle(step)) {
            settling_ = {*timed.client, step, host::monotonicNs()};
            answerIfEnded();
        } else {
            control_->answer(*timed.client, answerLine({{"ok", true}, {"step", step}}));
        }
    }
    if (settling_ && host::monotonicNs() - settling_->sinceNs > kSettleNs) {
        answerSettle({});
    }
}

void OperatorDesk::answerSettle(std::optional<SettleEnd> end) {
    if (!settling_) {
        return;
    }
    nlohmann::json json{{"ok", true}, {"step", settling_->step}};
    if (end) {
        json["settle_ended_by"] = std::string(base::nameOf(*end));
    } else {
        json["settling"] = true;
    }
    control_->answer(settling_->client, answerLine(json));
    settling_.reset();
}

}  // namespace master
