// SPDX-License-Identifier: Apache-2.0
// What the operator's hand does to a session, between two frames.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/input_error.hpp"
#include "host/event.hpp"
#include "host/print_line.hpp"
#include "master/session.hpp"
#include "master/wall_pictures.hpp"
#include "walls/stereo_change.hpp"

namespace master {
namespace {

using Json = nlohmann::json;
using Client = ControlSocket::Client;

constexpr std::size_t kMostEditsWaiting = 16;
constexpr char kQuitKey = 27;  // Escape, in any window

std::string line(const Json& json) {
    // What a user has typed need not be text.
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string refusal(const std::string& why) { return line({{"ok", false}, {"error", why}}); }

std::string done() { return line({{"ok", true}}); }

/// As an operator would type it.
Json materialNow(const scene::Material& material) {
    return {{"talus", material.dryTalus},    {"wet-talus", material.wetTalusNow()},
            {"humidity", material.humidity}, {"cohesion", material.cohesionLength},
            {"band", material.band},         {"settling-time", material.settlingSeconds}};
}

/// capture_001, or the first after it that is not there; pictures of an earlier session stay.
std::filesystem::path newCaptureFolder(const std::filesystem::path& out) {
    for (int number = 1;; ++number) {
        std::filesystem::path folder = out / fmt::format("capture_{:03}", number);
        std::error_code error;
        if (std::filesystem::create_directory(folder, error) || error) {
            return folder;  // one that cannot be made is told by the first picture
        }
    }
}

}  // namespace

void Session::obeyOperator() {
    const std::vector<std::string> lines = operator_.takeLines();
    if (control_) {  // nobody commands a recording but to stop
        for (const std::string& typed : lines) {
            obey(typed, std::nullopt);
        }
        for (const ControlSocket::Asked& asked : control_->take()) {
            obey(asked.line, asked.client);
        }
    }
    finishErrands(false);
    for (const lockstep::Arrival& arrival : barrier_.arrivals()) {
        if (arrival.key == 't') {
            views_.show(lockstep::nextPattern(views_.pattern()));
        } else if (arrival.key == kQuitKey) {
            operator_.stop();
        }
    }
}

void Session::obey(const std::string& text, std::optional<Client> client) {
    try {
        carryOut(parseCommand(text), client);
    } catch (const base::InputError& error) {
        refuse(error.what(), {client});
    }
}

void Session::answerAll(const Clients& clients, const std::string& json) {
    for (const auto& client : clients) {
        if (client) {
            control_->answer(*client, json);
        }
    }
}

void Session::refuse(const std::string& why, const Clients& clients) {
    for (const auto& client : clients) {
        if (client) {
            control_->answer(*client, refusal(why));
        } else {
            host::printLine("{}", why);
            host::emitEvent("command_refused", {{"error", why}});
        }
    }
}

void Session::carryOut(const Command& command, std::optional<Client> client) {
    switch (command.verb) {
        case Verb::status:
            return answer(client, status());
        case Verb::reset:
            return askEdit(sand::Edit::reset, client);
        case Verb::undo:
            return askEdit(sand::Edit::undo, client);
        case Verb::settle:
            return askEdit(sand::Edit::settle, client);
        case Verb::tool:
            return askMaterial(scene::withTool(material_, command.tool, grid_), client);
        case Verb::material:
            return askMaterial(scene::withNumber(material_, command.word, command.number, grid_), client);
        case Verb::save:
            return save(command.word, client);
        case Verb::load:
            return load(command.word, client);
        case Verb::capture:
            captures_.push_back(client);
            return;  // answered when the pictures are there
        case Verb::pause:
        case Verb::resume:
            paused_ = command.verb == Verb::pause;
            break;
        case Verb::pattern:
            views_.show(command.pattern.value_or(lockstep::nextPattern(views_.pattern())));
            break;
        case Verb::show:
        case Verb::hide:
            views_.show(command.layer, command.verb == Verb::show);
            break;
        case Verb::eyeSeparation:
            views_.separateEyes(command.number);
            break;
        case Verb::force:
            liveSteps_.shareForce(command.number);
            break;
        case Verb::stereo:
            changeStereo(command.stereo);
            break;
        case Verb::stop:
            operator_.stop();
            break;
    }
    if (client) {
        control_->answer(*client, done());
    }
}

void Session::askEdit(sand::Edit edit, std::optional<Client> client, const std::optional<scene::Material>& material) {
    const auto loads = [](const Asker& asker) { return asker.edit.kind == sand::Edit::load; };
    if (edit.kind == sand::Edit::load && std::any_of(askers_.begin(), askers_.end(), loads)) {
        throw base::InputError("another load waits for its step already");  // each holds the whole sand
    }
    if (edit.kind == sand::Edit::undo && !terrain_.canUndo()) {
        throw base::InputError("there is no stroke to undo");
    }
    if (askers_.size() >= kMostEditsWaiting) {
        throw base::InputError(fmt::format("{} edits wait for their steps already", askers_.size()));
    }
    // Whoever asks must not be kept waiting for somebody to clear the disk, nor find it done long after.
    if (!mayTakeSteps(edit)) {
        throw base::InputError(
            "the sand stands still: no room for the journal on the disk; nothing was done, ask again when there is");
    }
    if (paused_ && client) {
        control_->answer(*client, line({{"ok", true}, {"waits_for", "resume"}}));
        client.reset();
    }
    liveSteps_.request(edit);
    askers_.push_back({std::move(edit), client, material});
}

void Session::tellWhoWaitsForRoom() {
    for (Asker& asker : askers_) {
        if (asker.client) {
            control_->answer(*asker.client, line({{"ok", true}, {"waits_for", "room"}}));
            asker.client.reset();
        }
    }
}

void Session::askMaterial(const scene::Material& material, std::optional<Client> client) {
    askEdit(sand::Edit::tuned(scene::tuningOf(material, grid_)), client, material);
    material_ = material;
}

void Session::changeStereo(walls::Stereo stereo) {
    shown_ = walls::shownOnItsOutputs(wall_, stereo);
    views_.show(stereo);
}

void Session::answer(std::optional<Client> client, const std::string& json) {
    if (client) {
        control_->answer(*client, json);
    } else {
        fmt::print("{}\n", json);
        std::fflush(stdout);
    }
}

void Session::answerEdits(const std::vector<haptic_bridge::TimedStep>& steps) {
    for (const haptic_bridge::TimedStep& timed : steps) {
        if (!timed.step.edit.any() || askers_.empty() || !(askers_.front().edit == timed.step.edit)) {
            continue;
        }
        if (askers_.front().client) {
            control_->answer(*askers_.front().client, line({{"ok", true}, {"step", timed.step.number}}));
        }
        askers_.pop_front();
    }
}

bool Session::capturing() const {
    return std::any_of(errands_.begin(), errands_.end(), [](const Errand& errand) { return errand.capture; });
}

void Session::takeCapture() {
    const std::filesystem::path folder = newCaptureFolder(options_.out);
    const std::string said = line({{"ok", true},
                                   {"folder", folder.filename().string()},
                                   {"frame", frame_},
                                   {"step", terrain_.stepNumber()},
                                   {"state_hash", fmt::format("{:016x}", hash_)}});
    const Clients clients = std::exchange(captures_, {});
    if (mayBeHeld(shown_)) {
        // Received with the frame; compressed and written, which takes longer, beside the next ones.
        auto held = std::make_shared<const HeldPictures>(holdWallPictures(cluster_, shown_, barrier_.watchdog()));
        startErrand(
            [held = std::move(held), folder, said] {
                writeHeldPictures(*held, folder);
                return ErrandDone{said, {}};
            },
            clients, true);
        return;
    }
    try {
        writeWallPictures(cluster_, shown_, folder, barrier_.watchdog());
    } catch (const base::InputError& error) {
        return refuse(error.what(), clients);
    }
    answerAll(clients, said);
}

std::string Session::status() const {
    return line({{"ok", true},
                 {"frame", frame_},
                 {"step", terrain_.stepNumber()},
                 {"fps", fps_},
                 {"ranks", wall_.ranks()},
                 {"slowest", slowestRank(rankStatistics_.recentDrag(), names_)},
                 {"linked", liveSteps_.linked()},
                 {"streaming", liveSteps_.streaming()},
                 {"paused", paused_},
                 {"pattern", std::string(lockstep::patternName(views_.pattern()))},
                 {"stereo", std::string(walls::stereoName(shown_.stereo))},
                 {"eye_separation", views_.eyeSeparation()},
                 {"tool_radius", terrain_.toolRadius()},
                 {"tool_shape", std::string(sand::toolName(terrain_.toolShape().kind))},
                 {"tool_heading", sand::degreesOf(terrain_.heading())},
                 {"material", materialNow(material_)},
                 {"state_hash", fmt::format("{:016x}", hash_)},
                 {"divergences", summary_.divergences},
                 {"healed", summary_.healed},
                 {"server_divergences", summary_.serverDivergences},
                 {"edits", summary_.edits},
                 {"edits_waiting", askers_.size()},
                 {"can_undo", terrain_.canUndo()},
                 {"journal", journal_ && journal_->written()},
                 {"journal_policy", std::string(journalPolicyName(options_.journal.policy))},
                 {"journal_state", std::string(journal_ ? journal_->state() : "off")}});
}

}  // namespace master
