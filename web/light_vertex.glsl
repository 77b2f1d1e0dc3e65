// SPDX-License-Identifier: Apache-2.0
// Lights a vertex, as render_node/shaders/sand.vert.glsl does. It is put before heights.vert.glsl and tin.vert.glsl.
uniform mat4 uSceneToRoom;
uniform mat4 uRoomToClip;
out vec4 vColour;
out vec2 vGrainAt;
out float vGrainLevel;
out vec3 vInShadow;
out vec3 vScene;
out vec3 vNormal;

void lightVertex(vec3 place, vec3 normal, float openSky, float mottling) {
    vScene = place;
    vNormal = normal;
    Shade shade = shadeOf(vScene, vNormal, openSky, mottling);
    vColour = shade.colour;
    vInShadow = shade.inShadow;
    vGrainAt = grainAt(vScene);
    vGrainLevel = grainLevel(vScene, vNormal);
    gl_Position = uRoomToClip * (uSceneToRoom * vec4(vScene, 1.0));
}
