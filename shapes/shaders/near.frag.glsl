// SPDX-License-Identifier: Apache-2.0
// Draws sand near the tool, whose shadow is finer than the mesh. Equals sand.frag.glsl where the tool takes no light.
in vec4 vColour;
in vec2 vGrainAt;
in float vGrainLevel;
in vec3 vInShadow;
in vec3 vScene;
in vec3 vNormal;
out vec4 oColour;

void main() {
    vec2 taken = toolTakes(vScene, vNormal);
    vec4 colour = vColour - taken.x * vec4(vColour.rgb - vInShadow, 0.7 * vColour.a);
    colour.rgb *= 1.0 - 0.62 * taken.y;
    oColour = vec4(grained(colour, textureLod(uGrain, vGrainAt, vGrainLevel)), 1.0);
}
