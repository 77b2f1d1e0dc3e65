// SPDX-License-Identifier: Apache-2.0
// Places the vertices of a grid. The heights come as a texture, so normal, open sky and mottling are computed here. With
// HOLE_EDGES it places the vertices beside cells without ground: each is the mean of vertices of the grid.
uniform highp isampler2D uHeights; // [unit]
uniform highp isampler2D uStart;   // [unit], at the session's start
uniform highp isampler2D uHoles;   // 1 for a cell without ground; a single 0 if all cells have ground
uniform sampler2D uMottling;
uniform ivec2 uSize;               // columns and rows
uniform float uUnit;               // scene unit
uniform float uCell;               // scene unit
uniform float uCutAndFill;         // 1: sand that has gone is blue, and sand that has come is red
#ifdef HOLE_EDGES
in vec3 position;                  // [half a cell]
in vec4 from;                      // numbers of vertices, or -1
#endif

struct Vertex {
    float height, gone;
    vec2 normal;                   // east and north
    float open, mottling;
};

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

// Returns a neighbour for the slope of `cell`, which is one-sided at the rim and beside a hole.
ivec2 neighbour(ivec2 cell, ivec2 step) {
    ivec2 there = clamp(cell + step, ivec2(0), uSize - 1);
    bool hole = textureSize(uHoles, 0) == uSize && texelFetch(uHoles, there, 0).r != 0;
    return hole ? cell : there;
}

Vertex vertexAt(int number) {
    ivec2 cell = clamp(ivec2(number % (uSize.x + 2), number / (uSize.x + 2)) - 1, ivec2(0), uSize - 1);
    ivec2 west = neighbour(cell, ivec2(-1, 0)), east = neighbour(cell, ivec2(1, 0));
    ivec2 south = neighbour(cell, ivec2(0, -1)), north = neighbour(cell, ivec2(0, 1));
    vec2 rise = vec2(heightAt(east) - heightAt(west), heightAt(north) - heightAt(south));
    float here = heightAt(cell);
    vec3 normal = normalize(vec3(-rise / (vec2(max(east.x - west.x, 1), max(north.y - south.y, 1)) * uCell), 1.0));
    return Vertex(here, float(texelFetch(uStart, cell, 0).r) * uUnit - here, normal.xy, openSky(cell, here),
                  texelFetch(uMottling, cell & 255, 0).b);
}

void main() {
#ifdef HOLE_EDGES
    Vertex vertex = Vertex(0.0, 0.0, vec2(0.0), 0.0, 0.0);
    float count = 0.0;
    for (int i = 0; i < 4; ++i) {
        if (from[i] >= 0.0) {
            Vertex one = vertexAt(int(from[i]));
            vertex = Vertex(vertex.height + one.height, vertex.gone + one.gone, vertex.normal + one.normal, vertex.open + one.open,
                            vertex.mottling + one.mottling);
            count += 1.0;
        }
    }
    vertex = Vertex(vertex.height / count, vertex.gone / count, vertex.normal / count, vertex.open / count, vertex.mottling / count);
    vec2 place = position.xy / 2.0;
#else
    Vertex vertex = vertexAt(gl_VertexID);
    vec2 place = vec2(gl_VertexID % (uSize.x + 2), gl_VertexID / (uSize.x + 2));
#endif
    place = clamp(place - 0.5, vec2(0.0), vec2(uSize)) * uCell;
    vec3 normal = vec3(vertex.normal, sqrt(max(1.0 - dot(vertex.normal, vertex.normal), 0.0)));
    lightVertex(vec3(place, vertex.height), normal, vertex.open, vertex.mottling);
    float much = uCutAndFill * clamp(abs(vertex.gone) / (2.0 * uCell), 0.0, 1.0);
    vec3 tint = vertex.gone > 0.0 ? vec3(0.12, 0.35, 0.95) : vec3(0.95, 0.22, 0.10);
    vColour.rgb = mix(vColour.rgb, tint * (0.25 + dot(vColour.rgb, vec3(0.3, 0.5, 0.2))), much);
    vInShadow = mix(vInShadow, vColour.rgb * 0.6, much);
}
