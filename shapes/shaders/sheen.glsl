// SPDX-License-Identifier: Apache-2.0
// Lights the water on wet sand. This file is put before sunlit.glsl.
#define WET
uniform float uWet;  // humidity, 0 to 1

// Returns the sunlight that the film of water reflects towards the eye. The film follows the grains, so that the
// highlight is wide (Blinn and Phong's lobe with the exponent 16). `normal` has about length 1.
vec3 sheen(vec3 place, vec3 normal) {
    vec3 toEye = normalize(uEye - place);
    vec3 middle = normalize(toEye + uSun);
    float away = 1.0 - max(dot(middle, uSun), 0.0);
    float mirrored = 0.02 + 0.98 * away * away * away * away * away;  // Fresnel's share for water, after Schlick
    float lobe = max(dot(normal, middle), 0.0);
    lobe *= lobe;
    lobe *= lobe;
    lobe *= lobe;
    lobe *= lobe;
    return kSunlight * (uWet * mirrored * lobe * (16.0 + 2.0) / 8.0 * max(dot(normal, uSun), 0.0));
}
