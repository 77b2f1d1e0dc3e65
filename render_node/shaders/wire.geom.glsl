// SPDX-License-Identifier: Apache-2.0
// Gives each pixel its distance from every edge of its triangle, for any mesh.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

out vec3 vFromEdges;  // 0 on an edge, 1 in the opposite corner

void main() {
    for (int i = 0; i < 3; ++i) {
        vFromEdges = vec3(i == 0, i == 1, i == 2);
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
}
