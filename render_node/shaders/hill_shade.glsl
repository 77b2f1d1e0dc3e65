// SPDX-License-Identifier: Apache-2.0
// Colours sand as maps shade hills, and replaces sunlit.glsl. Light comes from the north-west at 45 degrees, whatever
// the scene's sun is, because readers of maps then see hills as raised. Light is warm and shade is cool, as on Swiss
// maps. There are no grains.

struct Shade {
    vec4 colour;
    vec3 inShadow;
};

Shade shadeOf(vec3 place, vec3 normal, float open, float mottling) {
    float light = max(dot(normal, vec3(-0.5, 0.5, 0.70710678)), 0.0);
    // Level ground has the value sin 45° and the middle colour, between the shade's colour and the light's.
    vec3 colour = light < 0.70710678 ? mix(vec3(0.19, 0.20, 0.27), vec3(0.80, 0.78, 0.72), light / 0.70710678)
                                     : mix(vec3(0.80, 0.78, 0.72), vec3(1.0, 0.98, 0.90), (light - 0.70710678) / 0.29289322);
    colour *= 0.7 + 0.3 * open;
    return Shade(vec4(colour, 0.0), 0.72 * colour);
}

vec3 grained(vec4 colour, vec4 grain) { return colour.rgb; }
