// SPDX-License-Identifier: Apache-2.0
#include "web/hand/dug_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>

#include "base/input_error.hpp"
#include "web/replica/opening.hpp"

namespace web {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]

/// Error for a journal whose records are whole and which no hand can continue with.
class Foreign : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Returns the warnings about a scene in one line.
std::string inOneLine(const std::vector<std::string>& warnings) {
    std::string line;
    for (const std::string& warning : warnings) {
        line += (line.empty() ? "" : " ") + warning + ".";
    }
    return line;
}

}  // namespace

DugSession::DugSession(scene::Scene scene, std::uint64_t session, std::string_view release)
    : scene_(std::move(scene)),
      grid_(scene_.grid()),
      material_(scene_.material),
      shortcoming_(inOneLine(scene_.warnings)),
      replica_(scene_),
      history_(replica_, material_, kMostHistoryBytes),
      hand_(scene_.rules.stepsPerSecond, replica_),
      budget_(haptic_bridge::Pace::fast, kSecond / scene_.rules.stepsPerSecond),
      journal_(scene_, session, "web page", release),
      depth_(haptic_bridge::PointerHand::kUsualDepth) {}

DugSession::DugSession(journal::JournalReader reader, std::string_view release)
    : DugSession(sceneWithMaterial(reader), reader.header().session, release) {
    returning_.emplace(Returning{std::move(reader), {}, {}});
}

void DugSession::returnFrom(const journal::JournalEnd& sand, base::Bytes state) {
    returning_->from = sand;
    returning_->state = std::move(state);
}

bool DugSession::returnOn() {
    try {
        if (const auto record = returning_->reader.next()) {
            take(*record);
            return true;
        }
        if (const std::int64_t torn = returning_->reader.tornBytes(); torn > 0) {
            shortcoming_ = fmt::format("The last {} bytes are an incomplete write and were left out", torn);
        }
    } catch (const base::InputError& error) {
        if (returning_->steps == 0) {
            throw;
        }
        shortcoming_ = error.what();
    }
    endReturn();
    return false;
}

void DugSession::take(const journal::JournalRecord& record) {
    if (const auto* const frame = std::get_if<journal::JournalFrame>(&record)) {
        take(*frame);
    } else if (const auto* const material = std::get_if<scene::Material>(&record)) {
        material_ = *material;
        journal_.add(record);
    } else if (!std::holds_alternative<journal::JournalEnd>(record)) {
        throw Foreign(returning_->reader.place().journal + ": is a session of a wall; a page only shows it");
    }
}

void DugSession::take(const journal::JournalFrame& frame) {
    const std::uint64_t from = returning_->from.step;
    if (frame.steps.empty() || frame.steps.front().number > from) {
        requireHash(frame.hashBefore);
    }
    for (const sand::Step& step : frame.steps) {
        if (step.number > from) {
            replica_.apply(step);
        } else if (step.number == from) {
            replica_.decodeState(returning_->state);
            requireHash(returning_->from.hash);
        }
        count(step);
        returning_->steps = step.number;
    }
    journal_.add(frame);
}

void DugSession::requireHash(std::uint64_t hash) {
    if (replica_.stateHash() != hash) {
        throw Foreign(fmt::format("{}: its sand of step {} cannot be computed again",
                                  returning_->reader.place().journal, replica_.stepNumber()));
    }
}

void DugSession::endReturn() {
    if (replica_.stepNumber() != returning_->steps) {
        throw Foreign(fmt::format("{}: ends at step {}, before its kept state of step {}",
                                  returning_->reader.place().journal, returning_->steps, returning_->from.step));
    }
    returning_.reset();
    history_ = scene::UndoHistory(replica_, material_, kMostHistoryBytes);  // knows the last stroke alone
    hand_.begin(replica_);
}

void DugSession::point(std::int64_t readNs, const haptic_bridge::Ray& sight, bool pressed) {
    if (pressed && !pressed_) {
        ++touches_;
        touched_.forget();
    }
    pressed_ = pressed;
    if (reports_.empty() || reports_.back().count == haptic_bridge::PointerReport::kMostSamples) {
        reports_.emplace_back();
    }
    const sand::HeightSpan units = replica_.surface().heights();
    haptic_bridge::PointerReport& report = reports_.back();
    haptic_bridge::PointerSample& sample = report.samples[report.count++];
    sample = touched_.sample(sight, pressed, replica_,
                             {units.lowest / sand::kUnitsPerCell, units.highest / sand::kUnitsPerCell});
    sample.readNs = readNs;
    report.pressed = pressed ? 1 : 0;
    report.touch = touches_;
    if (!pressed) {
        touched_.forget();
    }
}

void DugSession::setDepth(double depth) {
    using haptic_bridge::PointerHand;
    if (!(depth >= PointerHand::kShallowest && depth <= PointerHand::kDeepest)) {
        throw base::InputError(fmt::format("the depth must be within [{}, {}] radii of the tool, got {}",
                                           PointerHand::kShallowest, PointerHand::kDeepest, depth));
    }
    depth_ = depth;
}

