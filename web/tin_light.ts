// SPDX-License-Identifier: Apache-2.0
// The sky over a TIN and its mottling, as render_node/tin/{light,relief}.cpp computes them. All lengths are in cells.
import type { Point } from "./grid_field";

/** Heights over the middles of the field's cells. */
class Relief {
    private readonly heights: Float32Array;

    constructor(private readonly columns: number, private readonly rows: number) { this.heights = new Float32Array(columns * rows); }

    /** Sets the cells whose middles a triangle covers. Its corners are counter-clockwise. */
    put(places: Float32Array, a: number, b: number, c: number): void {
        const x = [places[3 * a], places[3 * b], places[3 * c]], y = [places[3 * a + 1], places[3 * b + 1], places[3 * c + 1]];
        const area = (i: number, j: number, atX: number, atY: number) => (x[j] - x[i]) * (atY - y[i]) - (y[j] - y[i]) * (atX - x[i]);
        const whole = area(0, 1, x[2], y[2]);
        const first = (along: number[]) => Math.max(0, Math.ceil(Math.min(...along) - 0.5)), last = (along: number[], most: number) => Math.min(most - 1, Math.floor(Math.max(...along) - 0.5));
        for (let row = first(y); row <= last(y, this.rows); ++row) {
            for (let column = first(x); column <= last(x, this.columns); ++column) {
                const ofA = area(1, 2, column + 0.5, row + 0.5), ofB = area(2, 0, column + 0.5, row + 0.5), ofC = area(0, 1, column + 0.5, row + 0.5);
                if (ofA >= 0 && ofB >= 0 && ofC >= 0) {
                    this.heights[row * this.columns + column] = (ofA * places[3 * a + 2] + ofB * places[3 * b + 2] + ofC * places[3 * c + 2]) / whole;
                }
            }
        }
    }
    private cell(column: number, row: number): number {
        return this.heights[Math.max(0, Math.min(this.rows - 1, row)) * this.columns + Math.max(0, Math.min(this.columns - 1, column))];
    }
    /** Returns the height at a place, linear between four middles. */
    at(x: number, y: number): number {
        const column = Math.floor(x - 0.5), row = Math.floor(y - 0.5), east = x - 0.5 - column, north = y - 0.5 - row;
        const below = this.cell(column, row) + east * (this.cell(column + 1, row) - this.cell(column, row));
        const above = this.cell(column, row + 1) + east * (this.cell(column + 1, row + 1) - this.cell(column, row + 1));
        return below + north * (above - below);
    }
}

const kDirections = [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, 1], [1, -1], [-1, -1]];
const kDistances = [2, 5, 10];

function openSky(relief: Relief, x: number, y: number, here: number): number {
    let covered = 0;
    for (const [east, north] of kDirections) {
        let steepest = 0;
        for (const distance of kDistances) {
            const rise = relief.at(x + east * distance, y + north * distance) - here;
            steepest = Math.max(steepest, rise / ((east !== 0 && north !== 0 ? Math.SQRT2 : 1) * distance));
        }
        covered += steepest * steepest / (1 + steepest * steepest);
    }
    return 1 - covered / kDirections.length;
}

/** Returns open sky and mottling of each vertex, 0 to 1. `grain` is the finest level of the grain's texture. */
export function lightTin(places: Float32Array, corners: Uint32Array, columns: number, rows: number, grain: Uint8Array): Float32Array {
    const relief = new Relief(columns, rows), shades = new Float32Array(places.length / 3 * 2);
    for (let i = 0; i < corners.length; i += 3) {
        relief.put(places, corners[i], corners[i + 1], corners[i + 2]);
    }
    const mottling = (column: number, row: number) => grain[4 * ((row & 255) * 256 + (column & 255)) + 2] / 255;
    for (let i = 0; i < places.length / 3; ++i) {
        const [x, y, z] = places.subarray(3 * i, 3 * i + 3);
        shades[2 * i] = Math.round(255 * openSky(relief, x, y, z)) / 255;
        const column = Math.floor(Math.max(0, x - 0.5)), row = Math.floor(Math.max(0, y - 0.5)), east = Math.max(0, x - 0.5) - column, north = Math.max(0, y - 0.5) - row;
        const between = (at: number) => mottling(column, at) * (1 - east) + mottling(column + 1, at) * east;
        shades[2 * i + 1] = between(row) * (1 - north) + between(row + 1) * north;
    }
    return shades;
}

/** Returns the edges with ground on their left only [scene unit]. */
export function cutsOfTin(places: Float32Array, corners: Uint32Array, cell: number): Point[][] {
    const edges = new Map<number, [number, number]>(), vertices = places.length / 3, key = (from: number, to: number) => from * vertices + to;
    for (let i = 0; i < corners.length; i += 3) {
        for (let k = 0; k < 3; ++k) {
            const from = corners[i + k], to = corners[i + (k + 1) % 3];
            if (!edges.delete(key(to, from))) {
                edges.set(key(from, to), [from, to]);
            }
        }
    }
    const place = (vertex: number) => Array.from(places.subarray(3 * vertex, 3 * vertex + 3), (n) => n * cell) as Point;
    return [...edges.values()].map(([from, to]) => [place(from), place(to)]);
}
