// SPDX-License-Identifier: Apache-2.0
// Tells each pixel how far it is from every edge of its triangle, whatever mesh the triangle is of.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

out vec3 vFromEdges;  // 0 on an edge, 1 in the corner across

void main() {
    for (int i = 0; i < 3; ++i) {
        vFromEdges = vec3(i == 0, i == 1, i == 2);
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
}
