// SPDX-License-Identifier: Apache-2.0
// Draws the sand with the wall's own shaders.
import {
    BufferAttribute, BufferGeometry, Color, DataTexture, GLSL3, IntType, LinearFilter, LinearMipmapNearestFilter, LinearSRGBColorSpace,
    Matrix3, Matrix4, Mesh, MOUSE, NearestFilter, PerspectiveCamera, RawShaderMaterial, RedIntegerFormat, RepeatWrapping, RGBAFormat, Scene, TOUCH, Vector2,
    Vector3, Vector4, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import ball from "../render_node/shaders/ball.glsl";
import light from "../render_node/shaders/light.glsl";
import near from "../render_node/shaders/near.frag.glsl";
import sheen from "../render_node/shaders/sheen.glsl";
import side from "../render_node/shaders/side.vert.glsl";
import solid from "../render_node/shaders/solid.vert.glsl";
import stamp from "../render_node/shaders/stamp.glsl";
import sunlit from "../render_node/shaders/sunlit.glsl";
import toolFragment from "../render_node/shaders/tool.frag.glsl";
import wood from "../render_node/shaders/wood.frag.glsl";
import { type GrainLevel, makeGrain } from "./grain";
import { GridField } from "./grid_field";
import heightsVertex from "./heights.vert.glsl";
import lightVertex from "./light_vertex.glsl";
import { type FrameMessage, kUnitsPerCell, type SandMessage } from "./messages";
import { SandBox } from "./sand_box";
import tinVertex from "./tin.vert.glsl";
import { cutsOfTin, lightTin } from "./tin_light";
import { isBall, lightOf, makeTool, shapeOf, type Tool, toolOf } from "./tool_shape";

const kTray = 0.46;  // [m], longer side of the field, as on the desktop wall
const kPrecision = "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n";
const kNoTool = new Vector4(0, 0, 1e9, 1);  // too far away to take any light
// three.js binds attributes by these names.
const named = (vertex: string) => vertex.replace(/layout\(location = \d\) /g, "").replaceAll("aPosition", "position")
    .replaceAll("aNormal", "normal").replaceAll("aAlong", "along");
const kSolid = named(solid), kSide = named(side);

type Uniforms = Record<string, { value: any }>;

/** Returns the level of a share of light: exact, unlike encode() of the shaders. */
function encoded(linear: number): number {
    return Math.round(255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055)) / 255;
}
/** Returns the albedo of wet sand, as wetAlbedo() of render_node/scene_painter.cpp does. */
function wetAlbedo(dry: number, humidity: number): number {
    const share = 0.68 * humidity * (2 - humidity);
    return dry * (1 - share) / (1 - share * Math.max(0, Math.min(1, dry)));
}

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

export class View {
    private readonly renderer: WebGLRenderer;
    private readonly scene = new Scene();
    private readonly camera = new PerspectiveCamera(35, 1, 0.02, 20);
    private readonly controls: OrbitControls;
    private readonly sceneToRoom = new Matrix4();
    private uniforms: Uniforms = {};
    private meshes: { mesh: Mesh; vertex: string; fragment: string; uniforms: Uniforms }[] = [];
    private programs = "";      // which the meshes have
    private session?: SandMessage;
    private sand?: Mesh;
    private sides?: Mesh;
    private tool?: Mesh;
    private shape = "";         // of the tool's mesh
    private field?: GridField;
    private box?: SandBox;
    private grain: GrainLevel[] = [];
    private heights?: DataTexture;
    private dirty = true;
    private givenEye?: number[];

