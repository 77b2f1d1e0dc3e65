// SPDX-License-Identifier: Apache-2.0
// The tools as the wall draws them: the triangles of render_node/tool/mesh.cpp and the light of render_node/tool/light.cpp.
import { BufferAttribute, BufferGeometry, Matrix3, Vector3 } from "three";

type Point = [number, number, number];

/** In the order of sand::ToolKind. */
enum Kind { sphere, circle, rectangle, ellipse, ellipsoid, footprint }

/** A tool at its place, as Replica.tool() returns it. */
export interface Tool {
    place: Vector3;      // [scene unit]
    radius: number;      // [scene unit]
    engaged: boolean;
    kind: number;
    width: number;       // [radius]
    along: [number, number];
    mirrored: boolean;
}

const isRound = (kind: number) => kind === Kind.sphere || kind === Kind.circle;

export function toolOf(numbers: Float32Array, cell: number): Tool {
    const [x, y, z, radius, engaged, kind, halfWidth, east, north, mirrored] = numbers;
    const length = Math.hypot(east, north);
    return {
        place: new Vector3(x, y, z).multiplyScalar(cell), radius: radius * cell, engaged: engaged !== 0, kind,
        width: isRound(kind) || radius === 0 ? 1 : halfWidth / radius, along: [east / length, north / length], mirrored: mirrored !== 0,
    };
}

export const isBall = (tool: Tool) => tool.kind === Kind.sphere;
/** Returns what makes the triangles of tools differ. */
export const shapeOf = (tool: Tool) => [tool.kind, tool.width, ...(isRound(tool.kind) ? [] : [...tool.along, tool.mirrored])].join();

const kPlate = 0.25, kHandle = 0.07, kKnob = 0.16;  // [radius], thickness of plates, radius of the rod and of the ball on it
const kAround = 48, kIn = 4;                        // parts of an ellipse, and rings of the bowl below it

// Along the heading, to its left, half length and half width, lift, bulge: kSole in sand/model/tool_shape.cpp.
const kSole = [
    [-0.69, 0.05, 0.31, 0.62, 0, 0.07], [-0.13, -0.33, 0.52, 0.42, 0.06, 0.05], [0.43, 0.38, 0.27, 0.56, 0.005, 0.06],
    [0.30, -0.33, 0.29, 0.60, 0.01, 0.06], [0.85, 0.56, 0.15, 0.30, 0.015, 0.06], [0.815, 0.11, 0.105, 0.165, 0.03, 0.06],
    [0.755, -0.19, 0.095, 0.15, 0.03, 0.06], [0.675, -0.48, 0.088, 0.14, 0.03, 0.06], [0.575, -0.75, 0.08, 0.13, 0.03, 0.06],
];

const normalized = ([x, y, z]: Point): Point => {
    const length = Math.hypot(x, y, z);
    return [x / length, y / length, z / length];
};

/** Triangles, counter-clockwise from outside, with their normals. */
class Solid {
    readonly positions: number[] = [];
    readonly normals: number[] = [];

    add(position: Point, normal: Point): void {
        this.positions.push(...position);
        this.normals.push(...normal);
    }
    quad(corners: Point[], normals: Point[]): void {
        for (const i of [0, 1, 2, 0, 2, 3]) {
            this.add(corners[i], normals[i]);
        }
    }
    flat(corners: Point[]): void {
        const [a, b, c] = corners.slice(0, 3).map((corner) => new Vector3(...corner));
        const normal = b.sub(a).cross(c.sub(a)).normalize().toArray() as Point;
        this.quad(corners, [normal, normal, normal, normal]);
    }
    box(low: Point, high: Point): void {
        const corner = (i: number): Point => [i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]];
        for (const face of [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]) {
            this.flat(face.map(corner));
        }
    }
    sphere(splits: number, size: Point = [1, 1, 1]): void {
        for (const corner of sphere(splits)) {
            this.add(corner.map((n, i) => n * size[i]) as Point, normalized(corner.map((n, i) => n / size[i]) as Point));
        }
    }
    /** An upright elliptic plate with a bowl below it. */
    plate(middle: [number, number], half: [number, number], lift: number, bulge: number, top: number): void {
        const turn = (i: number) => 2 * Math.PI * i / kAround;
        const at = (i: number, share: number, z: number): Point => [middle[0] + share * half[0] * Math.cos(turn(i)), middle[1] + share * half[1] * Math.sin(turn(i)), z];
        const below = (share: number) => lift - 1 + bulge * share * share;
        const down = (i: number, share: number) => normalized([2 * bulge * share * Math.cos(turn(i)) / half[0], 2 * bulge * share * Math.sin(turn(i)) / half[1], -1]);
        const side = (i: number) => normalized([Math.cos(turn(i)) / half[0], Math.sin(turn(i)) / half[1], 0]);
        for (let i = 0; i < kAround; ++i) {
            this.quad([at(i, 1, below(1)), at(i + 1, 1, below(1)), at(i + 1, 1, top), at(i, 1, top)], [side(i), side(i + 1), side(i + 1), side(i)]);
            this.flat([at(i, 1, top), at(i + 1, 1, top), [...middle, top], [...middle, top]]);
            for (let ring = 0; ring < kIn; ++ring) {
                const inner = ring / kIn, outer = (ring + 1) / kIn;
                this.quad([at(i, outer, below(outer)), at(i, inner, below(inner)), at(i + 1, inner, below(inner)), at(i + 1, outer, below(outer))],
                          [down(i, outer), down(i, inner), down(i + 1, inner), down(i + 1, outer)]);
            }
        }
    }
    handle(): void {
        this.plate([0, 0], [kHandle, kHandle], kPlate / 2, 0, 0);
        this.sphere(2, [kKnob, kKnob, kKnob]);
    }
}

