// SPDX-License-Identifier: Apache-2.0
// Mixes both eyes in linear light, in whole numbers. The result equals pictures/stereo_packing.cpp bit for bit. The
// tables are uniforms, because reading a texel takes a software renderer much longer.
uniform sampler2D uLeft;
uniform sampler2D uRight;
uniform uint uLights[128];  // linear light of each level; two levels per number, the even one in the lower half
uniform uint uFirst[128];   // least light that is shown as each level; two levels per number, as in uLights
uniform mat4 uFromLeft;     // weights [2^-14]; the column is the output channel, the row the input channel
uniform mat4 uFromRight;
out vec4 oColour;

int lightOf(int level) { return int((uLights[level >> 1] >> ((level & 1) << 4)) & 65535u); }
int firstOf(int level) { return int((uFirst[level >> 1] >> ((level & 1) << 4)) & 65535u); }

// On any graphics card, pow() gives a result that is at most one level off. The table then gives the exact level.
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
