// SPDX-License-Identifier: Apache-2.0
// Draws lines and circles whose places are metres on the wall, so that each tile shows its part of one drawing.
uniform vec2 uCorner;    // lower left corner of the tile, from the middle of the wall [m]
uniform vec2 uPixel;     // size of a pixel [m]
uniform float uSpacing;  // spacing of the grid [m]
out vec4 oColour;

const float kHalfWidth = 1.0;  // half of a line's width [pixel]

// Returns the share of this pixel that a line covers. The line is `away` [m] from the pixel.
float covered(float away, float pixel) { return clamp(kHalfWidth + 0.5 - abs(away) / pixel, 0.0, 1.0); }

float toNearest(float at, float spacing) { return at - spacing * round(at / spacing); }

void main() {
    vec2 at = uCorner + gl_FragCoord.xy * uPixel;
    float pixel = 0.5 * (uPixel.x + uPixel.y);
    float lines = max(covered(toNearest(at.x, uSpacing), uPixel.x), covered(toNearest(at.y, uSpacing), uPixel.y));
    float cross = max(covered(at.x, uPixel.x), covered(at.y, uPixel.y));
    float diagonals = max(covered((at.x - at.y) * 0.70710678, pixel), covered((at.x + at.y) * 0.70710678, pixel));
    float radius = length(at);
    float circles = radius > uSpacing ? covered(toNearest(radius, 2.0 * uSpacing), pixel) : 0.0;
    vec3 colour = mix(vec3(0.0), vec3(0.42), lines);
    colour = mix(colour, vec3(0.55, 0.75, 0.60), diagonals);
    colour = mix(colour, vec3(1.0, 0.80, 0.30), circles);
    oColour = vec4(mix(colour, vec3(1.0), cross), 1.0);
}
