// SPDX-License-Identifier: Apache-2.0
// Draws a thin line along each edge, half of it in each triangle. If triangles are too small for separate lines, the
// lines fade to an even tint.
in vec3 vFromEdges;
out vec4 oColour;

const float kHalfWidth = 0.55;  // [pixel]
const vec3 kInk = vec3(0.13, 0.07, 0.03);

void main() {
    vec3 perPixel = fwidth(vFromEdges);
    vec3 away = vFromEdges / perPixel;  // [pixel]
    float line = clamp(kHalfWidth + 0.5 - min(min(away.x, away.y), away.z), 0.0, 1.0);
    float narrowest = 1.0 / max(max(perPixel.x, perPixel.y), perPixel.z);  // least height of the triangle [pixel]
    oColour = vec4(kInk, mix(0.22, 0.75 * line, smoothstep(1.0, 4.0, narrowest)));
}
