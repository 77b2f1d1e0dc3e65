// SPDX-License-Identifier: Apache-2.0
// The meshes of a session: sand, its cut sides, the box around it, and the tool. The replica has computed all of them.
import {
    BufferAttribute, BufferGeometry, DataTexture, InterleavedBuffer, InterleavedBufferAttribute, LinearFilter, LinearMipmapNearestFilter, Matrix4,
    type Mesh, RepeatWrapping, RGBAFormat, type Scene, Vector4,
} from "three";
import type { Numbers, Piece, SandMessage } from "../replica/messages";
import { SandPrograms } from "./sand_programs";

export const kTray = 0.46;  // [m], longer side of the field, as on the desktop wall

function grainTexture(grain: Uint8Array): DataTexture {
    const levels: { data: Uint8Array; width: number; height: number }[] = [];
    for (let side = 256, at = 0; side >= 1; at += 4 * side * side, side /= 2) {
        levels.push({ data: grain.subarray(at, at + 4 * side * side), width: side, height: side });
    }
    const texture = new DataTexture(levels[0].data, levels[0].width, levels[0].height, RGBAFormat);
    texture.mipmaps = levels as unknown as typeof texture.mipmaps;
    texture.minFilter = LinearMipmapNearestFilter;
    texture.magFilter = LinearFilter;
    texture.wrapS = texture.wrapT = RepeatWrapping;
    texture.needsUpdate = true;
    return texture;
}

/** Returns a geometry with room for the sand's vertices. */
function sandOf(vertices: number): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute("aHeight", new BufferAttribute(new Float32Array(vertices), 1));
    geometry.setAttribute("aGrid", new BufferAttribute(new Float32Array(2 * vertices), 2));
    geometry.setAttribute("aNormal", new BufferAttribute(new Int16Array(2 * vertices), 2, true));
    geometry.setAttribute("aShade", new BufferAttribute(new Uint16Array(2 * vertices), 2, true));
    return geometry;
}

/** Gives a mesh the triangles of a solid body: eight numbers for each vertex. */
function setSolid(mesh: Mesh, numbers: Float32Array): void {
    const vertices = new InterleavedBuffer(numbers, 8), geometry = new BufferGeometry();
    geometry.setAttribute("aPosition", new InterleavedBufferAttribute(vertices, 3, 0));
    geometry.setAttribute("aNormal", new InterleavedBufferAttribute(vertices, 3, 3));
    geometry.setAttribute("aAlong", new InterleavedBufferAttribute(vertices, 2, 6));
    geometry.setDrawRange(0, numbers.length / 8);
    mesh.geometry.dispose();
    mesh.geometry = geometry;
}

const kFarAway = new Float32Array([0, 0, 1e9, 1]);  // uTool without a tool, as shapes/tool/light.hpp has it

export class SandMeshes {
    readonly sceneToRoom: Matrix4;
    readonly programs: SandPrograms;
    private readonly scale: number;             // of the room [m per scene unit]
    private readonly model = new Vector4();     // place and radius of the tool
    private readonly sand: Mesh;
    private readonly solids: Record<string, Mesh>;
    private grain?: DataTexture;
    private toolIsWanted = true;
    private placeOfTool: Numbers = kFarAway;    // uTool of the last frame

    /** Adds the meshes of a session to `scene`. The first pieces that show() gets have all of them. */
    constructor(scene: Scene, { columns, rows, cell, middle }: SandMessage) {
        const width = columns * cell, height = rows * cell, scale = this.scale = kTray / Math.max(width, height);
        // North is away from the viewer, and the middle of the sand is at 0.
        this.sceneToRoom = new Matrix4().makeScale(scale, scale, scale).premultiply(new Matrix4().set(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1))
            .multiply(new Matrix4().makeTranslation(-width / 2, -height / 2, -middle * cell));
        this.programs = new SandPrograms(scene, this.sceneToRoom);
        this.sand = this.programs.add("sand");
        this.solids = {
            sides: this.programs.add("sides"), boards: this.programs.add("boards", { uModel: { value: new Vector4(0, 0, 0, 1) } }),
            tool: this.programs.add("tool", { uModel: { value: this.model } }),
        };
    }
    dispose(): void {
        this.programs.dispose();
        this.grain?.dispose();
    }

    /** Shows the tool, or hides it. A hidden tool takes no light from the sand either. */
    showTool(on: boolean): void {
        this.toolIsWanted = on;
        this.solids.tool.visible = on && this.model.w > 0;
        this.programs.set("uTool", on ? this.placeOfTool : kFarAway);
    }
    get showsTool(): boolean { return this.solids.tool.visible; }

    show(pieces: Piece[]): void {
        pieces.forEach((piece) => this.take(piece));
        const triangles = pieces.flatMap((piece) => (piece.triangles ? [piece.triangles as Uint32Array] : []));
        if (triangles.length > 0) {
            this.beginSand(triangles);
        }
    }
    private take(piece: Piece): void {
        this.programs.take(piece);
        if (piece.grain) {
            this.grain = grainTexture(piece.grain as Uint8Array);
            this.programs.set("uGrain", this.grain);
            this.programs.set("uGrainScale", this.scale / piece.grainPeriod[0]);
        }
        if (piece.vertices) {
            this.sand.geometry.dispose();
            this.sand.geometry = sandOf(piece.vertices[0]);
        }
        if (piece.first) {
            this.takeVertices(piece);
        }
        for (const [name, mesh] of Object.entries(this.solids)) {
            if (piece[name]) {
                setSolid(mesh, piece[name] as Float32Array);
            }
        }
        if (piece.uModel) {
            this.model.fromArray(piece.uModel as Float32Array);
            this.placeOfTool = piece.uTool;
            this.showTool(this.toolIsWanted);
            this.programs.make(piece.ball[0] === 1);
        }
    }
    private takeVertices(piece: Piece): void {
        for (const name of ["aHeight", "aGrid", "aNormal", "aShade"]) {
            const attribute = this.sand.geometry.getAttribute(name) as BufferAttribute, first = piece.first[0] * attribute.itemSize;
            attribute.array.set(piece[name], first);
            attribute.addUpdateRange(first, piece[name].length);
            attribute.needsUpdate = true;
        }
    }
    /** Gives new sand its triangles. Its heights are those of the session's start. */
    private beginSand(triangles: Uint32Array[]): void {
        const all = new Uint32Array(triangles.reduce((sum, part) => sum + part.length, 0));
        triangles.reduce((at, part) => {
            all.set(part, at);
            return at + part.length;
        }, 0);
        const { geometry } = this.sand;
        geometry.setIndex(new BufferAttribute(all, 1));
        geometry.setAttribute("aStart", new BufferAttribute(geometry.getAttribute("aHeight").array.slice(), 1));
    }
}
