// SPDX-License-Identifier: Apache-2.0
// This file is put before every shader. All positions and directions are in the scene. All colours are linear light.
uniform vec3 uSun;         // towards the sun
uniform vec3 uEye;
uniform mat4 uSceneToClip;
uniform vec2 uHalfPicture; // [pixel]
uniform vec4 uTool;        // centre, and 1 / radius; far away if there is no tool
uniform vec3 uSand;        // albedo of the sand
uniform sampler2D uGrain;  // see grain_texture.hpp
uniform float uGrainScale; // periods of the grain per scene unit

const vec3 kSunlight = vec3(1.02, 0.92, 0.76);
const vec3 kSkylight = vec3(0.205, 0.235, 0.28);

// Values in radii of the tool. render_node/tool/reach.cpp has the same values.
const float kToolReach = 1.8;
const float kShadowLength = 20.0;
const vec2 kPenumbra = vec2(0.08, 0.07);

// The next two functions return the shares of the sun's light and of the surrounding light that the tool takes at a
// place. The shares are exactly 0 beyond their reach (ToolReach), so that shaders without them draw the same there.
// ball.glsl and stamp.glsl call both functions. They use few divisions and roots, because a software renderer runs them
// several times at each pixel near the tool.

// Returns the share of the sun's light that the tool takes. Close behind the tool it takes all light. The shadow widens
// and fades with the distance, and ends. `square`: squared distance from the centre [radius²]. `along`: distance behind
// the tool, away from the sun [radius]. `far`: `along` in the scene [longest half axis].
float shadowOf(float square, float along, float far) {
    float miss = sqrt(max(square - along * along, 0.0));
    float blur = kPenumbra.x + kPenumbra.y * max(far, 0.0);
    float behind = smoothstep(-0.2, 0.2, along) * (1.0 - smoothstep(2.0, kShadowLength, far));
    return (1.0 - smoothstep(1.0 - blur, 1.0 + blur, miss)) * behind;
}

// Returns the share of the surrounding light that the tool takes: the share of the sky that a ball hides (its solid
// angle times the cosine). At a cosine of 0 it is still 0.4 of the solid angle, for sand beside the ball. It is 0 from
// kToolReach on. `nearer`: 1 / distance from the centre, at most 1 [1/radius].
float occlusionOf(float nearer, float cosine) {
    const float kAtReach = 1.0 / (kToolReach * kToolReach);
    float near = max(nearer * nearer - kAtReach, 0.0) * (1.0 / (1.0 - kAtReach));
    return clamp(0.4 + 0.6 * cosine, 0.0, 1.0) * near * (0.75 + 0.25 * near);
}

// Returns the light from a rough surface under a share of the sun, and under the sky. If little sky is visible, the
// sand around reflects light onto the surface.
vec3 lit(vec3 albedo, vec3 normal, float open, float sunny) {
    float sun = max(dot(normal, uSun), 0.0) * sunny;
    vec3 sky = kSkylight * ((0.75 + 0.25 * normal.z) * open);
    vec3 bounce = kSunlight * albedo * (0.35 * (1.0 - open) + 0.15 * (1.0 - normal.z) + 0.04);
    return albedo * (kSunlight * sun + sky + bounce);
}

// Returns the sRGB value of linear light, within half a level. It uses the well-known sum of roots, because a power
// costs a software renderer more.
vec3 encode(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    vec3 a = sqrt(c);
    vec3 b = sqrt(a);
    vec3 d = sqrt(b);
    return 0.662002687 * a + 0.684122060 * b - 0.323583601 * d - 0.0225411470 * c;
}

// Returns the place of a point in the grain texture: its place as seen from above, shifted a little by its height.
// Without the shift, a bank that is upright for a moment would show stripes. A larger shift would stretch the grain on
// slopes.
vec2 grainAt(vec3 place) { return (place.xy + place.z * vec2(0.20, 0.15)) * uGrainScale; }

// Returns the mip level at which the grain is drawn: log2 of the texels along the longest side of a pixel, minus half a
// level, with a random offset of up to half a level.
//
// The subtraction keeps grains visible across the pixel. The offset hides the borders between levels. The level is
// computed at vertices, because values that come from neighbouring pixels are rounded differently in the next tile.
float grainLevel(vec3 place, vec3 normal) {
    vec2 slope = normal.xy / max(normal.z, 0.2);
    vec4 at = uSceneToClip * vec4(place, 1.0);
    vec4 east = uSceneToClip * vec4(1.0, 0.0, -slope.x, 0.0);
    vec4 north = uSceneToClip * vec4(0.0, 1.0, -slope.y, 0.0);
    float far = max(abs(at.w), 1e-6);
    // Pixels per scene unit along the ground; below, the inverse.
    vec2 x = (east.xy - at.xy * (east.w / far)) * (uHalfPicture / far);
    vec2 y = (north.xy - at.xy * (north.w / far)) * (uHalfPicture / far);
    float longest = sqrt(max(x.x * x.x + y.x * y.x, x.y * x.y + y.y * y.y));
    float units = longest / max(abs(x.x * y.y - x.y * y.x), 1e-6);
    float texels = units * uGrainScale * float(textureSize(uGrain, 0).x);
    uint hash = (floatBitsToUint(place.x) * 0x9e3779b1u + floatBitsToUint(place.y)) * 0x85ebca6bu;
    hash = (hash ^ (hash >> 15)) * 0xc2b2ae35u;
    return log2(max(texels, 1e-3)) - 1.0 + float(hash >> 8) / 16777216.0;
}
