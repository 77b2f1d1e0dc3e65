// SPDX-License-Identifier: Apache-2.0
// Copies a picture to the pixels from uCorner on.
uniform sampler2D uPanel;
uniform ivec2 uCorner;  // lower left pixel
out vec4 oColour;

void main() { oColour = vec4(texelFetch(uPanel, ivec2(gl_FragCoord.xy) - uCorner, 0).rgb, 1.0); }
