// SPDX-License-Identifier: Apache-2.0
// Gives each pixel its distance from the edge opposite the triangle's first corner.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

out float vFromEdge;  // 0 on the edge, 1 in the corner

void main() {
    for (int i = 0; i < 3; ++i) {
        vFromEdge = i == 0 ? 1.0 : 0.0;
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
}
