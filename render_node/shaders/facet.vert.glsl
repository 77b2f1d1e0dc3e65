// SPDX-License-Identifier: Apache-2.0
// Places the sand's vertices for facet.geom.glsl, at the same places as sand.vert.glsl does.
layout(location = 0) in float aHeight;  // scene unit
layout(location = 1) in vec2 aGrid;
layout(location = 3) in vec2 aShade;    // open sky, mottling

uniform mat4 uSceneToRoom;
uniform mat4 uRoomToClip;
uniform float uCell;
uniform vec2 uCells;
uniform float uFirst;

invariant gl_Position;
out vec3 vCorner;
out vec2 vShade;

void main() {
    vCorner = vec3(clamp(aGrid - uFirst, vec2(0.0), uCells) * uCell, aHeight);
    vShade = aShade;
    vec4 room = uSceneToRoom * vec4(vCorner, 1.0);
    gl_Position = uRoomToClip * room;
}
