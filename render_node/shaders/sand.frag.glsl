// SPDX-License-Identifier: Apache-2.0
// Draws sand that the tool does not reach.
in vec4 vColour;
in vec2 vGrainAt;
in float vGrainLevel;
out vec4 oColour;

void main() { oColour = vec4(grained(vColour, textureLod(uGrain, vGrainAt, vGrainLevel)), 1.0); }
