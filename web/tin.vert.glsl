// SPDX-License-Identifier: Apache-2.0
// Lights the vertices of a TIN. They have no open sky and no mottling.
in vec3 position;
in vec3 normal;

void main() {
    lightVertex(position, normal, 1.0, 0.5);
}
