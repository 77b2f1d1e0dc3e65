// SPDX-License-Identifier: Apache-2.0
// Sand: grains fixed to the scene, so that they do not swim with the head.
in vec4 vColour;
in vec2 vGrainAt;
out vec4 oColour;

void main() {
    vec4 grain = texture(uGrain, vGrainAt);
    oColour = vec4(vColour.rgb * (0.5 + grain.r + (grain.g - 0.5) * vColour.a), 1.0);
}
