// SPDX-License-Identifier: Apache-2.0
// Draws the arrow of the force. The arrow is a sign, not part of the scene, so it glows a little and casts no shadow.
uniform vec3 uColour;  // linear light
in vec3 vScene;
in vec3 vNormal;
out vec4 oColour;

void main() {
    vec3 normal = normalize(vNormal);
    float facing = max(dot(normal, normalize(uEye - vScene)), 0.0);
    oColour = vec4(encode(uColour * (0.30 + 0.35 * facing + 0.35 * max(dot(normal, uSun), 0.0))), 1.0);
}
