// SPDX-License-Identifier: Apache-2.0
// Lights the vertices of a TIN, as heights.vert.glsl does for a grid. They have no open sky and no mottling.
in vec3 position;
in vec3 normal;
uniform mat4 uSceneToRoom;
uniform mat4 uRoomToClip;
out vec4 vColour;
out vec2 vGrainAt;
out float vGrainLevel;
out vec3 vInShadow;
out vec3 vScene;
out vec3 vNormal;

void main() {
    vScene = position;
    vNormal = normal;
    Shade shade = shadeOf(vScene, vNormal, 1.0, 0.5);
    vColour = shade.colour;
    vInShadow = shade.inShadow;
    vGrainAt = grainAt(vScene);
    vGrainLevel = grainLevel(vScene, vNormal);
    gl_Position = uRoomToClip * (uSceneToRoom * vec4(vScene, 1.0));
}
