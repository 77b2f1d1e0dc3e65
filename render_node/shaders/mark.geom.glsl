// SPDX-License-Identifier: Apache-2.0
// Tells each pixel how far it is from the edge across the triangle's first corner.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

out float vFromEdge;  // 0 on it, 1 in that corner

void main() {
    for (int i = 0; i < 3; ++i) {
        vFromEdge = i == 0 ? 1.0 : 0.0;
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
}
