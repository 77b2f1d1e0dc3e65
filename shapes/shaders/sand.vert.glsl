// SPDX-License-Identifier: Apache-2.0
// Places the sand's vertices and lights them. Light is computed per vertex, because the mesh is fine and a software
// renderer shades the pixels of small triangles several times. Only the tool's shadow may be finer. The position in the
// room is the same sum in every tile, so that tiles join.
layout(location = 0) in float aHeight;  // scene unit
layout(location = 1) in vec2 aGrid;     // place of the vertex [uCell]
layout(location = 2) in vec2 aNormal;   // east and north
layout(location = 3) in vec2 aShade;    // open sky, mottling

uniform mat4 uSceneToRoom;
uniform mat4 uRoomToClip;
uniform float uCell;   // unit of aGrid [scene unit]
uniform vec2 uCells;   // sides of the field [uCell]
uniform float uFirst;  // value of aGrid at the field's edge; vertices with smaller values are on the edge

// invariant makes positions equal in every program, so that surfaces of different programs join.
invariant gl_Position;
out vec4 vColour;
out vec2 vGrainAt;
out float vGrainLevel;
out vec3 vInShadow;
out vec3 vScene;
out vec3 vNormal;

void main() {
    vec2 ground = clamp(aGrid - uFirst, vec2(0.0), uCells) * uCell;
    vScene = vec3(ground, aHeight);
    vNormal = vec3(aNormal, sqrt(max(1.0 - dot(aNormal, aNormal), 0.0)));
    Shade shade = shadeOf(vScene, vNormal, aShade.x, aShade.y);
    vColour = shade.colour;
    vInShadow = shade.inShadow;
    vGrainAt = grainAt(vScene);
    vGrainLevel = grainLevel(vScene, vNormal);
    vec4 room = uSceneToRoom * vec4(vScene, 1.0);
    gl_Position = uRoomToClip * room;
}