    /** Throws if the browser has no WebGL 2. `drawn` is called after each picture. */
    constructor(private readonly canvas: HTMLCanvasElement, private readonly drawn: () => void) {
        this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
        this.renderer.outputColorSpace = LinearSRGBColorSpace;  // the shaders encode colours themselves
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.listenToKeyEvents(canvas as unknown as HTMLElement);
        this.controls.addEventListener("change", () => { this.dirty = true; });
        this.controls.maxDistance = 3;
        this.controls.minDistance = 0.1;
        this.controls.maxPolarAngle = Math.PI * 85 / 180;
        canvas.addEventListener("keydown", (event) => this.key(event));
        canvas.addEventListener("webglcontextrestored", () => { this.dirty = true; });
        new ResizeObserver(() => this.resize()).observe(canvas);
        this.resize();
        const loop = () => {
            this.draw();
            requestAnimationFrame(loop);
        };
        requestAnimationFrame(loop);
    }

    private key(event: KeyboardEvent): void {
        const nearer = { "+": 0.87, "=": 0.87, "-": 1.15 }[event.key];
        if (event.ctrlKey || event.metaKey || event.altKey || (nearer === undefined && event.key !== "Home")) {
            return;
        }
        event.preventDefault();
        if (nearer === undefined) {
            this.lookAtAll();
        } else {
            this.camera.position.sub(this.controls.target).multiplyScalar(nearer).add(this.controls.target);
            this.controls.update();
        }
    }
    private lookAtAll(): void {
        const far = Math.max(1, 1.3 * this.canvas.clientHeight / this.canvas.clientWidth);  // a narrow screen needs a greater distance
        this.controls.target.set(0, 0, 0);
        this.camera.position.set(0, 0.55 * far, 0.62 * far);
        this.controls.update();
    }
    /** The eye and the place that it looks at [m], from the middle of the sand: x right, y up, z towards the viewer. */
    get eye(): number[] { return [...this.camera.position.toArray(), ...this.controls.target.toArray()]; }
    set eye(places: number[]) {
        this.givenEye = places;
        this.camera.position.fromArray(places);
        this.controls.target.fromArray(places, 3);
        this.controls.update();
    }

    /** The left button and one finger dig; the other buttons and two fingers move the view. */
    set digging(on: boolean) {
        const { mouseButtons, touches } = this.controls;
        Object.assign(mouseButtons, on ? { LEFT: null, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.ROTATE } : { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN });
        touches.ONE = on ? null : TOUCH.ROTATE;
        touches.TWO = on ? TOUCH.DOLLY_ROTATE : TOUCH.DOLLY_PAN;
    }
    /** The eye, and the direction of its sight through a place in the window [CSS pixel], both in cells of the field. */
    sightThrough(clientX: number, clientY: number): number[] {
        const { left, top, width, height } = this.canvas.getBoundingClientRect();
        this.camera.updateMatrixWorld();
        const roomToScene = new Matrix4().copy(this.sceneToRoom).invert();
        const eye = new Vector3().copy(this.camera.position).applyMatrix4(roomToScene);
        const point = new Vector3(2 * (clientX - left) / width - 1, 1 - 2 * (clientY - top) / height, 0.5).unproject(this.camera).applyMatrix4(roomToScene);
        return [...eye.toArray(), ...point.sub(eye).toArray()].map((length) => length / this.session!.cell);
    }

    private resize(): void {
        this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
        const width = Math.max(this.canvas.clientWidth, 1), height = Math.max(this.canvas.clientHeight, 1);
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        this.dirty = true;
    }

    private add(geometry: BufferGeometry, vertex: string, fragment: string, uniforms: Uniforms = {}): Mesh {
        const mesh = new Mesh(geometry);
        mesh.frustumCulled = false;
        this.meshes.push({ mesh, vertex, fragment, uniforms });
        this.scene.add(mesh);
        return mesh;
    }
    /** Gives all meshes the programs for this tool and for dry or wet sand. */
    private dress(tool: Tool, wet: boolean): void {
        const programs = `${isBall(tool)} ${wet}`;
        if (programs === this.programs) {
            return;
        }
        this.programs = programs;
        const shared = kPrecision + light + (wet ? sheen : "") + sunlit + (isBall(tool) ? ball : stamp);
        for (const { mesh, vertex, fragment, uniforms } of this.meshes) {
            (mesh.material as RawShaderMaterial).dispose();
            mesh.material = new RawShaderMaterial({
                glslVersion: GLSL3, vertexShader: shared + vertex, fragmentShader: shared + fragment, uniforms: { ...this.uniforms, ...uniforms },
            });
        }
    }

