// SPDX-License-Identifier: Apache-2.0
// Computes the light that a tool takes away if it is not a ball. Replaces ball.glsl. The tool is approximated by an
// ellipsoid, which becomes a ball when space is stretched. uTool is its centre.
uniform mat3 uToolSpace;  // from the scene to the stretched space, where the radius is 1
uniform vec3 uToolSun;    // towards the sun in the stretched space, of length 1
uniform float uToolStep;  // length in the scene of one radius along uToolSun, at most 1 [longest half axis]

vec2 toolTakes(vec3 place, vec3 normal) {
    vec3 direct = uTool.xyz - place;
    vec3 away = uToolSpace * direct;
    float square = dot(away, away);
    float along = dot(away, uToolSun);
    float cosine = dot(normal, direct) * inversesqrt(max(dot(direct, direct), 1e-20));
    return vec2(shadowOf(square, along, along * uToolStep), occlusionOf(inversesqrt(max(square, 1.0)), cosine));
}
