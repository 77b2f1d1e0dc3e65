// SPDX-License-Identifier: Apache-2.0
// Put before every shader. All positions and directions are the scene's; all colours are linear light.
uniform vec3 uSun;         // towards it
uniform vec3 uEye;
uniform mat4 uSceneToClip;
uniform vec2 uHalfPicture; // [pixel]
uniform vec4 uTool;        // centre, and one over its radius; far away where there is none
uniform vec3 uSand;        // its albedo
uniform sampler2D uGrain;  // see grain_texture.hpp
uniform float uGrainScale; // periods of the grain per scene unit

const vec3 kSunlight = vec3(1.02, 0.92, 0.76);
const vec3 kSkylight = vec3(0.205, 0.235, 0.28);

// In radii of the tool; render_node/tool/reach.cpp has the same numbers.
const float kToolReach = 1.8;
const float kShadowLength = 20.0;
const vec2 kPenumbra = vec2(0.08, 0.07);

// The tool's share of the sun and of the light from all around, at a place: exactly 0 beyond their reach (ToolReach),
// so that what is drawn without asking equals what is drawn with it. ball.glsl and stamp.glsl call these two. Every pixel
// near the tool takes this several times over by a software renderer: few divisions and roots.

// How much of the sun the tool takes: all close behind it; its shadow widens and fades with the distance, and ends.
// `square`: of the distance from its centre, `along`: behind it towards the sun [radius]; `far`: `along` in the scene
// [longest half axis].
float shadowOf(float square, float along, float far) {
    float miss = sqrt(max(square - along * along, 0.0));
    float blur = kPenumbra.x + kPenumbra.y * max(far, 0.0);
    float behind = smoothstep(-0.2, 0.2, along) * (1.0 - smoothstep(2.0, kShadowLength, far));
    return (1.0 - smoothstep(1.0 - blur, 1.0 + blur, miss)) * behind;
}

// How much of the light from all around the tool takes: the share of the sky that a ball hides (its solid angle by the
// cosine), no less than a part of it beside the ball, for sand that lies up against it; 0 from kToolReach on.
// `nearer`: one over the distance from its centre, at most 1 [1/radius].
float occlusionOf(float nearer, float cosine) {
    const float kAtReach = 1.0 / (kToolReach * kToolReach);
    float near = max(nearer * nearer - kAtReach, 0.0) * (1.0 / (1.0 - kAtReach));
    return clamp(0.4 + 0.6 * cosine, 0.0, 1.0) * near * (0.75 + 0.25 * near);
}

// A rough surface under a share of the sun, and the sky; where little sky is seen, its own kind throws light back.
vec3 lit(vec3 albedo, vec3 normal, float open, float sunny) {
    float sun = max(dot(normal, uSun), 0.0) * sunny;
    vec3 sky = kSkylight * ((0.75 + 0.25 * normal.z) * open);
    vec3 bounce = kSunlight * albedo * (0.35 * (1.0 - open) + 0.15 * (1.0 - normal.z) + 0.04);
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

// Where the grain texture lies on the sand: as seen from above, shifted a little by the height, or a bank that stands
// upright for a moment would show stripes. More of it would draw out the grain of slopes.
vec2 grainAt(vec3 place) { return (place.xy + place.z * vec2(0.20, 0.15)) * uGrainScale; }

// At which of its levels the grain is drawn: by how many texels a pixel spans where it spans most, half a level less,
// so that grains stay across it, and up to half a level more or less by chance, so that nobody sees where a level ends.
// Asked for at vertices: what a pixel computes from those beside it is rounded otherwise in the next tile.
float grainLevel(vec3 place, vec3 normal) {
    vec2 slope = normal.xy / max(normal.z, 0.2);
    vec4 at = uSceneToClip * vec4(place, 1.0);
    vec4 east = uSceneToClip * vec4(1.0, 0.0, -slope.x, 0.0);
    vec4 north = uSceneToClip * vec4(0.0, 1.0, -slope.y, 0.0);
    float far = max(abs(at.w), 1e-6);
    // Pixels by scene units along the ground, and turned round.
    vec2 x = (east.xy - at.xy * (east.w / far)) * (uHalfPicture / far);
    vec2 y = (north.xy - at.xy * (north.w / far)) * (uHalfPicture / far);
    float longest = sqrt(max(x.x * x.x + y.x * y.x, x.y * x.y + y.y * y.y));
    float units = longest / max(abs(x.x * y.y - x.y * y.x), 1e-6);
    float texels = units * uGrainScale * float(textureSize(uGrain, 0).x);
    uint hash = (floatBitsToUint(place.x) * 0x9e3779b1u + floatBitsToUint(place.y)) * 0x85ebca6bu;
    hash = (hash ^ (hash >> 15)) * 0xc2b2ae35u;
    return log2(max(texels, 1e-3)) - 1.0 + float(hash >> 8) / 16777216.0;
}
