// SPDX-License-Identifier: Apache-2.0
// Put before every shader. All positions and directions are the scene's; all colours are linear light.
uniform vec3 uSun;         // towards it
uniform vec3 uEye;
uniform vec4 uTool;        // centre and radius; radius 0 where there is none
uniform vec3 uSand;        // its albedo
uniform sampler2D uGrain;  // see grain_texture.hpp
uniform float uGrainScale; // periods of the grain per scene unit

const vec3 kSunlight = vec3(1.02, 0.92, 0.76);
const vec3 kSkylight = vec3(0.21, 0.26, 0.34);

// What the tool leaves of the sun (x) and of the sky (y) at a place. The penumbra widens with the distance.
vec2 lightPastTool(vec3 place, vec3 normal) {
    if (uTool.w <= 0.0) {
        return vec2(1.0);
    }
    vec3 away = (uTool.xyz - place) / uTool.w;
    float square = max(dot(away, away), 0.25);
    float along = dot(away, uSun);
    float miss = sqrt(max(square - along * along, 0.0));
    float blur = 0.12 + 0.06 * max(along, 0.0);
    float sun = mix(1.0, smoothstep(1.0 - blur, 1.0 + blur, miss), smoothstep(-0.2, 0.2, along));
    float facing = clamp(dot(normal, away) * inversesqrt(square), 0.0, 1.0);
    // Nothing at all beyond six radii, so that far tiles need not be drawn again (kToolReach in sand_view.cpp).
    float sky = 1.0 - 0.65 * facing * max(1.0 / max(square, 1.0) - 1.0 / 36.0, 0.0);
    return vec2(sun, sky);
}

// A rough surface under sun and sky; where little sky is seen, its own kind throws light back.
vec3 lit(vec3 albedo, vec3 normal, float open, vec2 past) {
    float sun = max(dot(normal, uSun), 0.0) * past.x;
    vec3 sky = kSkylight * (0.75 + 0.25 * normal.z) * (open * past.y);
    vec3 bounce = kSunlight * albedo * (0.35 * (1.0 - open) * past.y + 0.05);
    return albedo * (kSunlight * sun + sky + bounce);
}

// sRGB of linear light, within half a level (the well-known sum of roots: a power costs a software renderer more).
vec3 encode(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    vec3 a = sqrt(c);
    vec3 b = sqrt(a);
    vec3 d = sqrt(b);
    return 0.662002687 * a + 0.684122060 * b - 0.323583601 * d - 0.0225411470 * c;
}

// The sRGB colour of smooth sand, and (a) how much its grains stand out: most where the sun grazes them.
vec4 sandColour(vec3 place, vec3 normal, float open, float mottling) {
    vec2 past = lightPastTool(place, normal);
    // Loose, steep sand has shed its fine pale dust.
    float steep = min((1.0 - normal.z) * 2.5, 1.0);
    vec3 albedo = uSand * mix(vec3(1.0), vec3(0.93, 0.86, 0.78), steep) * (0.86 + 0.28 * mottling);
    float sun = max(dot(normal, uSun), 0.0) * past.x;
    float relief = 0.30 + 0.45 * smoothstep(0.0, 0.25, sun) * (1.0 - smoothstep(0.25, 1.0, sun));
    return vec4(encode(lit(albedo, normal, 0.4 + 0.6 * open, past)), relief);
}

// Where the grain texture lies on the sand. Height shifts it, or steep sides would show stripes.
vec2 grainAt(vec3 place) { return (place.xy + place.z * vec2(0.71, 0.53)) * uGrainScale; }
