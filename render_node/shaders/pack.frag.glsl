// SPDX-License-Identifier: Apache-2.0
// Each pixel, or channel, from one eye's picture as it is.
uniform sampler2D uLeft;
uniform sampler2D uRight;
uniform int uHeight;        // [pixel]
uniform int uOddColumns;    // 1: every other column changes eyes as well as every other row
uniform int uChannels;      // 1: the left eye's red with the right eye's green and blue, whatever the row
out vec4 oColour;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 left = texelFetch(uLeft, at, 0).rgb;
    vec3 right = texelFetch(uRight, at, 0).rgb;
    int row = uHeight - 1 - at.y;  // rows count from the top
    bool odd = ((row + uOddColumns * at.x) & 1) == 1;
    oColour = vec4(uChannels == 1 ? vec3(left.r, right.gb) : odd ? right : left, 1.0);
}
