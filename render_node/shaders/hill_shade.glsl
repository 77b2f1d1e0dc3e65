// SPDX-License-Identifier: Apache-2.0
// Sand as maps shade hills, in place of sunlit.glsl: from the north-west at 45 degrees, whatever the scene's sun, which
// readers of maps see as raised and not as sunk. Light falls warm and shade cool, as on Swiss maps. No grains.

struct Shade {
    vec4 colour;
    vec3 inShadow;
};

Shade shadeOf(vec3 normal, float open, float mottling) {
    float light = max(dot(normal, vec3(-0.5, 0.5, 0.70710678)), 0.0);
    // Level ground, at sin 45°, is the middle: between the shade's colour and the light's.
    vec3 colour = light < 0.70710678 ? mix(vec3(0.19, 0.20, 0.27), vec3(0.80, 0.78, 0.72), light / 0.70710678)
                                     : mix(vec3(0.80, 0.78, 0.72), vec3(1.0, 0.98, 0.90), (light - 0.70710678) / 0.29289322);
    colour *= 0.7 + 0.3 * open;
    return Shade(vec4(colour, 0.0), 0.72 * colour);
}

vec3 grained(vec4 colour, vec4 grain) { return colour.rgb; }
