// SPDX-License-Identifier: Apache-2.0
// The sand's surface. The position in the room is the same sum in every tile, so that tiles join.
layout(location = 0) in float aHeight;  // scene unit
layout(location = 1) in vec2 aGrid;     // vertex column and row
layout(location = 2) in vec2 aNormal;   // east and north
layout(location = 3) in float aOpen;

uniform mat4 uSceneToRoom;
uniform mat4 uRoomToClip;
uniform float uCell;  // scene unit
uniform vec2 uCells;  // columns and rows of the field

out vec3 vScene;
out vec3 vNormal;
out float vOpen;

void main() {
    vec2 ground = clamp(aGrid - 0.5, vec2(0.0), uCells) * uCell;
    vScene = vec3(ground, aHeight);
    vNormal = vec3(aNormal, sqrt(max(1.0 - dot(aNormal, aNormal), 0.0)));
    vOpen = aOpen;
    vec4 room = uSceneToRoom * vec4(vScene, 1.0);
    gl_Position = uRoomToClip * room;
}
