// SPDX-License-Identifier: Apache-2.0
#include "sand/force/force_model.hpp"

#include "sand/force/law.hpp"

namespace sand::force {

Response ForceModel::at(const SurfacePatch& surface, std::uint64_t step, const Contour& tool, Vec3 place, double time,
                        bool edited) {
    if (surface.empty() || !(tool.reach > 0)) {
        known_ = false;
        return {};
    }
    // Sand of an edit has not moved there, so that no earlier sand can take over into it.
    const bool forget = !known_ || edited || time - time_ > kForget;
    const bool replaced = forget || step != step_;
    known_ = true;
    step_ = step;
    time_ = time;
    if (constants_.between == Between::local) {
        return respond(constants_, tool, local_.at(constants_, surface, replaced, forget, tool, place, time));
    }
    if (replaced) {
        held_ = respond(constants_, surface, tool, place);
    }
    return constants_.between == Between::hold ? held_ : interpolation_.at(replaced, forget, constants_.literal, held_);
}

}  // namespace sand::force
