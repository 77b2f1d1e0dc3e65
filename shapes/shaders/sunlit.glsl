// SPDX-License-Identifier: Apache-2.0
// Colours sand in the sun. hill_shade.glsl has the same functions for sand on a map.

struct Shade {
    vec4 colour;    // sRGB of smooth sand, and the strength of its grains
    vec3 inShadow;  // sRGB in the tool's shadow
};

Shade shadeOf(vec3 place, vec3 normal, float open, float mottling) {
    // Sand that slid to its angle of rest has lost its fine pale dust, which remains on level ground.
    float slid = smoothstep(0.01, 0.19, 1.0 - normal.z);
    vec3 albedo = uSand * mix(vec3(1.02), vec3(0.92, 0.855, 0.77), slid) * (0.86 + 0.28 * mottling);
    float sky = 0.35 + 0.65 * open;
    float sun = max(dot(normal, uSun), 0.0);
    // Grains are most visible in grazing sunlight, and hardly visible in the shade.
    float relief = 0.12 + 0.50 * smoothstep(0.0, 0.25, sun) * (1.0 - smoothstep(0.25, 1.0, sun));
    vec3 light = lit(albedo, normal, sky, 1.0);
#ifdef WET
    light += sheen(place, normal);
#endif
    return Shade(vec4(encode(light), relief), encode(lit(albedo, normal, sky, 0.0)));
}

// Grains are fixed to the scene, so that they do not move with the head.
vec3 grained(vec4 colour, vec4 grain) {
    return colour.rgb * (0.5 + grain.r + (grain.g - 0.5) * colour.a);
}
