// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/path_builder.hpp"

#include <algorithm>
#include <utility>

namespace haptic_bridge {

void thin(std::vector<sand::ProbePoint>& path, std::size_t most) {
    if (path.size() <= most) {
        return;
    }
    for (std::size_t i = 0; i < most; ++i) {
        path[i] = path[i * (path.size() - 1) / (most - 1)];  // the source index is never smaller than i
    }
    path.resize(most);
}

void PathBuilder::add(const HandSample& sample) {
    waiting_.push_back(sample);
    if (waiting_.size() > kMaxWaiting) {
        thinWaiting();
    }
}

void PathBuilder::thinWaiting() {
    std::deque<HandSample> kept;
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
        // The last sample before a change of engagement is kept, because a stroke ends there.
        const bool ends = i + 1 == waiting_.size() || waiting_[i + 1].engaged != waiting_[i].engaged;
        if (i % 2 == 0 || ends) {
            kept.push_back(waiting_[i]);
        }
    }
    // A hand that taps at every sample cannot be thinned out. Its oldest samples are dropped.
    if (kept.size() > kMaxWaiting) {
        kept.erase(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(kMaxWaiting / 2));
    }
    dropped_ += waiting_.size() - kept.size();
    waiting_ = std::move(kept);
}

void PathBuilder::letGoIfFarAhead() {
    if (waitingNs() <= kFarthestAhead) {
        return;
    }
    const std::size_t all = waiting_.size();
    while (waitingNs() >= mostNs_) {
        waiting_.pop_front();
    }
    dropped_ += all - waiting_.size();
    const HandSample now = waiting_.front();
    if (engaged_ && now.engaged) {  // avoids a furrow from the tool's last place to the hand
        waiting_.push_front({now.readNs, now.probe, false});
    }
}

std::optional<std::int64_t> PathBuilder::engagedSinceNs() const {
    const auto first = std::find_if(waiting_.begin(), waiting_.end(), [this](const HandSample& sample) {
        return sample.engaged && (!engaged_ || sample.probe != last_);
    });
    return first == waiting_.end() ? std::nullopt : std::optional(first->readNs);
}

bool PathBuilder::moves() const {
    return std::any_of(waiting_.begin(), waiting_.end(), [this](const HandSample& sample) {
        return sample.engaged != engaged_ || sample.probe != last_ || sample.heading;
    });
}

sand::ProbePoint PathBuilder::approach(const sand::ProbePoint& goal, const SubstepLimit& limit) {
    const std::int64_t all = sand::substepsBetween(last_, goal, limit.length);
    const auto part = [&](std::int32_t from, std::int32_t to) {
        return static_cast<std::int32_t>(from + (std::int64_t{to} - from) * limit.most / all);
    };
    last_ = {part(last_.x, goal.x), part(last_.y, goal.y), part(last_.z, goal.z)};
    return last_;
}

std::int64_t PathBuilder::take(sand::Step& step, const SubstepLimit& limit) {
    step.engaged = engaged_ && !limit.onlyHovering;
    if (waiting_.empty() || (limit.onlyHovering && waiting_.front().engaged)) {
        return 0;
    }
    if (waiting_.front().engaged) {
        letGoIfFarAhead();
    }
    std::vector<sand::ProbePoint>& path = step.path;
    path.clear();
    std::int64_t readNs = 0;
    const std::int64_t until = waiting_.front().engaged ? waiting_.front().readNs + mostNs_ : INT64_MAX;
    const bool changed = waiting_.front().engaged != engaged_;
    engaged_ = waiting_.front().engaged;
    step.engaged = engaged_;
    const sand::ProbePoint from = last_;
    while (!waiting_.empty() && waiting_.front().engaged == engaged_ && waiting_.front().readNs < until) {
        const HandSample sample = waiting_.front();
        if (engaged_ && sample.probe != last_) {
            path.push_back(sample.probe);
            const std::int64_t substeps = sand::substepsOf(step, from, !changed, limit.length);
            path.pop_back();
            if (path.empty() && substeps > limit.most) {
                path.push_back(approach(sample.probe, limit));  // the sample waits for the next step
                break;
            }
            if (!path.empty() && substeps > std::min(limit.wanted, limit.most)) {
                break;
            }
        }
        waiting_.pop_front();
        readNs = sample.read ? sample.readNs : readNs;
        step.heading = sample.heading ? sample.heading : step.heading;
        // A hand that engages where it hovers must press there, although it has not moved.
        if (sample.probe != last_ || (changed && path.empty())) {
            path.push_back(sample.probe);
            last_ = sample.probe;
        }
    }
    step.engaged = engaged_;
    const std::size_t all = path.size();
    thin(path, sand::kMaxPathPoints);
    dropped_ += engaged_ ? all - path.size() : 0;
    return readNs;
}

void PathBuilder::restart(sand::ProbePoint probe) {
    waiting_.clear();
    last_ = probe;
    engaged_ = false;
}

void PathBuilder::dropWaiting() {
    dropped_ += waiting_.size();
    waiting_.clear();
}

}  // namespace haptic_bridge