    /** Begins to draw a session, whose first frame is `frame`. */
    begin(session: SandMessage, frame: FrameMessage): void {
        for (const { mesh } of this.meshes) {
            mesh.geometry.dispose();
            (mesh.material as RawShaderMaterial).dispose();
            this.scene.remove(mesh);
        }
        this.meshes = [];
        this.programs = this.shape = "";
        this.session = session;
        const { columns, rows, cell, look, holes } = session, width = columns * cell, height = rows * cell;
        const middle = look[10] * cell, scale = kTray / Math.max(width, height);
        // North is away from the viewer, and the middle of the sand is at 0.
        this.sceneToRoom.makeScale(scale, scale, scale).premultiply(new Matrix4().set(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1))
            .multiply(new Matrix4().makeTranslation(-width / 2, -height / 2, -middle));
        this.grain = makeGrain([look[6], look[7]]);
        const grain = grainTexture(this.grain);
        this.uniforms = {
            uSceneToRoom: { value: this.sceneToRoom }, uRoomToClip: { value: new Matrix4() }, uSceneToClip: { value: new Matrix4() },
            uEye: { value: new Vector3() }, uHalfPicture: { value: new Vector2() }, uSun: { value: new Vector3(look[6], look[7], look[8]).normalize() },
            uSand: { value: new Vector3() }, uWet: { value: 0 }, uTool: { value: new Vector4() }, uToolSpace: { value: new Matrix3() },
            uToolSun: { value: new Vector3() }, uToolStep: { value: 1 }, uGrain: { value: grain },
            uGrainScale: { value: scale / (256 * 0.0006) }, uCutAndFill: { value: 0 },
        };
        this.scene.background = new Color().setRGB(...([3, 4, 5].map((i) => encoded(look[i])) as [number, number, number]), LinearSRGBColorSpace);
        this.heights = this.field = undefined;
        if (session.tin) {
            this.sand = this.add(new BufferGeometry(), lightVertex + tinVertex, near);
        } else {
            this.beginGrid(session, frame.heights!, grain, holes);
        }
        const cuts = this.cutsOf(frame);
        this.box = new SandBox(width, height, session.tin ? cuts : this.field!.cuts(frame.heights!).edge, lowestOf(session, frame), look[9] !== 0);
        this.sides = this.add(new BufferGeometry(), kSide, near);
        this.add(this.box.boards, kSolid, wood, { uModel: { value: new Vector4(0, 0, 0, 1) } });
        this.tool = this.add(new BufferGeometry(), kSolid, toolFragment, { uModel: { value: new Vector4() }, uEngaged: { value: 0 } });
        if (this.givenEye) {
            this.givenEye = undefined;  // for the first session alone
        } else {
            this.lookAtAll();
        }
        this.show(frame);
    }
    private beginGrid({ columns, rows, cell }: SandMessage, heights: Int32Array, grain: DataTexture, holes?: Uint8Array): void {
        const start = heightTexture(columns, rows), mask = heightTexture(holes ? columns : 1, holes ? rows : 1);
        start.image.data.set(heights);
        mask.image.data.set(holes ?? [0]);
        start.needsUpdate = mask.needsUpdate = true;
        this.heights = heightTexture(columns, rows);
        this.field = new GridField(columns, rows, cell, holes);
        const uniforms = {
            uHeights: { value: this.heights }, uStart: { value: start }, uHoles: { value: mask }, uMottling: { value: grain },
            uSize: { value: new Int32Array([columns, rows]) }, uUnit: { value: cell / kUnitsPerCell }, uCell: { value: cell },
        };
        const geometry = new BufferGeometry(), edges = this.field.holeEdges();
        geometry.setIndex(new BufferAttribute(this.field.index(), 1));
        this.sand = this.add(geometry, lightVertex + heightsVertex, near, uniforms);
        if (edges) {
            this.add(edges, "#define HOLE_EDGES\n" + lightVertex + heightsVertex, near, uniforms);
        }
    }
    private cutsOf(frame: FrameMessage) {
        if (!frame.heights) {
            return cutsOfTin(frame.places!, frame.corners!, this.session!.cell);
        }
        const { edge, holes } = this.field!.cuts(frame.heights);
        return [...edge, ...holes];
    }

