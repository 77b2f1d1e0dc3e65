// SPDX-License-Identifier: Apache-2.0
#include "web/replica/page_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/input_error.hpp"
#include "web/replica/opening.hpp"

namespace web {

PageSession::PageSession(std::string name, std::vector<base::Bytes> parts, std::string_view release,
                         std::int64_t memory)
    : name_(std::move(name)) {
    journal::JournalReader reader = openedJournal(name_, std::move(parts), release, memory);
    scene_ = sceneWithMaterial(reader);
    humidity_.emplace(0, scene_.material.humidity);
    read(reader);
    verification_.emplace(name_, sand::Replica(scene_));
}

void PageSession::read(journal::JournalReader& reader) {
    bool ended = false;
    try {
        while (auto record = reader.next()) {
            ended = std::holds_alternative<journal::JournalEnd>(*record);
            note(*record);
        }
        if (reader.tornBytes() > 0) {
            shortcoming_ =
                fmt::format("The last {} bytes are an incomplete write and were left out", reader.tornBytes());
        } else if (!ended) {
            shortcoming_ = "It has no orderly end: the session was cut off, or still runs";
        }
    } catch (const base::InputError& error) {
        shortcoming_ = error.what();
    }
}

void PageSession::note(journal::JournalRecord& record) {
    if (auto* const ticks = std::get_if<journal::JournalTicks>(&record)) {
        ticks->piece = {};  // a page shows no forces
    }
    records_.push_back(std::move(record));
    const journal::JournalRecord& kept = records_.back();
    if (const auto* const frame = std::get_if<journal::JournalFrame>(&kept)) {
        noteSteps(*frame);
    } else if (const auto* const material = std::get_if<scene::Material>(&kept)) {
        humidity_.insert_or_assign(lastStep_ + 1, material->humidity);
    } else if (std::holds_alternative<journal::JournalResumed>(kept)) {
        ++hashes_;
        marks_.push_back({lastStep_, "resumed"});
    } else if (std::holds_alternative<journal::JournalEnd>(kept) ||
               std::holds_alternative<journal::JournalChecked>(kept)) {
        ++hashes_;
    }
}

void PageSession::noteSteps(const journal::JournalFrame& frame) {
    hashes_ += frame.doubted ? 0 : 1;
    if (frame.steps.empty()) {
        return;
    }
    frames_.push_back({frame.steps.front().number, records_.size() - 1});
    for (const sand::Step& step : frame.steps) {
        if (step.engaged && !engaged_) {
            marks_.push_back({step.number, "stroke"});
        }
        engaged_ = step.engaged;
        if (step.edit.kind != sand::Edit::none) {
            marks_.push_back({step.number, base::nameOf(step.edit.kind)});
        }
        lastStep_ = step.number;
    }
}

double PageSession::humidity() const { return std::prev(humidity_.upper_bound(replica().stepNumber()))->second; }

bool PageSession::advance() {
    if (passed()) {
        return false;
    }
    verification_->take(records_[next_++]);
    return true;
}

std::uint64_t PageSession::matches() const { return counts().hashes - mismatches(); }

std::uint64_t PageSession::mismatches() const { return counts().differing + differedAgain_.size(); }

bool PageSession::stepOn() {
    const std::uint64_t step = replica().stepNumber() + 1;
    const auto after =
        std::upper_bound(frames_.begin(), frames_.end(), step,
                         [](std::uint64_t number, const FirstStep& frame) { return number < frame.step; });
    if (step > lastStep_ || after == frames_.begin()) {
        return false;
    }
    const auto& frame = std::get<journal::JournalFrame>(records_[std::prev(after)->record]);
    const std::uint64_t first = frame.steps.front().number;
    if (step == first && !frame.doubted) {
        compareAgain(frame.hashBefore);
    }
    replica().apply(frame.steps.at(static_cast<std::size_t>(step - first)));
    if (counts().end && counts().end->step == step) {
        compareAgain(counts().end->hash);
    }
    return true;
}

void PageSession::compareAgain(std::uint64_t hash) {
    const std::uint64_t step = replica().stepNumber();
    const bool known = std::find(differedAgain_.begin(), differedAgain_.end(), step) != differedAgain_.end();
    if (replica().stateHash() != hash && counts().differing == 0 && !known) {
        differedAgain_.push_back(step);
    }
}

}  // namespace web
