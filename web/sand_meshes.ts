// SPDX-License-Identifier: Apache-2.0
// The meshes of a session: sand, its cut sides, the box around it, and the tool.
import {
    BufferAttribute, BufferGeometry, DataTexture, IntType, LinearFilter, LinearMipmapNearestFilter, Matrix4, type Mesh, NearestFilter,
    type RawShaderMaterial, RedIntegerFormat, RepeatWrapping, RGBAFormat, type Scene, Vector4,
} from "three";
import { type GrainLevel, makeGrain } from "./grain";
import { GridField, type Point } from "./grid_field";
import { type FrameMessage, kUnitsPerCell, type SandMessage } from "./messages";
import { SandBox } from "./sand_box";
import { SandPrograms } from "./sand_programs";
import { cutsOfTin, lightTin } from "./tin_light";
import { makeTool, shapeOf, type Tool, toolOf } from "./tool_shape";

const kTray = 0.46;  // [m], longer side of the field, as on the desktop wall

/** Returns a texture of whole numbers, one per cell. */
function heightTexture(columns: number, rows: number): DataTexture {
    const texture = new DataTexture(new Int32Array(columns * rows), columns, rows, RedIntegerFormat, IntType);
    texture.internalFormat = "R32I";
    texture.minFilter = texture.magFilter = NearestFilter;
    return texture;
}

function grainTexture(grain: GrainLevel[]): DataTexture {
    const texture = new DataTexture(grain[0].data, grain[0].width, grain[0].height, RGBAFormat);
    texture.mipmaps = grain as unknown as typeof texture.mipmaps;
    texture.minFilter = LinearMipmapNearestFilter;
    texture.magFilter = LinearFilter;
    texture.wrapS = texture.wrapT = RepeatWrapping;
    texture.needsUpdate = true;
    return texture;
}

/** Returns the lowest height of a frame [scene unit]. */
function lowestOf(session: SandMessage, frame: FrameMessage): number {
    if (frame.heights) {
        return frame.heights.reduce((least, height) => Math.min(least, height)) * session.cell / kUnitsPerCell;
    }
    return frame.places!.reduce((least, n, i) => (i % 3 === 2 ? Math.min(least, n) : least), Infinity) * session.cell;
}

export class SandMeshes {
    readonly sceneToRoom: Matrix4;
    readonly programs: SandPrograms;
    private readonly grain: GrainLevel[];
    private readonly mottling: DataTexture;
    private readonly textures: DataTexture[] = [];
    private readonly sand: Mesh;
    private readonly sides: Mesh;
    private readonly tool: Mesh;
    private readonly box: SandBox;
    private readonly field?: GridField;      // of a grid
    private readonly heights?: DataTexture;
    private shape = "";                      // of the tool's mesh

    /** Adds the meshes of a session to `scene`. Its first frame is `frame`, which show() then shows. */
    constructor(scene: Scene, private readonly session: SandMessage, frame: FrameMessage) {
        const { columns, rows, cell, look, holes } = session, width = columns * cell, height = rows * cell;
        const scale = kTray / Math.max(width, height);
        // North is away from the viewer, and the middle of the sand is at 0.
        this.sceneToRoom = new Matrix4().makeScale(scale, scale, scale).premultiply(new Matrix4().set(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1))
            .multiply(new Matrix4().makeTranslation(-width / 2, -height / 2, -look[10] * cell));
        this.grain = makeGrain([look[6], look[7]]);
        this.textures.push(this.mottling = grainTexture(this.grain));
        this.programs = new SandPrograms(scene, look, this.sceneToRoom, scale, this.mottling);
        if (!session.tin) {
            this.field = new GridField(columns, rows, cell, holes);
            this.textures.push(this.heights = heightTexture(columns, rows));
        }
        this.sand = this.field ? this.addGrid(this.field, frame.heights!) : this.programs.add(new BufferGeometry(), "tin");
        const edge = this.field ? this.field.cuts(frame.heights!).edge : this.cutsOf(frame);
        this.box = new SandBox(width, height, edge, lowestOf(session, frame), look[9] !== 0);
        this.sides = this.programs.add(new BufferGeometry(), "sides");
        this.programs.add(this.box.boards, "boards", { uModel: { value: new Vector4(0, 0, 0, 1) } });
        this.tool = this.programs.add(new BufferGeometry(), "tool", { uModel: { value: new Vector4() }, uEngaged: { value: 0 } });
    }
    private addGrid(field: GridField, heights: Int32Array): Mesh {
        const { columns, rows, cell, holes } = this.session;
        const start = heightTexture(columns, rows), mask = heightTexture(holes ? columns : 1, holes ? rows : 1);
        start.image.data.set(heights);
        mask.image.data.set(holes ?? [0]);
        start.needsUpdate = mask.needsUpdate = true;
        this.textures.push(start, mask);
        const uniforms = {
            uHeights: { value: this.heights! }, uStart: { value: start }, uHoles: { value: mask }, uMottling: { value: this.mottling },
            uSize: { value: new Int32Array([columns, rows]) }, uUnit: { value: cell / kUnitsPerCell }, uCell: { value: cell },
        };
        const geometry = new BufferGeometry(), edges = field.holeEdges();
        geometry.setIndex(new BufferAttribute(field.index(), 1));
        const sand = this.programs.add(geometry, "heights", uniforms);
        if (edges) {
            this.programs.add(edges, "holeEdges", uniforms);
        }
        return sand;
    }
    dispose(): void {
        this.programs.dispose();
        for (const texture of this.textures) {
            texture.dispose();
        }
    }

    private cutsOf(frame: FrameMessage): Point[][] {
        if (!frame.heights) {
            return cutsOfTin(frame.places!, frame.corners!, this.session.cell);
        }
        const { edge, holes } = this.field!.cuts(frame.heights);
        return [...edge, ...holes];
    }

    show(frame: FrameMessage): void {
        if (frame.heights) {
            this.heights!.image.data = frame.heights as unknown as Uint8ClampedArray;
            this.heights!.needsUpdate = true;
        } else {
            this.showTin(frame.places!, frame.corners!);
        }
        this.sides.geometry.dispose();
        this.sides.geometry = this.box.sides(this.cutsOf(frame));
        const tool = toolOf(frame.tool, this.session.cell);
        this.programs.take(tool, frame.humidity);
        this.showTool(tool);
    }
    private showTin(places: Float32Array, corners: Uint32Array): void {
        const { cell, columns, rows } = this.session, geometry = new BufferGeometry();
        geometry.setAttribute("position", new BufferAttribute(places.map((n) => n * cell), 3));
        geometry.setIndex(new BufferAttribute(corners, 1));
        geometry.computeVertexNormals();
        geometry.setAttribute("shade", new BufferAttribute(lightTin(places, corners, columns, rows, this.grain[0].data), 2));
        this.sand.geometry.dispose();
        this.sand.geometry = geometry;
    }
    private showTool(tool: Tool): void {
        this.tool.visible = tool.radius > 0;
        if (!this.tool.visible) {
            return;
        }
        if (shapeOf(tool) !== this.shape) {
            this.shape = shapeOf(tool);
            this.tool.geometry.dispose();
            this.tool.geometry = makeTool(tool);
        }
        const { uModel, uEngaged } = (this.tool.material as RawShaderMaterial).uniforms;
        uModel.value.set(tool.place.x, tool.place.y, tool.place.z, tool.radius);
        uEngaged.value = tool.engaged ? 1 : 0;
    }
}
