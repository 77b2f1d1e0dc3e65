// SPDX-License-Identifier: Apache-2.0
// The texture of the sand's grain: the numbers of makeGrain() in render_node/gl/grain_texture.cpp.

const kSide = 256;
const kMask = kSide - 1;

export interface GrainLevel {
    data: Uint8Array;
    width: number;
    height: number;
}

function hashAt(x: number, y: number, seed: number): number {
    let h = (Math.imul(x, 0x9e3779b1) + Math.imul(y, 0x85ebca6b) + seed) | 0;
    h = Math.imul(h ^ (h >>> 16), 0x85ebca6b);
    h = Math.imul(h ^ (h >>> 13), 0xc2b2ae35);
    return (h ^ (h >>> 16)) & 255;
}

function bump(x: number, y: number): number {
    const weights = [1, 2, 1];
    let sum = 0;
    for (let j = 0; j < 3; ++j) {
        for (let i = 0; i < 3; ++i) {
            sum += weights[i] * weights[j] * hashAt((x + i - 1) & kMask, (y + j - 1) & kMask, 1);
        }
    }
    return sum;
}

/** Noise that changes over `size` texels. */
function slow(x: number, y: number, size: number, seed: number): number {
    const n = kSide / size;
    const at = (i: number, j: number) => hashAt(i & (n - 1), j & (n - 1), seed);
    const i = Math.floor(x / size), j = Math.floor(y / size), tx = x % size, ty = y % size;
    const south = at(i, j) * (size - tx) + at(i + 1, j) * tx;
    const north = at(i, j + 1) * (size - tx) + at(i + 1, j + 1) * tx;
    return Math.trunc((south * (size - ty) + north * ty) / (size * size));
}

const byte = (n: number) => Math.max(0, Math.min(255, n));

function finest(sun: [number, number]): Float32Array {
    const length = Math.max(Math.hypot(sun[0], sun[1]), 1e-6), east = sun[0] / length, north = sun[1] / length;
    const texels = new Float32Array(kSide * kSide * 4);
    for (let y = 0, k = 0; y < kSide; ++y) {
        for (let x = 0; x < kSide; ++x, k += 4) {
            const kind = hashAt(x, y, 7), odd = kind < 8 ? -48 : kind > 247 ? 40 : 0;
            const slope = (bump(x + 1, y) - bump(x - 1, y)) * east + (bump(x, y + 1) - bump(x, y - 1)) * north;
            texels[k] = byte(128 + Math.trunc((hashAt(x, y, 3) - 128) / 6) + odd + Math.trunc((slow(x, y, 4, 5) - 128) / 10));
            texels[k + 1] = byte(128 - Math.trunc(slope / 12));
            texels[k + 2] = byte(Math.trunc((4 * slow(x, y, 64, 11) + 3 * slow(x, y, 32, 12) + 2 * slow(x, y, 16, 13) + slow(x, y, 8, 14)) / 10));
            texels[k + 3] = 255;
        }
    }
    return texels;
}

function halved(from: Float32Array, side: number): Float32Array {
    const half = new Float32Array((side / 2) ** 2 * 4);
    for (let y = 0, k = 0; y < side; y += 2) {
        for (let x = 0; x < side; x += 2) {
            const at = (y * side + x) * 4, above = at + side * 4;
            for (let c = 0; c < 4; ++c, ++k) {
                half[k] = (from[at + c] + from[at + 4 + c] + from[above + c] + from[above + 4 + c]) / 4;
            }
        }
    }
    return half;
}

/** Returns the grain and its mip levels. `sun` is the direction to the sun, east and north. */
export function makeGrain(sun: [number, number]): GrainLevel[] {
    const levels: GrainLevel[] = [];
    let texels = finest(sun);
    for (let side = kSide, level = 0; side >= 1; side /= 2, ++level) {
        const contrast = level === 0 ? 1 : 1.1 * 1.35 ** (level - 1);
        const data = Uint8Array.from(texels, (v, i) => byte(Math.round(i % 4 < 2 ? 127.5 + contrast * (v - 127.5) : v)));
        levels.push({ data, width: side, height: side });
        if (side > 1) {
            texels = halved(texels, side);
        }
    }
    return levels;
}
