// SPDX-License-Identifier: Apache-2.0
// Sand: grains fixed to the scene, so that they do not swim with the head.
in vec3 vScene;
in vec3 vNormal;
in float vOpen;
out vec4 oColour;

void main() {
    // Height shifts the pattern, or steep sides would show stripes.
    vec2 at = (vScene.xy + vScene.z * vec2(0.71, 0.53)) * uGrainScale;
    vec4 grain = texture(uGrain, at);
    float mottling = texture(uGrain, vec2(at.y, -at.x) * 0.083).a;

    vec3 smooth_ = normalize(vNormal);
    vec3 normal = normalize(smooth_ + vec3((grain.gb - 0.5) * 0.9, 0.0));
    // Loose, steep sand has shed its fine pale dust.
    float steep = 1.0 - smooth_.z;
    vec3 albedo = uSand * mix(vec3(1.0), vec3(0.93, 0.86, 0.78), min(steep * 2.5, 1.0));
    albedo *= (0.72 + 0.56 * grain.r) * (0.88 + 0.24 * mottling);
    oColour = vec4(encode(lit(albedo, normal, vOpen * vOpen, lightPastTool(vScene, smooth_))), 1.0);
}
