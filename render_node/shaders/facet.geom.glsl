// SPDX-License-Identifier: Apache-2.0
// Lights each triangle as one facet, with its own normal and the mean of its corners' visible sky and mottling.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

in vec3 vCorner[];
in vec2 vShade[];
out vec4 vColour;
out vec2 vGrainAt;
out float vGrainLevel;
out vec3 vInShadow;
out vec3 vScene;
out vec3 vNormal;

void main() {
    vec3 normal = normalize(cross(vCorner[1] - vCorner[0], vCorner[2] - vCorner[0]));
    vec2 mean = (vShade[0] + vShade[1] + vShade[2]) / 3.0;
    vec3 middle = (vCorner[0] + vCorner[1] + vCorner[2]) / 3.0;
    Shade shade = shadeOf(middle, normal, mean.x, mean.y);
    for (int i = 0; i < 3; ++i) {
        vColour = shade.colour;
        vInShadow = shade.inShadow;
        vGrainAt = grainAt(vCorner[i]);
        vGrainLevel = grainLevel(vCorner[i], normal);
        vScene = vCorner[i];
        vNormal = normal;
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
}
