// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "haptic_bridge/hand/pointer_hand.hpp"
#include "haptic_bridge/hand/sweep_budget.hpp"
#include "haptic_bridge/hand/touched_sand.hpp"
#include "journal/memory_writer.hpp"
#include "journal/reader.hpp"
#include "scene/model/undo_history.hpp"
#include "web/replica/step_source.hpp"

namespace web {

/// Sand in which the hand of a page digs. The steps are those of a session whose hand is a pointer, at the fast pace. A
/// step runs at most 64 sweeps, and the steps after it pay the rest. Each step is written to a journal before it is
/// applied. Used by one thread.
class DugSession : public StepSource {
public:
    static constexpr std::size_t kMostEdits = 16;  // that wait for their steps

    /// Begins on the sand of `scene`. `session` is a random number for the journal, and `release` is this program's.
    DugSession(scene::Scene scene, std::uint64_t session, std::string_view release);
    /// Begins to continue with a journal that a page has written. returnOn() computes its steps before any other step.
    DugSession(journal::JournalReader reader, std::string_view release);

    [[nodiscard]] const scene::Scene& scene() const override { return scene_; }
    [[nodiscard]] sand::Replica& replica() override { return replica_; }
    [[nodiscard]] double humidity() const override { return material_.humidity; }
    [[nodiscard]] const std::string& shortcoming() const override { return shortcoming_; }

    /// Takes a reading of the pointer at `readNs` [ns, any monotonic clock]. `sight` goes from the eye through the
    /// pointer [cell].
    void point(std::int64_t readNs, const haptic_bridge::Ray& sight, bool pressed);
    /// Sets how far the underside of the pressed tool is below the sand's surface. Throws base::InputError beyond
    /// PointerHand's limits.
    void setDepth(double depth /* [tool radius] */);
    /// Asks for an undo, a reset or a settle. Throws base::InputError if there is nothing to undo, or if too many edits
    /// wait. An undo takes back the newest stroke or edit, as an operator's does (docs/operator.md).
    void ask(sand::Edit edit);
    /// Asks for a redo. Throws base::InputError as ask() does.
    void redo() { askReturn(scene::UndoHistory::Move::redo); }
    [[nodiscard]] bool canUndo() const { return history_.entries().undosLeft() > 0; }
    [[nodiscard]] bool canRedo() const { return history_.entries().redosLeft() > 0; }
    /// Changes the material, or the tool, as an operator's command does. Throws base::InputError.
    void setNumber(std::string_view word, double value) { ask(scene::withNumber(material_, word, value, grid_)); }
    void setTool(const scene::ToolChange& change) { ask(scene::withTool(material_, change, grid_)); }
    /// Returns the material with all changes that were asked for.
    [[nodiscard]] const scene::Material& material() const { return material_; }

    /// Takes the next record of the journal to continue with. Returns false behind the last whole one; the hand can dig
    /// then, and shortcoming() says what is missing. Throws base::InputError if the journal's sand is not this sand, or
    /// if no page has written it.
    bool returnOn();
    /// Puts `state`, which Replica::encodeState() wrote, in the place of all steps up to `sand`. Call it before
    /// returnOn(), which then throws base::InputError if the state is not that of `sand`.
    void returnFrom(const journal::JournalEnd& sand, base::Bytes state);

    /// Applies the next step, behind all records of returnOn(). Returns whether the picture may have changed.
    bool advance();
    /// Returns whether the next step brings all sand to rest at once, which takes long.
    [[nodiscard]] bool settlesNext() const;
    /// Returns the journal of all steps so far, with an orderly end.
    [[nodiscard]] base::Bytes journal();
    /// Returns the journal of all steps so far. Later steps add bytes at its end and change no others.
    [[nodiscard]] const base::Bytes& written() const { return journal_.bytes(); }

    /// Returns how many steps the hand or an edit has changed. All other steps follow from them.
    [[nodiscard]] std::uint64_t touched() const { return touchedSteps_; }
    /// Returns whether the hand, or an edit of the sand, has changed the scene's sand.
    [[nodiscard]] bool dug() const { return dug_; }
    /// Returns whether the next step changes nothing but its number.
    [[nodiscard]] bool rests() const {
        return !pressed_ && reports_.empty() && asked_.empty() && replica_.atRest() && !replica_.engaged();
    }

private:
    static constexpr std::int64_t kMostHistoryBytes = std::int64_t{64} << 20;  // a page has less memory than a wall

    struct Asked {
        sand::Edit edit{};
        std::optional<scene::Material> material{};          // after the edit; nullopt if unchanged
        scene::UndoHistory::Intent intent{};                // of the edit
        std::optional<scene::UndoHistory::Move> returns{};  // an undo or redo that has no edits yet
    };
    void askReturn(scene::UndoHistory::Move move);
    void requireRoom() const;
    /// Replaces the undo or redo at the front by the edits that make it.
    void beginReturn();
    void ask(const scene::Material& material);
    void ask(sand::Edit edit, std::optional<scene::Material> material);
    void takePointer();
    [[nodiscard]] sand::Step nextStep();
    void write(const sand::Step& step);
    void count(const sand::Step& step);
    /// Journal to continue with, while its steps are computed.
    struct Returning {
        journal::JournalReader reader;
        journal::JournalEnd from;  // at which `state` is; step 0 if there is none
        base::Bytes state;
        std::uint64_t steps = 0;  // that were taken
    };
    void take(const journal::JournalRecord& record);
    void take(const journal::JournalFrame& frame);
    void requireHash(std::uint64_t hash);
    void endReturn();

    scene::Scene scene_;
    scene::MaterialGrid grid_;
    scene::Material material_;
    std::string shortcoming_;
    sand::Replica replica_;
    scene::UndoHistory history_;
    haptic_bridge::PointerHand hand_;
    haptic_bridge::TouchedSand touched_;
    haptic_bridge::SweepBudget budget_;
    journal::MemoryWriter journal_;
    std::vector<haptic_bridge::PointerReport> reports_;  // since the step before
    bool pressed_ = false;
    std::uint32_t touches_ = 0;
    double depth_;
    std::deque<Asked> asked_;
    std::uint64_t lastEdit_ = 0;
    std::uint64_t touchedSteps_ = 0;
    bool dug_ = false;
    std::optional<Returning> returning_;
};

}  // namespace web
