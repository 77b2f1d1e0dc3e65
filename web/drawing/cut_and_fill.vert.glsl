// SPDX-License-Identifier: Apache-2.0
// Colours sand that has gone since the session's start blue, and sand that has come red. It is put behind sand.vert.glsl,
// whose main() is called placeSand() here.
uniform float uCutAndFill;  // 1: shows the colours
in float aStart;            // aHeight at the start

void main() {
    placeSand();
    float gone = aStart - aHeight;
    float much = uCutAndFill * clamp(abs(gone) / (4.0 * uCell), 0.0, 1.0);  // uCell is half a cell
    vec3 tint = gone > 0.0 ? vec3(0.12, 0.35, 0.95) : vec3(0.95, 0.22, 0.10);
    vColour.rgb = mix(vColour.rgb, tint * (0.25 + dot(vColour.rgb, vec3(0.3, 0.5, 0.2))), much);
    vInShadow = mix(vInShadow, vColour.rgb * 0.6, much);
}
