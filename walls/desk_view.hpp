// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "walls/orbit.hpp"
#include "walls/wall.hpp"

namespace walls {

/// Field of sand on a stage [scene unit].
struct StagedField {
    double width = 1, height = 1;  // from west to east, and from south to north
    double referenceZ = 0;         // height that lies at stage.centre
};

/// Box around the terrain, with sides along the axes of the scene [scene unit].
struct TerrainBox {
    glm::dvec3 low{0}, high{1};
};

/// View of a desktop wall that people turn, pan and zoom. It is one view for all tiles.
///
/// The sand moves in the room, and screens and eyes stay. Used by one thread.
class DeskView {
public:
    static constexpr double kMostZoom = 64;        // less if the sand would reach beyond the far clipping plane
    static constexpr double kNotchesToDouble = 4;  // of the wheel

    /// Begins with the stage of `wall`, whose viewer does not move.
    DeskView(const Wall& wall, const StagedField& field);

    /// Turns the sand by a drag of the view [side of the window], right and down.
    void turn(double right, double down) { orbit_ = orbit_.dragged(stage_, right, down); }
    /// Moves the sand in the room [m]. The place at stage.centre stays within a field's length around the field.
    void pan(glm::dvec3 metres);
    /// Zooms by `notches` of the wheel; positive notches make the sand smaller. The point `fixed` of the room keeps its
    /// sand, so that the sand under the pointer stays there. Returns false if a limit of the zoom was reached before.
    bool zoom(double notches, glm::dvec3 fixed /* [m] */);
    /// Brings the sand back to where the wall file has it. If the screens then cut off a part of `box`, moves the sand
    /// and makes it smaller until they show the whole box.
    void frame(const TerrainBox& box);
    /// Shows the sand as another view of this wall and this field did.
    void show(const Orbit& orbit) { orbit_ = orbit; }

    /// Returns the matrix from the scene to the room.
    [[nodiscard]] glm::dmat4 sceneToRoom() const { return sceneToRoom(orbit_); }
    [[nodiscard]] const Orbit& orbit() const { return orbit_; }

private:
    /// What the viewer sees through all screens together. Places have the axes of the screens: x right, y up, and z
    /// away from the eye.
    struct Opening {
        glm::dvec3 eye{0};
        glm::dmat3 toEye{1};  // from directions in the room
        // Edges of the screens [per metre of distance from the eye].
        double left = -1, right = 1, bottom = -1, top = 1;
        Clip clip;

        explicit Opening(const Wall& wall);
        [[nodiscard]] glm::dvec3 seen(glm::dvec3 room) const { return toEye * (room - eye); }
        [[nodiscard]] bool shows(glm::dvec3 room) const;
    };
    [[nodiscard]] glm::dmat4 sceneToRoom(const Orbit& orbit) const;
    [[nodiscard]] Orbit smallEnough(const TerrainBox& box) const;
    void aimAt(glm::dvec3 aim);

    Stage stage_;
    StagedField field_;
    Opening opening_;
    Orbit orbit_;
    double least_ = 1, most_ = 1;  // limits of the zoom
};

}  // namespace walls