void DugSession::ask(const scene::Material& material) {
    if (std::any_of(asked_.begin(), asked_.end(), [](const Asked& asked) { return asked.returns.has_value(); })) {
        throw base::InputError("an undo or a redo waits for its step; try again then");  // it may change the material
    }
    ask(sand::Edit::tuned(scene::tuningOf(material, grid_)), material);
    material_ = material;
}

void DugSession::ask(sand::Edit edit) {
    if (edit.kind == sand::Edit::undo) {
        askReturn(scene::UndoHistory::Move::undo);
    } else {
        ask(std::move(edit), std::nullopt);
    }
}

void DugSession::ask(sand::Edit edit, std::optional<scene::Material> material) {
    requireRoom();
    asked_.push_back({std::move(edit), material});
}

void DugSession::requireRoom() const {
    if (asked_.size() >= kMostEdits) {
        throw base::InputError(fmt::format("{} edits wait for their steps already", asked_.size()));
    }
}

void DugSession::askReturn(scene::UndoHistory::Move move) {
    const bool undoes = move == scene::UndoHistory::Move::undo;
    if (asked_.empty() && !(undoes ? canUndo() : canRedo())) {
        throw base::InputError(undoes ? "nothing to undo" : "nothing to redo");
    }
    requireRoom();
    asked_.push_back({.returns = move});
}

void DugSession::beginReturn() {
    while (!asked_.empty() && asked_.front().returns) {
        const std::optional<scene::UndoHistory::Return> wanted =
            history_.beginReturn(replica_, *asked_.front().returns);
        asked_.pop_front();
        if (!wanted) {
            continue;  // an edit before it has ended what there was to redo
        }
        sand::Edit edit = wanted->how.edit;
        if (wanted->how.sand != nullptr) {
            while (!wanted->how.sand->complete() && replica_.continueCopy(std::int64_t{1} << 20)) {
            }
            edit = sand::Edit::loaded(wanted->how.sand->encode());
        }
        asked_.push_front({std::move(edit), std::nullopt, wanted->how.intent, std::nullopt});
        if (const scene::Material material = scene::withToolOf(wanted->material, material_); material != material_) {
            asked_.push_front(
                {sand::Edit::tuned(scene::tuningOf(material, grid_)), material, wanted->how.intent, std::nullopt});
            material_ = material;
        }
    }
}

void DugSession::takePointer() {
    // A wall takes one report in each frame, of at most six places. A page may have read more.
    for (const haptic_bridge::PointerReport& report : reports_) {
        hand_.take(std::span(&report, 1), depth_, replica_);
    }
    if (reports_.empty()) {  // a tool that hovers may have another size now
        haptic_bridge::PointerReport still;
        still.pressed = pressed_ ? 1 : 0;
        still.touch = touches_;
        hand_.take(std::span(&still, 1), depth_, replica_);
    }
    reports_.clear();
}

sand::Step DugSession::nextStep() {
    takePointer();
    sand::Step step{.epoch = 1, .number = replica_.stepNumber() + 1};
    if (replica_.holdsTool()) {
        step.engaged = replica_.engaged();
    } else {
        (void)hand_.fill(step, budget_.substeps(replica_));
    }
    if (!asked_.empty()) {
        step.edit = asked_.front().edit;
        step.edit.number = ++lastEdit_;
    }
    step.sweeps = budget_.sweepsOf(step, replica_);
    return step;
}

void DugSession::count(const sand::Step& step) {
    const bool edited = step.edit.any();
    touchedSteps_ += step.engaged || edited ? 1 : 0;
    dug_ = dug_ || step.engaged || (edited && step.edit.kind != sand::Edit::tune);
    lastEdit_ = std::max(lastEdit_, step.edit.number);
}

void DugSession::write(const sand::Step& step) {
    if (step.edit.any() && asked_.front().material) {
        journal_.add(*asked_.front().material);
    }
    journal_.add(journal::JournalFrame{step.number, replica_.stateHash(), {step}});
}

bool DugSession::advance() {
    beginReturn();
    const sand::Step step = nextStep();
    write(step);
    count(step);
    Asked asked;
    if (step.edit.any()) {
        asked = std::move(asked_.front());
        asked_.pop_front();
    }
    const bool rested = replica_.settled(), engaged = replica_.engaged();
    history_.begin(replica_, step, asked.intent, asked.material);
    replica_.apply(step);
    history_.end(replica_);
    return !step.path.empty() || step.edit.any() || engaged != replica_.engaged() || !rested || !replica_.settled();
}

bool DugSession::settlesNext() const {
    return !asked_.empty() && asked_.front().edit.kind == sand::Edit::settle && !replica_.engaged() &&
           !replica_.surface().settlesBySweeps();
}

base::Bytes DugSession::journal() { return journal_.endedAt({replica_.stepNumber(), replica_.stateHash()}); }

}  // namespace web
