// SPDX-License-Identifier: Apache-2.0
// Copies each pixel, or each channel, unchanged from one eye's picture.
uniform sampler2D uLeft;
uniform sampler2D uRight;
uniform int uHeight;        // [pixel]
uniform int uOddColumns;    // 1: eyes change with every column and every row; 0: with every row only
uniform int uChannels;      // 1: red from the left eye, green and blue from the right, in every row
out vec4 oColour;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 left = texelFetch(uLeft, at, 0).rgb;
    vec3 right = texelFetch(uRight, at, 0).rgb;
    int row = uHeight - 1 - at.y;  // rows count from the top
    bool odd = ((row + uOddColumns * at.x) & 1) == 1;
    oColour = vec4(uChannels == 1 ? vec3(left.r, right.gb) : odd ? right : left, 1.0);
}