    show(frame: FrameMessage): void {
        const { cell, columns, rows, look } = this.session!;
        if (frame.heights) {
            this.heights!.image.data = frame.heights as unknown as Uint8ClampedArray;
            this.heights!.needsUpdate = true;
        } else {
            const geometry = new BufferGeometry();
            geometry.setAttribute("position", new BufferAttribute(frame.places!.map((n) => n * cell), 3));
            geometry.setIndex(new BufferAttribute(frame.corners!, 1));
            geometry.computeVertexNormals();
            geometry.setAttribute("shade", new BufferAttribute(lightTin(frame.places!, frame.corners!, columns, rows, this.grain[0].data), 2));
            this.sand!.geometry.dispose();
            this.sand!.geometry = geometry;
        }
        this.sides!.geometry.dispose();
        this.sides!.geometry = this.box!.sides(this.cutsOf(frame));
        this.uniforms.uSand.value.set(...[0, 1, 2].map((i) => wetAlbedo(look[i], frame.humidity)));
        this.uniforms.uWet.value = frame.humidity;
        this.showTool(toolOf(frame.tool, cell), frame.humidity > 0);
        this.dirty = true;
    }
    private showTool(tool: Tool, wet: boolean): void {
        this.dress(tool, wet);
        this.tool!.visible = tool.radius > 0;
        if (tool.radius === 0) {
            this.uniforms.uTool.value.copy(kNoTool);
            return;
        }
        if (shapeOf(tool) !== this.shape) {
            this.shape = shapeOf(tool);
            this.tool!.geometry.dispose();
            this.tool!.geometry = makeTool(tool);
        }
        const light = lightOf(tool, this.uniforms.uSun.value), { x, y, z } = isBall(tool) ? tool.place : light.centre;
        this.uniforms.uTool.value.set(x, y, z, isBall(tool) ? 1 / tool.radius : 1);
        this.uniforms.uToolSpace.value.copy(light.space);
        this.uniforms.uToolSun.value.copy(light.sun);
        this.uniforms.uToolStep.value = light.step;
        const { uModel, uEngaged } = (this.tool!.material as RawShaderMaterial).uniforms;
        uModel.value.set(tool.place.x, tool.place.y, tool.place.z, tool.radius);
        uEngaged.value = tool.engaged ? 1 : 0;
    }

    set cutAndFill(on: boolean) {
        this.uniforms.uCutAndFill.value = on ? 1 : 0;
        this.dirty = true;
    }

    private draw(): void {
        if (!this.dirty || !this.sand) {
            return;
        }
        this.dirty = false;
        this.camera.updateMatrixWorld();
        const roomToClip = new Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
        this.uniforms.uRoomToClip.value.copy(roomToClip);
        this.uniforms.uSceneToClip.value.multiplyMatrices(roomToClip, this.sceneToRoom);
        this.uniforms.uEye.value.copy(this.camera.position).applyMatrix4(new Matrix4().copy(this.sceneToRoom).invert());
        this.uniforms.uHalfPicture.value.set(this.canvas.width / 2, this.canvas.height / 2);
        this.renderer.render(this.scene, this.camera);
        this.drawn();
    }
}
