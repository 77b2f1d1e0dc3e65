// SPDX-License-Identifier: Apache-2.0
// The light that a ball takes. stamp.glsl has the same functions for tools of other shapes.

// How much of the sun the tool takes: all close behind it; its shadow widens and fades with the distance, and ends.
// Exactly 0 where there is none: what is drawn without asking equals what is drawn with it (ToolReach).
float toolShadow(vec3 place) {
    vec3 away = (uTool.xyz - place) / uTool.w;
    float along = dot(away, uSun);
    float miss = sqrt(max(dot(away, away) - along * along, 0.0));
    float blur = kPenumbra.x + kPenumbra.y * max(along, 0.0);
    float behind = smoothstep(-0.2, 0.2, along) * (1.0 - smoothstep(2.0, kShadowLength, along));
    return (1.0 - smoothstep(1.0 - blur, 1.0 + blur, miss)) * behind;
}

// How much of the light from all around the tool takes: the share of the sky that a ball hides (its solid angle by the
// cosine), no less than a part of it beside the ball, for sand that lies up against it; 0 beyond kToolReach radii.
float toolOcclusion(vec3 place, vec3 normal) {
    vec3 away = (uTool.xyz - place) / uTool.w;
    float square = max(dot(away, away), 1.0);
    float facing = clamp(0.4 + 0.6 * dot(normal, away) * inversesqrt(square), 0.0, 1.0);
    float near = toolNearness(square);
    return facing * near * (0.75 + 0.25 * near);
}
