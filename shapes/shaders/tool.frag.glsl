// SPDX-License-Identifier: Apache-2.0
// Draws the tool: steel while it hovers, red while it touches. The sand's light is reflected from below.
uniform float uEngaged;
in vec3 vScene;
in vec3 vNormal;
out vec4 oColour;

void main() {
    vec3 normal = normalize(vNormal);
    vec3 view = normalize(uEye - vScene);
    vec3 mirrored = reflect(-view, normal);
    // The reflection is sand, darker in the tool's shade, up to a horizon of haze, and a deeper sky above.
    vec3 sand = uSand * mix(0.62, 0.16, smoothstep(0.0, 0.9, -mirrored.z));
    vec3 sky = mix(vec3(0.72, 0.74, 0.74), vec3(0.34, 0.43, 0.56), smoothstep(0.0, 0.8, mirrored.z));
    vec3 surroundings = mix(sand, sky, smoothstep(-0.04, 0.08, mirrored.z));
    float fresnel = 0.06 + 0.94 * pow(1.0 - max(dot(normal, view), 0.0), 5.0);
    float glint = pow(max(dot(mirrored, uSun), 0.0), 120.0);
    vec3 steel = surroundings * vec3(0.62, 0.64, 0.67) + lit(vec3(0.12), normal, 1.0, 1.0);
    vec3 red = lit(vec3(0.62, 0.035, 0.025), normal, 0.5 + 0.5 * normal.z, 1.0) + surroundings * fresnel * 0.6;
    oColour = vec4(encode(mix(steel, red, uEngaged) + glint * 1.5), 1.0);
}
