// SPDX-License-Identifier: Apache-2.0
// Draws the sand with the wall's own shaders.
import {
    BufferAttribute, BufferGeometry, Color, DataTexture, DoubleSide, GLSL3, IntType, LinearFilter, LinearMipmapNearestFilter,
    LinearSRGBColorSpace, Matrix4, Mesh, NearestFilter, PerspectiveCamera, RawShaderMaterial, RedIntegerFormat, RepeatWrapping, RGBAFormat,
    Scene, SphereGeometry, Vector2, Vector3, Vector4, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import ball from "../render_node/shaders/ball.glsl";
import light from "../render_node/shaders/light.glsl";
import near from "../render_node/shaders/near.frag.glsl";
import solid from "../render_node/shaders/solid.vert.glsl";
import sunlit from "../render_node/shaders/sunlit.glsl";
import toolFragment from "../render_node/shaders/tool.frag.glsl";
import wood from "../render_node/shaders/wood.frag.glsl";
import { makeGrain } from "./grain";
import heightsVertex from "./heights.vert.glsl";
import lightVertex from "./light_vertex.glsl";
import { type FrameMessage, kUnitsPerCell, type SessionMessage } from "./messages";
import tinVertex from "./tin.vert.glsl";
import { trayOf } from "./tray";

const kTray = 0.46;  // [m], longer side of the field, as on the desktop wall
const kPrecision = "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n";
const kShared = kPrecision + light + sunlit + ball;
// three.js binds attributes by these names.
const kSolid = solid.replace(/layout\(location = \d\) /g, "").replaceAll("aPosition", "position").replaceAll("aNormal", "normal")
    .replaceAll("aAlong", "along");

/** Returns a texture of whole numbers, one per cell. */
function heightTexture(columns: number, rows: number): DataTexture {
    const texture = new DataTexture(new Int32Array(columns * rows), columns, rows, RedIntegerFormat, IntType);
    texture.internalFormat = "R32I";
    texture.minFilter = texture.magFilter = NearestFilter;
    return texture;
}

function grainTexture(sun: [number, number]): DataTexture {
    const grain = makeGrain(sun);
    const texture = new DataTexture(grain[0].data, grain[0].width, grain[0].height, RGBAFormat);
    texture.mipmaps = grain as unknown as typeof texture.mipmaps;
    texture.minFilter = LinearMipmapNearestFilter;
    texture.magFilter = LinearFilter;
    texture.wrapS = texture.wrapT = RepeatWrapping;
    texture.needsUpdate = true;
    return texture;
}

/** Returns the triangles of a grid's vertices: its cells and a rim. */
function gridIndex(across: number, down: number): Uint32Array {
    const index = new Uint32Array((across - 1) * (down - 1) * 6);
    for (let y = 0, k = 0; y + 1 < down; ++y) {
        for (let x = 0; x + 1 < across; ++x, k += 6) {
            const a = y * across + x;
            index.set([a, a + 1, a + across + 1, a, a + across + 1, a + across], k);
        }
    }
    return index;
}

function meanHeight(session: SessionMessage, frame: FrameMessage): number {
    if (frame.heights) {
        return frame.heights.reduce((sum, height) => sum + height, 0) / frame.heights.length * session.cell / kUnitsPerCell;
    }
    const places = frame.places!;
    let sum = 0;
    for (let i = 2; i < places.length; i += 3) {
        sum += places[i];
    }
    return sum / (places.length / 3) * session.cell;
}

export class View {
    private readonly renderer: WebGLRenderer;
    private readonly scene = new Scene();
    private readonly camera = new PerspectiveCamera(35, 1, 0.02, 20);
    private readonly controls: OrbitControls;
    private readonly sceneToRoom = new Matrix4();
    private uniforms: Record<string, { value: any }> = {};
    private toolUniforms = { uModel: { value: new Vector4() }, uEngaged: { value: 0 } };
    private sand?: Mesh;
    private heights?: DataTexture;
    private cell = 1;
    private dirty = true;

    /** Throws if the browser has no WebGL 2. `drawn` is called after each picture. */
    constructor(private readonly canvas: HTMLCanvasElement, private readonly drawn: () => void) {
        this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
        this.renderer.outputColorSpace = LinearSRGBColorSpace;  // the shaders encode colours themselves
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.listenToKeyEvents(canvas as unknown as HTMLElement);
        this.controls.addEventListener("change", () => { this.dirty = true; });
        this.controls.maxDistance = 3;
        this.controls.minDistance = 0.1;
        new ResizeObserver(() => this.resize()).observe(canvas);
        this.resize();
        const loop = () => {
            this.draw();
            requestAnimationFrame(loop);
        };
        requestAnimationFrame(loop);
    }

    private resize(): void {
        this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
        const width = Math.max(this.canvas.clientWidth, 1), height = Math.max(this.canvas.clientHeight, 1);
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        this.dirty = true;
    }

    private material(vertex: string, fragment: string, more: Record<string, { value: any }>): RawShaderMaterial {
        return new RawShaderMaterial({
            glslVersion: GLSL3, vertexShader: kShared + vertex, fragmentShader: kShared + fragment, uniforms: { ...this.uniforms, ...more },
        });
    }
    private add(geometry: BufferGeometry, material: RawShaderMaterial): Mesh {
        const mesh = new Mesh(geometry, material);
        mesh.frustumCulled = false;
        this.scene.add(mesh);
        return mesh;
    }

    /** Begins to draw a session, whose first frame is `frame`. */
    begin(session: SessionMessage, frame: FrameMessage): void {
        for (const child of [...this.scene.children] as Mesh[]) {
            child.geometry.dispose();
            (child.material as RawShaderMaterial).dispose();
            this.scene.remove(child);
        }
        const { columns, rows, cell, look } = session, width = columns * cell, height = rows * cell;
        this.cell = cell;
        const mean = meanHeight(session, frame), scale = kTray / Math.max(width, height);
        // North is away from the viewer, and the middle of the sand is at 0.
        this.sceneToRoom.makeScale(scale, scale, scale).premultiply(new Matrix4().set(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1))
            .multiply(new Matrix4().makeTranslation(-width / 2, -height / 2, -mean));
        const grain = grainTexture([look[6], look[7]]);
        this.uniforms = {
            uSceneToRoom: { value: this.sceneToRoom }, uRoomToClip: { value: new Matrix4() }, uSceneToClip: { value: new Matrix4() },
            uEye: { value: new Vector3() }, uHalfPicture: { value: new Vector2() }, uSun: { value: new Vector3(look[6], look[7], look[8]).normalize() },
            uSand: { value: new Vector3(look[0], look[1], look[2]) }, uTool: { value: new Vector4(0, 0, 1e6, 1) }, uGrain: { value: grain },
            uGrainScale: { value: scale / (256 * 0.0006) }, uCutAndFill: { value: 0 },
        };
        this.scene.background = new Color().setRGB(...([3, 4, 5].map((i) => Math.max(look[i], 0) ** (1 / 2.2)) as [number, number, number]), LinearSRGBColorSpace);
        const geometry = new BufferGeometry();
        this.heights = undefined;
        if (session.tin) {
            this.sand = this.add(geometry, this.material(lightVertex + tinVertex, near, {}));
        } else {
            const start = heightTexture(columns, rows);
            start.image.data.set(frame.heights!);
            start.needsUpdate = true;
            this.heights = heightTexture(columns, rows);
            geometry.setIndex(new BufferAttribute(gridIndex(columns + 2, rows + 2), 1));
            this.sand = this.add(geometry, this.material(lightVertex + heightsVertex, near, {
                uHeights: { value: this.heights }, uStart: { value: start }, uMottling: { value: grain },
                uSize: { value: new Int32Array([columns, rows]) }, uUnit: { value: cell / kUnitsPerCell }, uCell: { value: cell },
            }));
        }
        const tray = this.material(kSolid, wood, { uModel: { value: new Vector4(0, 0, 0, 1) } });
        tray.side = DoubleSide;
        this.add(trayOf(width, height, mean), tray);
        const sphere = new SphereGeometry(1, 48, 32);
        sphere.setAttribute("along", new BufferAttribute(new Float32Array(sphere.attributes.position.count * 2), 2));
        this.add(sphere, this.material(kSolid, toolFragment, this.toolUniforms));
        const far = Math.max(1, 1.3 * this.canvas.clientHeight / this.canvas.clientWidth);  // a narrow screen needs a greater distance
        this.controls.target.set(0, 0, 0);
        this.camera.position.set(0, 0.55 * far, 0.62 * far);
        this.controls.update();
        this.show(frame);
    }

    show(frame: FrameMessage): void {
        if (frame.heights) {
            this.heights!.image.data = frame.heights as unknown as Uint8ClampedArray;
            this.heights!.needsUpdate = true;
        } else {
            const geometry = new BufferGeometry();
            geometry.setAttribute("position", new BufferAttribute(frame.places!.map((n) => n * this.cell), 3));
            geometry.setIndex(new BufferAttribute(frame.corners!, 1));
            geometry.computeVertexNormals();
            this.sand!.geometry.dispose();
            this.sand!.geometry = geometry;
        }
        const [x, y, z, radius] = [...frame.tool].map((n) => n * this.cell);
        this.uniforms.uTool.value.set(x, y, z, 1 / radius);
        this.toolUniforms.uModel.value.set(x, y, z, radius);
        this.toolUniforms.uEngaged.value = frame.tool[4];
        this.dirty = true;
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
