// SPDX-License-Identifier: Apache-2.0
// Places the vertices of a grid. The heights come as a texture, so normal, open sky and mottling are computed here.
uniform highp isampler2D uHeights; // [unit]
uniform highp isampler2D uStart;   // [unit], at the session's start
uniform sampler2D uMottling;
uniform ivec2 uSize;               // columns and rows
uniform float uUnit;               // scene unit
uniform float uCell;               // scene unit
uniform float uCutAndFill;         // 1: sand that has gone is blue, and sand that has come is red

float heightAt(ivec2 cell) {
    return float(texelFetch(uHeights, clamp(cell, ivec2(0), uSize - 1), 0).r) * uUnit;
}

// The share of open sky around a cell, as render_node/surface/open_sky.hpp computes it.
float openSky(ivec2 cell, float here) {
    const int kDistances[3] = int[3](2, 5, 10); // [cell]
    float covered = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            if (x == 0 && y == 0) {
                continue;
            }
            float reach = x != 0 && y != 0 ? 1.41421356 : 1.0;
            float steepest = 0.0;
            for (int i = 0; i < 3; ++i) {
                float rise = heightAt(cell + ivec2(x, y) * kDistances[i]) - here;
                steepest = max(steepest, rise / (reach * float(kDistances[i])));
            }
            float square = steepest / uCell * (steepest / uCell);
            covered += square / (1.0 + square);
        }
    }
    return 1.0 - covered / 8.0;
}

void main() {
    ivec2 vertex = ivec2(gl_VertexID % (uSize.x + 2), gl_VertexID / (uSize.x + 2));
    ivec2 cell = clamp(vertex - 1, ivec2(0), uSize - 1);
    ivec2 low = max(cell - 1, ivec2(0)), high = min(cell + 1, uSize - 1);
    vec2 rise = vec2(heightAt(ivec2(high.x, cell.y)) - heightAt(ivec2(low.x, cell.y)),
                     heightAt(ivec2(cell.x, high.y)) - heightAt(ivec2(cell.x, low.y)));
    float here = heightAt(cell);
    vec3 normal = normalize(vec3(-rise / (vec2(max(high - low, ivec2(1))) * uCell), 1.0));
    vec3 place = vec3(clamp(vec2(vertex) - 0.5, vec2(0.0), vec2(uSize)) * uCell, here);
    lightVertex(place, normal, openSky(cell, here), texelFetch(uMottling, cell & 255, 0).b);
    float gone = float(texelFetch(uStart, cell, 0).r) * uUnit - here;
    float much = uCutAndFill * clamp(abs(gone) / (2.0 * uCell), 0.0, 1.0);
    vec3 tint = gone > 0.0 ? vec3(0.12, 0.35, 0.95) : vec3(0.95, 0.22, 0.10);
    vColour.rgb = mix(vColour.rgb, tint * (0.25 + dot(vColour.rgb, vec3(0.3, 0.5, 0.2))), much);
    vInShadow = mix(vInShadow, vColour.rgb * 0.6, much);
}
