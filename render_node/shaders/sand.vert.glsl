// SPDX-License-Identifier: Apache-2.0
// The sand's surface, lit per vertex: the mesh is fine, and a software renderer shades the pixels of small triangles
// several times over. The position in the room is the same sum in every tile, so that tiles join.
layout(location = 0) in float aHeight;  // scene unit
layout(location = 1) in vec2 aGrid;     // vertex column and row
layout(location = 2) in vec2 aNormal;   // east and north
layout(location = 3) in vec2 aShade;    // open sky, mottling

uniform mat4 uSceneToRoom;
uniform mat4 uRoomToClip;
uniform float uCell;  // scene unit
uniform vec2 uCells;  // columns and rows of the field

out vec4 vColour;
out vec2 vGrainAt;

void main() {
    vec2 ground = clamp(aGrid - 0.5, vec2(0.0), uCells) * uCell;
    vec3 place = vec3(ground, aHeight);
    vec3 normal = vec3(aNormal, sqrt(max(1.0 - dot(aNormal, aNormal), 0.0)));
    vColour = sandColour(place, normal, aShade.x, aShade.y);
    vGrainAt = grainAt(place);
    vec4 room = uSceneToRoom * vec4(place, 1.0);
    gl_Position = uRoomToClip * room;
}
