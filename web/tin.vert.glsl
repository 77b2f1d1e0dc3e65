// SPDX-License-Identifier: Apache-2.0
// Lights the vertices of a TIN. web/tin_light.ts computes their open sky and mottling.
in vec3 position;
in vec3 normal;
in vec2 shade;

void main() {
    lightVertex(position, normal, shade.x, shade.y);
}
