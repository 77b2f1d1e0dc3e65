// SPDX-License-Identifier: Apache-2.0
// The tray around the sand: four boards, in scene units.
import { BufferAttribute, BufferGeometry } from "three";

type Point = [number, number, number];

/** `width` and `height` are those of the field, and `mean` is the mean height of its sand. */
export function trayOf(width: number, height: number, mean: number): BufferGeometry {
    const side = Math.max(width, height), t = 0.02 * side, top = mean + 0.03 * side, low = mean - 0.12 * side;
    const positions: number[] = [], normals: number[] = [], along: number[] = [];
    const quad = (corners: [Point, Point, Point, Point], normal: Point, length: number) => {
        const grain = [[0, 0], [length, 0], [length, 0.1], [0, 0.1]];
        for (const i of [0, 1, 2, 0, 2, 3]) {
            positions.push(...corners[i]);
            normals.push(...normal);
            along.push(...grain[i]);
        }
    };
    const w = width, h = height;
    quad([[-t, -t, top], [w + t, -t, top], [w, 0, top], [0, 0, top]], [0, 0, 1], w);
    quad([[w + t, -t, top], [w + t, h + t, top], [w, h, top], [w, 0, top]], [0, 0, 1], h);
    quad([[w + t, h + t, top], [-t, h + t, top], [0, h, top], [w, h, top]], [0, 0, 1], w);
    quad([[-t, h + t, top], [-t, -t, top], [0, 0, top], [0, h, top]], [0, 0, 1], h);
    quad([[-t, -t, low], [w + t, -t, low], [w + t, -t, top], [-t, -t, top]], [0, -1, 0], w);
    quad([[w + t, -t, low], [w + t, h + t, low], [w + t, h + t, top], [w + t, -t, top]], [1, 0, 0], h);
    quad([[w + t, h + t, low], [-t, h + t, low], [-t, h + t, top], [w + t, h + t, top]], [0, 1, 0], w);
    quad([[-t, h + t, low], [-t, -t, low], [-t, -t, top], [-t, h + t, top]], [-1, 0, 0], h);
    quad([[0, h, low], [0, h, top], [w, h, top], [w, h, low]], [0, -1, 0], w);
    quad([[0, 0, low], [w, 0, low], [w, 0, top], [0, 0, top]], [0, 1, 0], w);
    quad([[0, 0, low], [0, 0, top], [0, h, top], [0, h, low]], [1, 0, 0], h);
    quad([[w, 0, low], [w, h, low], [w, h, top], [w, 0, top]], [-1, 0, 0], h);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
    geometry.setAttribute("normal", new BufferAttribute(new Float32Array(normals), 3));
    geometry.setAttribute("along", new BufferAttribute(new Float32Array(along), 2));
    return geometry;
}
