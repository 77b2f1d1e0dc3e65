// SPDX-License-Identifier: Apache-2.0
// Computes the light that a ball takes away. stamp.glsl has the same function for tools of other shapes.

// Returns the shares of the sun's light and of the surrounding light that the tool takes. `normal` has about length 1.
vec2 toolTakes(vec3 place, vec3 normal) {
    vec3 away = (uTool.xyz - place) * uTool.w;
    float square = dot(away, away);
    float along = dot(away, uSun);
    float nearer = inversesqrt(max(square, 1.0));
    return vec2(shadowOf(square, along, along), occlusionOf(nearer, dot(normal, away) * nearer));
}
