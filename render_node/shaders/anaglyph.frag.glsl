// SPDX-License-Identifier: Apache-2.0
// Mixes the eyes in linear light, in whole numbers as pictures/stereo_packing.cpp does: equal to the bit.
uniform sampler2D uLeft;
uniform sampler2D uRight;
uniform usampler2D uLights;  // 256 x 1: linear light of each level
uniform usampler2D uLevels;  // 256 x 256: level of each amount of light, row by row
uniform mat4 uFromLeft;      // weights, 2^-14: column to, row from
uniform mat4 uFromRight;
out vec4 oColour;

ivec3 lightOf(vec3 colour) {
    ivec3 level = ivec3(colour * 255.0 + 0.5);
    return ivec3(texelFetch(uLights, ivec2(level.r, 0), 0).r, texelFetch(uLights, ivec2(level.g, 0), 0).r,
                 texelFetch(uLights, ivec2(level.b, 0), 0).r);
}

float mixed(int to, ivec3 left, ivec3 right) {
    ivec3 sums = ivec3(uFromLeft[to].xyz) * left + ivec3(uFromRight[to].xyz) * right;
    int light = clamp((sums.x + sums.y + sums.z + 8192) >> 14, 0, 65535);
    return float(texelFetch(uLevels, ivec2(light & 255, light >> 8), 0).r) / 255.0;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec3 left = lightOf(texelFetch(uLeft, at, 0).rgb);
    ivec3 right = lightOf(texelFetch(uRight, at, 0).rgb);
    oColour = vec4(mixed(0, left, right), mixed(1, left, right), mixed(2, left, right), 1.0);
}
