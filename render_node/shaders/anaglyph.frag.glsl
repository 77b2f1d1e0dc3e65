// SPDX-License-Identifier: Apache-2.0
// Mixes the eyes in linear light, in whole numbers as pictures/stereo_packing.cpp does: equal to the bit.
// Tables are uniforms and no textures: a software renderer takes much longer for a texel.
uniform sampler2D uLeft;
uniform sampler2D uRight;
uniform uint uLights[128];  // linear light of each level, two to a number, the even level's in the lower half
uniform uint uFirst[128];   // the least light that is shown as each level, likewise
uniform mat4 uFromLeft;     // weights, 2^-14: column to, row from
uniform mat4 uFromRight;
out vec4 oColour;

int lightOf(int level) { return int((uLights[level >> 1] >> ((level & 1) << 4)) & 65535u); }
int firstOf(int level) { return int((uFirst[level >> 1] >> ((level & 1) << 4)) & 65535u); }

// A power is near enough to be a level off at most, on any graphics card; the table says which it is.
int levelOf(int light) {
    float share = float(light) / 65535.0;
    float coded = share <= 0.0031308 ? 12.92 * share : 1.055 * pow(share, 1.0 / 2.4) - 0.055;
    int near = clamp(int(coded * 255.0 + 0.5), 1, 254);
    return near + (light >= firstOf(near + 1) ? 1 : 0) - (light < firstOf(near) ? 1 : 0);
}

ivec3 lightOf(vec3 colour) {
    ivec3 level = ivec3(colour * 255.0 + 0.5);
    return ivec3(lightOf(level.r), lightOf(level.g), lightOf(level.b));
}

int mixed(int to, ivec3 left, ivec3 right) {
    ivec3 sums = ivec3(uFromLeft[to].xyz) * left + ivec3(uFromRight[to].xyz) * right;
    return levelOf(clamp((sums.x + sums.y + sums.z + 8192) >> 14, 0, 65535));
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec3 left = lightOf(texelFetch(uLeft, at, 0).rgb);
    ivec3 right = lightOf(texelFetch(uRight, at, 0).rgb);
    ivec3 levels = ivec3(mixed(0, left, right), mixed(1, left, right), mixed(2, left, right));
    oColour = vec4(vec3(levels) / 255.0, 1.0);
}
