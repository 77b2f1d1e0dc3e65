// SPDX-License-Identifier: Apache-2.0
// The triangles and cut edges of a grid, as render_node/grid/{hole_edges,rim}.cpp makes them. Vertex (x, y) of the mesh lies over
// cell (x - 1, y - 1); the outermost ones lie on the field's edge.
import { BufferAttribute, BufferGeometry } from "three";
import { kUnitsPerCell } from "./messages";

export type Point = [number, number, number];

/** A place [scene unit] at which sand is cut. Its height is the mean of these cells. */
interface CutPlace {
    x: number;
    y: number;
    cells: number[];
}

/** A grid's cells and which of them have no ground. */
export class GridField {
    readonly across: number;  // vertices
    readonly down: number;
    private readonly cutsAtHoles: CutPlace[][];

    /** `holes` has one byte for each cell, or is undefined if all have ground. `cell` is in scene units. */
    constructor(private readonly columns: number, private readonly rows: number, private readonly cell: number, private readonly holes?: Uint8Array) {
        this.across = columns + 2;
        this.down = rows + 2;
        this.cutsAtHoles = holes ? this.placesAtHoles() : [];
    }

    private clamped(column: number, row: number): number {
        const x = Math.max(0, Math.min(this.columns - 1, column)), y = Math.max(0, Math.min(this.rows - 1, row));
        return y * this.columns + x;
    }
    isHole(column: number, row: number): boolean { return this.holes !== undefined && this.holes[this.clamped(column, row)] !== 0; }

    /** Returns the triangles of all quads whose four cells have ground. The diagonals alternate. */
    index(): Uint32Array {
        const index = new Uint32Array((this.across - 1) * (this.down - 1) * 6);
        let k = 0;
        for (let y = 0; y + 1 < this.down; ++y) {
            for (let x = 0; x + 1 < this.across; ++x) {
                if (this.holes && this.groundOf(x, y).includes(false)) {
                    continue;
                }
                const a = y * this.across + x, b = a + 1, c = b + this.across, d = a + this.across;
                index.set((x + y) % 2 === 0 ? [a, b, c, a, c, d] : [a, b, d, b, c, d], k);
                k += 6;
            }
        }
        return index.subarray(0, k);
    }
    private groundOf(x: number, y: number): boolean[] {
        return [[0, 0], [1, 0], [1, 1], [0, 1]].map(([east, north]) => !this.isHole(x + east - 1, y + north - 1));
    }

    /** Returns triangles beside holes. Each vertex has its place [half a cell] and the vertices whose mean it is, or -1. */
    holeEdges(): BufferGeometry | undefined {
        const places: number[] = [], from: number[] = [];
        for (let y = 0; this.holes && y + 1 < this.down; ++y) {
            for (let x = 0; x + 1 < this.across; ++x) {
                const ground = this.groundOf(x, y), count = ground.filter((is) => is).length;
                if (count === 0 || count === 4) {
                    continue;
                }
                const opposite = ground[0] === ground[2] && ground[1] === ground[3];
                for (const piece of opposite ? ground.map((is, i) => ground.map((_, j) => is && i === j)) : [ground]) {
                    if (piece.includes(true)) {
                        this.addPiece(x, y, piece, places, from);
                    }
                }
            }
        }
        if (places.length === 0) {
            return undefined;
        }
        const geometry = new BufferGeometry();
        geometry.setAttribute("position", new BufferAttribute(new Float32Array(places), 3));
        geometry.setAttribute("from", new BufferAttribute(new Float32Array(from), 4));
        return geometry;
    }
    /** Adds the quarters of a quad that belong to the cells `ground`, as a fan around its middle. */
    private addPiece(x: number, y: number, ground: boolean[], places: number[], from: number[]): void {
        const a = y * this.across + x, corners = [a, a + 1, a + 1 + this.across, a + this.across];
        const place = (corner: number) => [2 * (corner % this.across), 2 * Math.floor(corner / this.across)];
        const vertex = (at: number[], sources: number[]) => {
            const sum = at.map((i) => place(corners[i])).reduce(([e, n], [east, north]) => [e + east, n + north], [0, 0]);
            return { place: [sum[0] / at.length, sum[1] / at.length, 0], from: [0, 1, 2, 3].map((i) => (i < sources.length ? corners[sources[i]] : -1)) };
        };
        const middle = vertex([0, 1, 2, 3], [0, 1, 2, 3].filter((i) => ground[i]));
        const add = (...vertices: { place: number[]; from: number[] }[]) => {
            for (const { place: at, from: sources } of vertices) {
                places.push(...at);
                from.push(...sources);
            }
        };
        for (let i = 0; i < 4; ++i) {
            const next = (i + 1) % 4;
            if (ground[i] && ground[next]) {
                add(middle, vertex([i], [i]), vertex([next], [next]));
            } else if (ground[i]) {
                add(middle, vertex([i], [i]), vertex([i, next], [i]));
            } else if (ground[next]) {
                add(middle, vertex([i, next], [next]), vertex([next], [next]));
            }
        }
    }

