// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "lockstep/fault.hpp"
#include "sand/replica.hpp"

namespace master {

/// realtime: at the wall's refresh rate. fast: as fast as it goes, in a time that is counted in frames.
enum class Pace : std::uint8_t { realtime, fast };

/// Takes requests of an operator that change the next steps.
class StepRequests {
public:
    virtual ~StepRequests() = default;
    /// Asks for an edit: it goes into a step that StepSource::next returns, after the edits that were asked for before.
    virtual void request(sand::Edit edit) = 0;
    /// Lets the hand feel this share of a server's forces from now on, 0 to 1; later servers are told, too.
    virtual void shareForce(double share) = 0;
};

/// Source of the steps of a session: LiveSteps or RecordedSteps. One thread.
class StepSource {
public:
    virtual ~StepSource() = default;

    /// Returns the steps of the next frame, numbered on from those of `sand`, whose state hash is `hash`. Returns at
    /// most `most` steps, or an empty list when nothing is due. Called once for each frame, and again only within
    /// patience().
    [[nodiscard]] virtual std::vector<haptic_bridge::TimedStep> next(const sand::Replica& sand, std::uint64_t hash,
                                                                     std::size_t most) = 0;
    /// Steps that one frame takes at most; a long catch-up is spread over frames.
    [[nodiscard]] virtual std::size_t mostPerFrame() const = 0;
    /// How long a frame should wait for a step before it is shown without one [s].
    [[nodiscard]] virtual double patience() const { return 0; }
    /// Returns null if the steps cannot be changed.
    [[nodiscard]] virtual StepRequests* requests() { return nullptr; }

    /// Tells that the master's sand has come to a new state, which the source may know the hash of.
    virtual void reached(sand::Replica& /* sand */) {}
    /// Tells the same after the master's own sand was wrong and was healed: what reached() found before is void.
    virtual void healed(sand::Replica& /* sand */) {}
    /// Returns whether the master's sand differs from what the source knows: the session ends.
    [[nodiscard]] virtual bool strayed() const { return false; }
    /// Returns the line that says how it strayed, once; empty before that.
    [[nodiscard]] virtual std::string takeStrayLine() { return {}; }

    /// Tells that the wall has swapped and shows the sand at this step.
    virtual void shown(std::uint64_t /* stepNumber */, std::int64_t /* frameIntervalNs */) {}
    /// Compares the wall's `hash` with the haptic server's after the last of `steps`, which the wall shows now. Returns
    /// false, and lets the server go, when its sand differs.
    [[nodiscard]] virtual bool proveServer(const std::vector<haptic_bridge::TimedStep>& /* steps */,
                                           std::uint64_t /* hash */) {
        return true;
    }
    /// Returns the pieces of the server's tick track that have come since the last call. The journal keeps them.
    [[nodiscard]] virtual std::vector<base::Bytes> ticks() { return {}; }
    /// Injects a fault into the link: garbage, or a partition. Waits until there is a link.
    virtual void drill(const lockstep::Fault& /* fault */) {}

    /// Whether a haptic server numbers the steps, and whether one without sand says where the hand is.
    [[nodiscard]] virtual bool linked() const { return false; }
    [[nodiscard]] virtual bool streaming() const { return false; }
    /// Returns in words where the hand is: a word of the event `progress`.
    [[nodiscard]] virtual const char* hand() const = 0;
    [[nodiscard]] virtual std::uint32_t epoch() const { return 0; }
    /// Returns the lead of the server's clock over the master's [ns].
    [[nodiscard]] virtual std::int64_t clockOffsetNs() const { return 0; }
    [[nodiscard]] virtual std::optional<haptic_bridge::Report> report() const { return std::nullopt; }
    [[nodiscard]] virtual haptic_bridge::LinkCounters counters() const { return {}; }
    /// Ends the link in an orderly way.
    virtual void stop() {}
};

/// Returns next() of `source`. While that is empty, asks again for up to patience(), unless `most` is 0 or `stop` says
/// so.
[[nodiscard]] std::vector<haptic_bridge::TimedStep> awaitSteps(StepSource& source, const sand::Replica& sand,
                                                               std::uint64_t hash, std::size_t most,
                                                               const std::function<bool()>& stop);

}  // namespace master
