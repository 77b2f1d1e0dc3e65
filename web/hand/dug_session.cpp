// SPDX-License-Identifier: Apache-2.0
#include "web/hand/dug_session.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>

#include "base/input_error.hpp"

namespace web {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]

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
      hand_(scene_.rules.stepsPerSecond, replica_),
      budget_(haptic_bridge::Pace::fast, kSecond / scene_.rules.stepsPerSecond),
      journal_(scene_, session, "web page", release),
      depth_(haptic_bridge::PointerHand::kUsualDepth) {}

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
    ask(sand::Edit::tuned(scene::tuningOf(material, grid_)), material);
    material_ = material;
}

void DugSession::ask(sand::Edit edit, std::optional<scene::Material> material) {
    if (edit.kind == sand::Edit::undo && !replica_.canUndo()) {
        throw base::InputError("nothing to undo");
    }
    if (asked_.size() >= kMostEdits) {
        throw base::InputError(fmt::format("{} edits wait for their steps already", asked_.size()));
    }
    edit.number = ++lastEdit_;
    asked_.push_back({std::move(edit), material});
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
    }
    step.sweeps = budget_.sweepsOf(step, replica_);
    return step;
}

void DugSession::write(const sand::Step& step) {
    if (step.edit.any() && asked_.front().material) {
        journal_.add(*asked_.front().material);
    }
    journal_.add(journal::JournalFrame{step.number, replica_.stateHash(), {step}});
}

bool DugSession::advance() {
    const sand::Step step = nextStep();
    write(step);
    if (step.edit.any()) {
        asked_.pop_front();
    }
    const bool rested = replica_.settled(), engaged = replica_.engaged();
    replica_.apply(step);
    return !step.path.empty() || step.edit.any() || engaged != replica_.engaged() || !rested || !replica_.settled();
}

bool DugSession::settlesNext() const {
    return !asked_.empty() && asked_.front().edit.kind == sand::Edit::settle && !replica_.engaged() &&
           !replica_.surface().settlesBySweeps();
}

base::Bytes DugSession::journal() { return journal_.endedAt({replica_.stepNumber(), replica_.stateHash()}); }

}  // namespace web
