// SPDX-License-Identifier: Apache-2.0
layout(location = 0) in vec2 aAt;  // pixels from the top left
layout(location = 1) in vec3 aColour;

uniform vec2 uSize;  // size of the target [pixel]

flat out vec3 vColour;

void main() {
    vColour = aColour;
    gl_Position = vec4(2.0 * aAt.x / uSize.x - 1.0, 1.0 - 2.0 * aAt.y / uSize.y, 0.0, 1.0);
}