/** Returns the corners of a sphere's triangles: an icosahedron, each triangle split into four, `splits` times. */
function sphere(splits: number): Point[] {
    const g = 1.61803399;
    const corners = ([[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g], [0, -1, -g], [0, 1, -g], [g, 0, -1], [g, 0, 1], [-g, 0, -1],
                      [-g, 0, 1]] as Point[]).map(normalized);
    const faces = [0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8,
                   3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1];
    let triangles = faces.map((corner) => corners[corner]);
    const between = (a: Point, b: Point) => normalized([a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
    for (let split = 0; split < splits; ++split) {
        const finer: Point[] = [];
        for (let i = 0; i < triangles.length; i += 3) {
            const [a, b, c] = triangles.slice(i, i + 3), ab = between(a, b), bc = between(b, c), ca = between(c, a);
            finer.push(a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca);
        }
        triangles = finer;
    }
    return triangles;
}

function solidOf(kind: number, width: number): Solid {
    const solid = new Solid();
    if (kind === Kind.sphere || kind === Kind.ellipsoid) {
        solid.sphere(3, [1, width, 1]);
        return solid;
    }
    if (kind === Kind.rectangle) {
        solid.box([-1, -width, -1], [1, width, kPlate - 1]);
    } else if (kind === Kind.footprint) {
        for (const [along, across, halfLength, halfWidth, lift, bulge] of kSole) {
            solid.plate([along, width * across], [halfLength, width * halfWidth], lift, bulge, kPlate - 1);
        }
    } else {
        solid.plate([0, 0], [1, width], 0, 0, kPlate - 1);
    }
    solid.handle();
    return solid;
}

/** Returns the triangles of a tool around its centre, scaled to radius 1, with the attributes of solid.vert.glsl. */
export function makeTool(tool: Tool): BufferGeometry {
    const { positions, normals } = solidOf(tool.kind, tool.width);
    if (!isRound(tool.kind)) {
        const [x, y] = tool.along, left = tool.mirrored ? -1 : 1;
        for (const vectors of [positions, normals]) {
            for (let i = 0; i < vectors.length; i += 3) {
                const [along, across] = [vectors[i], left * vectors[i + 1]];
                vectors[i] = along * x - across * y;
                vectors[i + 1] = along * y + across * x;
            }
            for (let i = 0; tool.mirrored && i < vectors.length; i += 9) {  // keeps them counter-clockwise
                for (let k = i + 3; k < i + 6; ++k) {
                    [vectors[k], vectors[k + 3]] = [vectors[k + 3], vectors[k]];
                }
            }
        }
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
    geometry.setAttribute("normal", new BufferAttribute(new Float32Array(normals), 3));
    geometry.setAttribute("along", new BufferAttribute(new Float32Array(positions.length / 3 * 2), 2));
    return geometry;
}

/** The ellipsoid that replaces a tool when light is computed. */
export interface ToolLight {
    centre: Vector3;     // [scene unit]
    space: Matrix3;      // from the scene to a space in which the ellipsoid has radius 1
    sun: Vector3;        // in this space, of length 1
    step: number;        // length in the scene of one radius along the sun, at most 1 [longest half axis]
}

export function lightOf(tool: Tool, sun: Vector3): ToolLight {
    const width = isRound(tool.kind) ? 1 : Math.max(0.02, tool.width), half = new Vector3(1, width, 1), centre = tool.place.clone();
    if (tool.kind !== Kind.sphere && tool.kind !== Kind.ellipsoid) {
        half.z = 0.3;  // for a plate whose thickness is a quarter of the radius
        centre.z -= (1 - 0.125) * tool.radius;
    }
    if (tool.kind === Kind.rectangle) {
        half.multiply(new Vector3(1.12, 1.12, 1));  // an ellipse between the rectangle's sides and its corners
    }
    const radius = tool.radius * Math.max(half.x, half.z), axis = half.clone().multiplyScalar(tool.radius), [x, y] = tool.along;
    const space = new Matrix3().set(x / axis.x, y / axis.x, 0, -y / axis.y, x / axis.y, 0, 0, 0, 1 / axis.z);
    const turned = sun.clone().applyMatrix3(space), length = turned.length();
    return { centre, space, sun: turned.divideScalar(length), step: 1 / (length * radius) };
}
