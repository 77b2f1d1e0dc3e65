// SPDX-License-Identifier: Apache-2.0
#include "tracking/dtrack.hpp"
#include "tracking/head_trace.hpp"
#include "tracking/head_tracker.hpp"
#include "tracking/opentrack.hpp"
#include "tracking/udp_tracker.hpp"

namespace tracking {

std::unique_ptr<HeadTracker> openTracker(const Source& source, glm::dvec3 restingEye, Print print, Clock clock) {
    const RoomMapping mapping = source.mapping(restingEye);
    switch (source.kind) {
        case Source::Kind::none:
            return nullptr;
        case Source::Kind::trace:
            return std::make_unique<TraceTracker>(HeadTrace::load(source.file, mapping));
        case Source::Kind::opentrack:
            return std::make_unique<UdpTracker>(source, mapping, std::make_unique<OpentrackReader>(), std::move(print),
                                                std::move(clock));
        case Source::Kind::dtrack:
            return std::make_unique<UdpTracker>(source, mapping, std::make_unique<DtrackReader>(source.body),
                                                std::move(print), std::move(clock));
    }
    return nullptr;
}

}  // namespace tracking
