// SPDX-License-Identifier: Apache-2.0
#include "journal/journal.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/input_error.hpp"
#include "scene/model/scene.hpp"

namespace journal {
namespace {

struct Gather {
    Journal& journal;
    void operator()(JournalFrame& frame) const { journal.frames.push_back(std::move(frame)); }
    void operator()(const JournalEnd& end) const { journal.end = end; }
    void operator()(JournalTicks& ticks) const { journal.ticks.push_back(std::move(ticks.piece)); }
    void operator()(JournalResumed& resumed) const {
        journal.end.reset();
        dropUnusedMaterial();
        journal.resumes.push_back(std::move(resumed));
    }
    void operator()(const scene::Material& material) const {
        journal.materials.push_back({journal.frames.size(), material});
    }
    void operator()(const JournalContinued&) const {}
    void operator()(const JournalDoubt&) const {}
    void operator()(const JournalChecked&) const {}
    void operator()(const JournalForce&) const {}
    /// A crash may have cut off the steps that set the last material.
    void dropUnusedMaterial() const {
        if (!journal.materials.empty() && journal.materials.back().frame == journal.frames.size()) {
            journal.materials.pop_back();
        }
    }
};

/// Returns the result of `decode` for the scene in the header. Errors name the journal.
template <class Decode>
auto decoded(const JournalReader& reader, Decode decode) {
    try {
        return decode(reader.header().scene);
    } catch (const base::FormatError& error) {
        throw base::InputError(fmt::format("{}: {}", reader.place().journal, error.what()));
    }
}

}  // namespace

scene::Scene sceneOf(const JournalReader& reader, scene::Scene::Keep keep) {
    return decoded(reader, [keep](std::span<const std::uint8_t> bytes) { return scene::Scene::decode(bytes, keep); });
}

sand::Rules rulesOf(const JournalReader& reader) { return decoded(reader, scene::Scene::decodeRules); }

Journal readAll(JournalReader& reader) {
    Journal journal;
    journal.scene = sceneOf(reader);
    journal.scene.material = reader.header().material.value_or(scene::Material());
    journal.buildId = reader.header().buildId;
    while (auto record = reader.next()) {
        std::visit(Gather{journal}, *record);
    }
    Gather{journal}.dropUnusedMaterial();
    journal.tornBytes = reader.tornBytes();
    return journal;
}

}  // namespace journal