    /** Returns the lines along which the sand is cut [scene unit]. The sand is on their left. */
    cuts(heights: Int32Array): { edge: Point[][]; holes: Point[][] } {
        const height = (cell: number) => heights[cell] * this.cell / kUnitsPerCell;
        const mean = (cells: number[]) => cells.reduce((sum, cell) => sum + height(cell), 0) / cells.length;
        return {
            edge: this.fieldEdges((column, row) => height(this.clamped(column, row))),
            holes: this.cutsAtHoles.map((line) => line.map(({ x, y, cells }): Point => [x, y, mean(cells)])),
        };
    }
    private fieldEdges(height: (column: number, row: number) => number): Point[][] {
        const corners = [[0, 0], [this.columns + 1, 0], [this.columns + 1, this.rows + 1], [0, this.rows + 1], [0, 0]];
        const along = (vertex: number, cells: number) => Math.max(0, Math.min(cells, vertex - 0.5)) * this.cell;
        const lines: Point[][] = [];
        for (let side = 0; side < 4; ++side) {
            const [fromX, fromY] = corners[side], [toX, toY] = corners[side + 1], stepX = Math.sign(toX - fromX), stepY = Math.sign(toY - fromY);
            let line: Point[] = [];
            const end = () => {
                if (line.length > 1) {
                    lines.push(line);
                }
                line = [];
            };
            for (let x = fromX, y = fromY; ; x += stepX, y += stepY) {
                const last = x === toX && y === toY, here = height(x - 1, y - 1);
                const place = (i: number, j: number) => [along(i, this.columns), along(j, this.rows)];
                const between = (i: number, j: number): Point => [(place(x, y)[0] + place(i, j)[0]) / 2, (place(x, y)[1] + place(i, j)[1]) / 2, here];
                if (this.isHole(x - 1, y - 1)) {
                    end();
                } else {
                    if (line.length === 0 && (x !== fromX || y !== fromY)) {
                        line.push(between(x - stepX, y - stepY));
                    }
                    line.push([...place(x, y), here] as Point);
                    if (!last && this.isHole(x + stepX - 1, y + stepY - 1)) {
                        line.push(between(x + stepX, y + stepY));
                    }
                }
                if (last) {
                    break;
                }
            }
            end();
        }
        return lines;
    }
    /** Returns the lines along the sides of all cells that lie beside a hole. */
    private placesAtHoles(): CutPlace[][] {
        const lines: CutPlace[][] = [];
        // Direction to a neighbour, and the corners of the edge before it [half a cell].
        const faces = [[1, 0, 1, -1, 1, 1], [0, 1, 1, 1, -1, 1], [-1, 0, -1, 1, -1, -1], [0, -1, -1, -1, 1, -1]];
        for (let row = 0; row < this.rows; ++row) {
            for (let column = 0; column < this.columns; ++column) {
                for (const [east, north, x0, y0, x1, y1] of this.isHole(column, row) ? [] : faces) {
                    if (this.isHole(column + east, row + north)) {
                        const at = (x: number, y: number, cells: number[]) => ({ x: (column + (1 + x) / 2) * this.cell, y: (row + (1 + y) / 2) * this.cell, cells });
                        const corner = (x: number, y: number) => at(x, y, this.cellsAround(column, row, column + (x - 1) / 2, row + (y - 1) / 2));
                        lines.push([corner(x0, y0), at(east, north, [this.clamped(column, row)]), corner(x1, y1)]);
                    }
                }
            }
        }
        return lines;
    }
    /** Returns the cells with ground around a corner of a cell. Two that are opposite do not join: then, only the cell. */
    private cellsAround(column: number, row: number, x: number, y: number): number[] {
        const cells = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]], ground = cells.map(([i, j]) => !this.isHole(i, j));
        if (ground[0] === ground[2] && ground[1] === ground[3] && ground[0] !== ground[1]) {
            return [this.clamped(column, row)];
        }
        return cells.filter((_, i) => ground[i]).map(([i, j]) => this.clamped(i, j));
    }
}
