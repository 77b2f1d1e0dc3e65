// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptic_bridge/client/client.hpp"
#include "haptic_bridge/hand/pointer.hpp"
#include "lockstep/fault.hpp"
#include "master/steps/arrived_step.hpp"
#include "sand/replica.hpp"

namespace master {

/// Sets the force that the hand feels.
class ForceControl {
public:
    virtual ~ForceControl() = default;
    /// Sets the share of the server's forces that the hand feels from now on, 0 to 1, as an operator asked. Servers
    /// that link later get it, too.
    virtual void shareForce(double share) = 0;
    /// Returns the share that shareForce() cannot exceed, because the linked server's own options are a ceiling;
    /// nullopt if no server is linked.
    [[nodiscard]] virtual std::optional<double> forceCeiling() const { return std::nullopt; }
};

/// Source of a session's steps: LiveSteps from a hand, or RecordedSteps from a recording. Used by one thread.
class StepSource {
public:
    virtual ~StepSource() = default;

    /// Returns the steps of the next frame, at most `most`; an empty list if no step is due. Their numbers continue
    /// those of `sand`, whose state hash is `hash`. Called once per frame. If it returns no step, it may be called
    /// again until patience() has passed.
    [[nodiscard]] virtual ArrivedSteps next(const sand::Replica& sand, std::uint64_t hash, std::size_t most) = 0;
    /// Returns how many steps one frame may take. A long catch-up is spread over several frames.
    [[nodiscard]] virtual std::size_t mostPerFrame() const = 0;
    /// Returns how long a frame waits for a step before it is shown without one [s].
    [[nodiscard]] virtual double patience() const { return 0; }
    /// Returns what sets the force of the hand, or null for a recording, which no operator can change.
    [[nodiscard]] virtual ForceControl* force() { return nullptr; }

    /// Called when the master's sand has reached a new state. A source that knows the hash of this state compares the
    /// hashes.
    virtual void reached(sand::Replica& /* sand */) {}
    /// Called when the master's own sand was wrong and has been healed. Discards the result of reached(), and compares
    /// again.
    virtual void healed(sand::Replica& /* sand */) {}
    /// Returns whether the master's sand differs from the hash that the source knows. The session then ends.
    [[nodiscard]] virtual bool strayed() const { return false; }
    /// Returns a line for the user that describes this difference, once; an empty text if there is no new one.
    [[nodiscard]] virtual std::string takeStrayLine() { return {}; }

    /// Takes the pointers of the ranks' windows at the last barrier, in order of rank. While one is pressed, the tool's
    /// underside is by `depth` below the sand's surface [tool radius]. `receivedNs` is when the last of them arrived
    /// [ns, the master's clock].
    virtual void pointed(std::span<const haptic_bridge::PointerReport> /* reports */, double /* depth */,
                         const sand::Replica& /* sand */, std::int64_t /* receivedNs */) {}

    /// Called when the wall has swapped.
    virtual void shown(const haptic_bridge::Shown& /* frame */) {}
    /// Compares the wall's state hash `hash` with the haptic server's hash after the last of `steps`. The wall shows
    /// this step now. If the server's sand differs, ends the link to this server and returns false. Also returns false,
    /// once, if a server has said goodbye and has found that its memory had changed (haptic_bridge::Audited::differed).
    [[nodiscard]] virtual bool proveServer(const ArrivedSteps& /* steps */, std::uint64_t /* hash */) { return true; }
    /// Called when all replicas have left out one of `steps`, because it does what no program that numbers steps
    /// correctly does (sand::Replica::refusedStep()). `why` is Replica::leftOut().
    virtual void refused(const ArrivedSteps& /* steps */, const std::string& /* why */) {}
    /// Returns the pieces of the server's tick track since the last call. They are written to the journal.
    [[nodiscard]] virtual std::vector<base::Bytes> ticks() { return {}; }
    /// Injects a fault into the link: garbage or a partition. Without a link, the fault is kept until there is one.
    virtual void drill(const lockstep::Fault& /* fault */) {}

    /// Returns whether a haptic server numbers the steps.
    [[nodiscard]] virtual bool linked() const { return false; }
    /// Returns whether a server without sand streams positions of the hand, and the master numbers the steps.
    [[nodiscard]] virtual bool streaming() const { return false; }
    /// Returns whether a hand moves the tool: one that is linked or streams, or a pointer that has moved or touched.
    [[nodiscard]] virtual bool handed() const { return false; }
    /// Returns whether next() has returned no step because sand and hand are at rest.
    [[nodiscard]] virtual bool rests() const { return false; }
    /// Returns why the last attempt to link has failed, as haptic_bridge::Client::lastFailure() does.
    [[nodiscard]] virtual std::string lastRefusal() const { return {}; }
    /// Returns the state of the hand, such as "hand linked", as the event `progress` reports it (docs/events.md).
    [[nodiscard]] virtual const char* hand() const = 0;
    /// Returns the present epoch of live steps; 0 for a recording.
    [[nodiscard]] virtual std::uint32_t epoch() const { return 0; }
    /// Returns server's clock − master's clock [ns].
    [[nodiscard]] virtual std::int64_t clockOffsetNs() const { return 0; }
    /// Returns the server's latest report; nullopt if no server has sent one.
    [[nodiscard]] virtual std::optional<haptic_bridge::Report> report() const { return std::nullopt; }
    /// Returns whether the server pushes 0 after three faults, until an operator switches the force on.
    [[nodiscard]] virtual bool forceTripped() const { return false; }
    /// Returns the counters of all links so far, added up.
    [[nodiscard]] virtual haptic_bridge::LinkCounters counters() const { return {}; }
    /// Says goodbye to the server and ends the link.
    virtual void stop() {}
    /// Call it after stop(). Returns whether the memory of the server, which was linked until then, had the sand that
    /// its hashes said. Returns nullopt if no server with sand was linked, or if it did not answer in time.
    [[nodiscard]] virtual std::optional<bool> serverAtEnd() const { return std::nullopt; }
    /// Returns whether a server's sand differed, and no server has been given the wall's sand since.
    [[nodiscard]] virtual bool serverUnhealed() const { return false; }
};

/// Returns the next steps of `source`. While it has no step, asks again until source.patience() has passed or `stop`
/// returns true. With `most` = 0 it asks only once.
[[nodiscard]] ArrivedSteps awaitSteps(StepSource& source, const sand::Replica& sand, std::uint64_t hash,
                                      std::size_t most, const std::function<bool()>& stop);

}  // namespace master
