// SPDX-License-Identifier: Apache-2.0
// Draws the boards around the sand. The fibres are the sand's grain, stretched along the board.
in vec3 vScene;
in vec3 vNormal;
in vec2 vAlong;
out vec4 oColour;

void main() {
    vec2 at = vAlong * uGrainScale;
    float fibre = texture(uGrain, vec2(at.x * 0.02, at.y * 0.6), -0.5).r;
    float ring = texture(uGrain, vec2(at.x * 0.05, at.y * 0.7), -0.5).b;
    vec3 albedo = mix(vec3(0.17, 0.085, 0.04), vec3(0.34, 0.19, 0.095), 0.25 * fibre + 0.75 * ring);
    vec3 normal = normalize(vNormal);
    vec2 taken = toolTakes(vScene, normal);
    vec3 colour = encode(lit(albedo, normal, 1.0, 1.0 - taken.x));
    oColour = vec4(colour * (1.0 - 0.62 * taken.y), 1.0);
}
