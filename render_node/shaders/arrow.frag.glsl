// SPDX-License-Identifier: Apache-2.0
// The force's arrow: a sign and no thing of the scene, so that it glows a little and throws no shadow.
uniform vec3 uColour;  // linear
in vec3 vScene;
in vec3 vNormal;
out vec4 oColour;

void main() {
    vec3 normal = normalize(vNormal);
    float facing = max(dot(normal, normalize(uEye - vScene)), 0.0);
    oColour = vec4(encode(uColour * (0.30 + 0.35 * facing + 0.35 * max(dot(normal, uSun), 0.0))), 1.0);
}
