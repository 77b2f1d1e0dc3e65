// SPDX-License-Identifier: Apache-2.0
// The light that a tool of any other shape than a ball's takes, in place of ball.glsl: about that of an ellipsoid, which
// is a ball again where space is stretched. uTool is its centre and its longest half axis.
uniform mat3 uToolSpace;  // from the scene to where it has radius 1
uniform vec3 uToolSun;    // towards the sun there, of length 1
uniform float uToolStep;  // longest half axes in the scene for a radius along that, at most 1

float toolShadow(vec3 place) {
    vec3 away = uToolSpace * (uTool.xyz - place);
    float along = dot(away, uToolSun);
    float miss = sqrt(max(dot(away, away) - along * along, 0.0));
    float far = along * uToolStep;
    float blur = kPenumbra.x + kPenumbra.y * max(far, 0.0);
    float behind = smoothstep(-0.2, 0.2, along) * (1.0 - smoothstep(2.0, kShadowLength, far));
    return (1.0 - smoothstep(1.0 - blur, 1.0 + blur, miss)) * behind;
}

float toolOcclusion(vec3 place, vec3 normal) {
    vec3 direct = uTool.xyz - place;
    vec3 away = uToolSpace * direct;
    float square = max(dot(away, away), 1.0);
    float facing = clamp(0.4 + 0.6 * dot(normal, direct) * inversesqrt(max(dot(direct, direct), 1e-20)), 0.0, 1.0);
    float near = toolNearness(square);
    return facing * near * (0.75 + 0.25 * near);
}
