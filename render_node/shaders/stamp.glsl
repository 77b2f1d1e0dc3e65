// SPDX-License-Identifier: Apache-2.0
// The light that a tool of any other shape than a ball's takes, in place of ball.glsl: about that of an ellipsoid, which
// is a ball again where space is stretched. uTool is its centre.
uniform mat3 uToolSpace;  // from the scene to where it has radius 1
uniform vec3 uToolSun;    // towards the sun there, of length 1
uniform float uToolStep;  // longest half axes in the scene for a radius along that, at most 1

vec2 toolTakes(vec3 place, vec3 normal) {
    vec3 direct = uTool.xyz - place;
    vec3 away = uToolSpace * direct;
    float square = dot(away, away);
    float along = dot(away, uToolSun);
    float cosine = dot(normal, direct) * inversesqrt(max(dot(direct, direct), 1e-20));
    return vec2(shadowOf(square, along, along * uToolStep), occlusionOf(inversesqrt(max(square, 1.0)), cosine));
}
