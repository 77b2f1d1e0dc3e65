// SPDX-License-Identifier: Apache-2.0
// The box around the sand: its cut sides down to a floor, the boards and the floor, as render_node/sand_box.cpp makes them.
import { BufferAttribute, BufferGeometry } from "three";
import type { Point } from "./grid_field";

const kThickness = 0.015;  // of boards and floor [share of the field's longer side]

/** Quads with the attributes of solid.vert.glsl. The grain of wood runs along their longest axis. */
class Quads {
    private readonly positions: number[] = [];
    private readonly normals: number[] = [];
    private readonly along: number[] = [];

    /** The corners are counter-clockwise from outside. */
    add(corners: Point[]): void {
        const minus = (a: Point, b: Point): Point => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        const cross = (a: Point, b: Point): Point => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        const dot = (a: Point, b: Point) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        const unit = (a: Point): Point => {
            const length = Math.sqrt(dot(a, a));
            return [a[0] / length, a[1] / length, a[2] / length];
        };
        const first = minus(corners[1], corners[0]), second = minus(corners[3], corners[0]);
        const normal = unit(cross(first, second)), grain = unit(dot(first, first) >= dot(second, second) ? first : second), across = cross(normal, grain);
        for (const i of [0, 1, 2, 0, 2, 3]) {
            this.positions.push(...corners[i]);
            this.normals.push(...normal);
            this.along.push(dot(corners[i], grain), dot(corners[i], across));
        }
    }
    block(low: Point, high: Point): void {
        const at = (x: number, y: number, z: number): Point => [x ? high[0] : low[0], y ? high[1] : low[1], z ? high[2] : low[2]];
        this.add([at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)]);
        this.add([at(0, 1, 0), at(1, 1, 0), at(1, 0, 0), at(0, 0, 0)]);
        this.add([at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)]);
        this.add([at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1)]);
        this.add([at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1)]);
        this.add([at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)]);
    }
    geometry(): BufferGeometry {
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new BufferAttribute(new Float32Array(this.positions), 3));
        geometry.setAttribute("normal", new BufferAttribute(new Float32Array(this.normals), 3));
        geometry.setAttribute("along", new BufferAttribute(new Float32Array(this.along), 2));
        return geometry;
    }
}

export class SandBox {
    private readonly floor: number;
    readonly boards: BufferGeometry;

    /** `edge` are the cuts at the field's edge, and `lowest` is the lowest height of the sand [scene unit, all]. */
    constructor(width: number, depth: number, edge: Point[][], lowest: number, withBoards: boolean) {
        const heights = edge.flat().map((place) => place[2]), side = Math.max(width, depth), thick = kThickness * side;
        const least = heights.length > 0 ? heights.reduce((a, b) => Math.min(a, b)) : lowest, most = heights.length > 0 ? heights.reduce((a, b) => Math.max(a, b)) : lowest;
        const floor = this.floor = lowest - 0.06 * side;
        // A little higher than the sand at the rim, but low enough not to hide mountains.
        const top = Math.min(most + 0.006 * side, least + 0.045 * side);
        const quads = new Quads();
        if (withBoards) {
            quads.block([-thick, -thick, floor], [width + thick, 0, top]);
            quads.block([-thick, depth, floor], [width + thick, depth + thick, top]);
            quads.block([-thick, 0, floor], [0, depth, top]);
            quads.block([width, 0, floor], [width + thick, depth, top]);
        }
        quads.block([-thick, -thick, floor - thick], [width + thick, depth + thick, floor]);
        this.boards = quads.geometry();
    }
    /** Returns the sides of sand that is cut along these lines. */
    sides(cuts: Point[][]): BufferGeometry {
        const quads = new Quads(), top = (place: Point) => Math.max(this.floor, place[2]);
        for (const line of cuts) {
            for (let i = 0; i + 1 < line.length; ++i) {
                const from = line[i], to = line[i + 1];
                quads.add([[from[0], from[1], this.floor], [to[0], to[1], this.floor], [to[0], to[1], top(to)], [from[0], from[1], top(from)]]);
            }
        }
        return quads.geometry();
    }
}
