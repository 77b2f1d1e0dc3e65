// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "master/operator/asker.hpp"
#include "master/operator/verb_arguments.hpp"
#include "sand/history.hpp"
#include "sand/model/step.hpp"

namespace master {

/// A client gets `ok` as soon as its command is carried out, or the desk answers it itself.
enum class Answered : std::uint8_t { atOnce, byDesk };

/// A command that `desk` carries out for `asker`.
template <class Desk>
struct Command {
    Desk& desk;
    std::string_view argument;
    const Asker& asker;
};

/// A verb of an operator's commands (docs/operator.md).
template <class Desk>
struct Verb {
    std::string_view name;
    std::string_view form;  // of its argument; empty without one
    Answered answered;
    void (*carryOut)(const Command<Desk>& command);  // throws base::InputError if the command is refused
};

/// Returns all verbs, in the order in which lists show them. `Desk` is OperatorDesk. Tests and the fuzzer have desks of
/// their own, which need no session.
template <class Desk>
constexpr auto verbsOf() {
    using enum Answered;
    using sand::Edit;
    using It = const Command<Desk>&;
    return std::to_array<Verb<Desk>>({
        {"status", "", byDesk, [](It it) { it.desk.reportStatus(it.asker); }},
        {"pause", "", atOnce, [](It it) { it.desk.pause(true); }},
        {"resume", "", atOnce, [](It it) { it.desk.pause(false); }},
        {"reset", "", byDesk, [](It it) { it.desk.askEdit(Edit::Kind::reset, it.asker); }},
        {"undo", "", byDesk, [](It it) { it.desk.askReturn(sand::History::Move::undo, it.asker); }},
        {"redo", "", byDesk, [](It it) { it.desk.askReturn(sand::History::Move::redo, it.asker); }},
        {"settle", "", byDesk, [](It it) { it.desk.askEdit(Edit::Kind::settle, it.asker); }},
        {"pattern", "NAME|none|next", atOnce, [](It it) { it.desk.showPattern(readPattern(it.argument)); }},
        {"show", "LAYER", atOnce, [](It it) { it.desk.showLayer(readLayer(it.argument), true); }},
        {"hide", "LAYER", atOnce, [](It it) { it.desk.showLayer(readLayer(it.argument), false); }},
        {"eye-separation", "METRES", atOnce, [](It it) { it.desk.separateEyes(readSeparation(it.argument)); }},
        {"stereo", "MODE", atOnce, [](It it) { it.desk.showStereo(readStereo(it.argument)); }},
        {"swap-eyes", "on|off", atOnce, [](It it) { it.desk.swapEyes(readSwapEyes(it.argument)); }},
        {"tool", "[SHAPE] [radius=R] [width=W] [heading=DEG] [foot=left|right]", byDesk,
         [](It it) { it.desk.changeTool(readTool(it.argument), it.asker); }},
        {"material", "KEY VALUE", byDesk, [](It it) { it.desk.changeMaterial(readMaterial(it.argument), it.asker); }},
        {"save", "NAME", byDesk, [](It it) { it.desk.save(readSaveName(it.argument), it.asker); }},
        {"load", "NAME", byDesk, [](It it) { it.desk.load(readSaveName(it.argument), it.asker); }},
        {"capture", "", byDesk, [](It it) { it.desk.capture(it.asker); }},
        {"film", "", byDesk, [](It it) { it.desk.markFilm(it.asker); }},
        {"force", "on|off|scale SHARE", byDesk, [](It it) { it.desk.shareForce(readShare(it.argument), it.asker); }},
        {"stop", "", atOnce, [](It it) { it.desk.stop(); }},
    });
}

/// Returns the verbs with their arguments, such as "show LAYER".
template <class Desk>
[[nodiscard]] std::vector<std::string> listedVerbs() {
    std::vector<std::string> listed;
    for (const Verb<Desk>& verb : verbsOf<Desk>()) {
        listed.push_back(std::string(verb.name) + (verb.form.empty() ? "" : " ") + std::string(verb.form));
    }
    return listed;
}

/// Carries out a command in a line of text, which may come from anybody. Returns who answers `asker`. Throws
/// base::InputError in one line if `line` is not valid or the command is refused; the text lists all verbs if the verb
/// is unknown.
template <class Desk>
Answered carryOut(Desk& desk, std::string_view line, const Asker& asker) {
    static constexpr auto kVerbs = verbsOf<Desk>();
    const auto verb = std::ranges::find(kVerbs, line.substr(0, line.find(' ')), &Verb<Desk>::name);
    if (verb == kVerbs.end()) {
        refuseVerb(line, listedVerbs<Desk>());
    }
    verb->carryOut({desk, argumentIn(line, verb->name, verb->form), asker});
    return verb->answered;
}

}  // namespace master
