// SPDX-License-Identifier: Apache-2.0
// Draws a constraint of the TIN over its wires: a line of another colour, half of it in each triangle.
in float vFromEdge;
out vec4 oColour;

const float kHalfWidth = 1.1;  // [pixel]

void main() {
    float away = vFromEdge / fwidth(vFromEdge);  // [pixel]
    oColour = vec4(0.80, 0.07, 0.05, 0.9 * clamp(kHalfWidth + 0.5 - away, 0.0, 1.0));
}
