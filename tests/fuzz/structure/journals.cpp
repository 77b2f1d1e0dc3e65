// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/structure/journals.hpp"

#include <utility>

#include "tests/fuzz/structure/states.hpp"
#include "tests/journal/journal_in_memory.hpp"

namespace structure {
namespace {

using journal::JournalFrame;
using journal::JournalRecord;
using sand::Edit;
using sand::Step;

/// Changes one number of a step, so that its work stays small nearly always.
void change(Step& step, const Session& session, Chance& chance) {
    switch (chance.below(11)) {
        case 0:
            step.number = chance.oneIn(2) ? step.number + 1 : static_cast<std::uint64_t>(chance.wide());
            break;
        case 1:
            step.epoch = static_cast<std::uint32_t>(chance.odd());
            break;
        case 2:
            step.sweeps = chance.oneIn(4) ? chance.odd() : static_cast<std::int32_t>(chance.below(60));
            break;
        case 3:
            step.engaged = !step.engaged;
            break;
        case 4:
            step.path.push_back({static_cast<int>(chance.below(4000)) - 500, static_cast<int>(chance.below(4000)) - 500,
                                 chance.odd() % 2000});
            break;
        case 5:  // seldom, because a step within the limits may take long
            if (!step.path.empty() && chance.oneIn(8)) {
                chance.of(step.path) = {chance.odd(), chance.odd(), chance.odd()};
            }
            break;
        case 6:
            step.heading = sand::Heading{static_cast<std::int16_t>(chance.odd()), 0, chance.oneIn(2)};
            break;
        case 7:
            step.edit = static_cast<Edit::Kind>(chance.below(sand::kEdits + 1U));
            step.edit.number = chance.below(40);
            break;
        case 8:
            step.edit = Edit::loaded(changedSand(chance.of(session.states), chance));
            step.edit.number = chance.below(40);
            break;
        default:
            step.edit = Edit::tuned(session.scene.rules.tuning);
            step.edit.number = chance.below(40);
            structure::change(step.edit.tuning, chance);
    }
}

JournalRecord otherRecord(Chance& chance) {
    const journal::JournalEnd sand{chance.below(30), static_cast<std::uint64_t>(chance.wide())};
    switch (chance.below(6)) {
        case 0:
            return sand;
        case 1:
            return journal::JournalTicks{base::Bytes(chance.below(40), static_cast<std::uint8_t>(chance.below(256)))};
        case 2:
            return journal::JournalResumed{chance.below(30), sand, chance.wide(), "a kill"};
        case 3:
            return journal::JournalDoubt{chance.below(30), sand};
        case 4:
            return journal::JournalChecked{chance.below(30), sand, chance.oneIn(2)};
        default:
            return journal::JournalForce{static_cast<double>(chance.below(5)) / 3};
    }
}

/// Returns the records of the session: a frame for one or two steps.
std::vector<JournalRecord> recordsOf(const Session& session, Chance& chance) {
    std::vector<JournalRecord> records;
    std::uint64_t edits = 0;
    for (std::size_t i = 0; i < session.steps.size();) {
        JournalFrame frame{records.size() + 1, 0, {}};
        for (std::size_t count = 1 + chance.below(2); count > 0 && i < session.steps.size(); --count) {
            frame.steps.push_back(session.steps[i++]);
            edits += frame.steps.back().edit.any() ? 1 : 0;
            frame.steps.back().edit.number = frame.steps.back().edit.any() ? edits : 0;
        }
        records.emplace_back(std::move(frame));
    }
    return records;
}

/// Changes the header's scene: a number of the rules, or a height.
void change(scene::Scene& scene, Chance& chance) {
    if (scene.tin == nullptr && chance.oneIn(2)) {
        scene.terrain.setHeight(static_cast<int>(chance.below(static_cast<std::size_t>(scene.terrain.columns()))), 0,
                                chance.odd());
    } else if (chance.oneIn(2)) {
        scene.rules.rim = scene.rules.rim == sand::Rim::open ? sand::Rim::closed : sand::Rim::open;
    } else {
        structure::change(scene.rules.tuning, chance);
    }
}

}  // namespace

std::vector<base::Bytes> changedJournal(const Session& session, Chance& chance) {
    std::vector<JournalRecord> records = recordsOf(session, chance);
    for (std::size_t changes = 1 + chance.below(4); changes > 0; --changes) {
        const std::size_t at = chance.below(records.size());
        const auto place = records.begin() + static_cast<std::ptrdiff_t>(at);
        auto* const frame = std::get_if<JournalFrame>(&*place);
        switch (chance.below(10)) {
            case 0:
                records.erase(place);
                break;
            case 1:
                records.insert(place, otherRecord(chance));
                break;
            case 2:
                std::swap(*place, chance.of(records));
                break;
            default:
                if (frame != nullptr && !frame->steps.empty()) {
                    change(chance.of(frame->steps), session, chance);
                }
        }
        if (records.empty()) {
            break;
        }
    }
    scene::Scene scene = session.scene;
    if (chance.oneIn(6)) {
        change(scene, chance);
    }
    test::JournalInMemory written(scene);
    for (const JournalRecord& record : records) {
        if (chance.oneIn(40)) {
            written.beginPart({chance.below(30), 7});
        }
        written.add(record);
    }
    return written.parts();
}

}  // namespace structure
