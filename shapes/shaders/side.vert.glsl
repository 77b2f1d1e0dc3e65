// SPDX-License-Identifier: Apache-2.0
// Places and lights the cut sides of the sand.
layout(location = 0) in vec3 aPosition;
layout(location = 1) in vec3 aNormal;

uniform mat4 uSceneToRoom;
uniform mat4 uRoomToClip;

out vec4 vColour;
out vec2 vGrainAt;
out float vGrainLevel;
out vec3 vInShadow;
out vec3 vScene;
out vec3 vNormal;

void main() {
    vScene = aPosition;
    vNormal = aNormal;
    Shade shade = shadeOf(aPosition, aNormal, 0.9, 0.5);
    vColour = shade.colour;
    vInShadow = shade.inShadow;
    vGrainLevel = grainLevel(aPosition, vec3(0.0, 0.0, 1.0));
    vGrainAt = (aPosition.xy + aPosition.z * vec2(0.71, 0.53)) * uGrainScale;  // for upright sides; compare grainAt()
    vec4 room = uSceneToRoom * vec4(aPosition, 1.0);
    gl_Position = uRoomToClip * room;
}
