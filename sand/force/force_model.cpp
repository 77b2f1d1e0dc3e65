// SPDX-License-Identifier: Apache-2.0
#include "sand/force/force_model.hpp"

#include <cmath>

#include "sand/force/contact_force.hpp"

namespace sand::force {

Response ForceModel::at(const SurfacePatch& surface, std::uint64_t, const Contour& tool, Vec3 place, double) {
    const Contact contact = measureContact(surface, place, tool.reach);
    const Vec3 push = contactForce(constants_, contact, {});
    const double most = contact.share * constants_.stiffness * constants_.depthExponent;
    return {push, contact.normal, constants_.friction * norm(push),
            most * std::exp(constants_.depthExponent * contact.depth)};
}

}  // namespace sand::force
