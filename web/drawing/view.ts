// SPDX-License-Identifier: Apache-2.0
// Draws the sand with the wall's own shaders.
import { Color, LinearSRGBColorSpace, Matrix4, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import type { FrameMessage, SandMessage } from "../replica/messages";
import { Eye } from "./eye";
import { kTray, SandMeshes } from "./sand_meshes";

export class View {
    readonly eye: Eye;
    private readonly renderer: WebGLRenderer;
    private readonly scene = new Scene();
    private session?: SandMessage;
    private meshes?: SandMeshes;
    private dirty = true;
    private digs = false;

    /** Throws if the browser has no WebGL 2. `drawn` is called after each picture. */
    constructor(private readonly canvas: HTMLCanvasElement, private readonly drawn: () => void) {
        this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
        this.renderer.outputColorSpace = LinearSRGBColorSpace;  // the shaders encode colours themselves
        this.eye = new Eye(canvas, () => { this.dirty = true; });
        canvas.addEventListener("webglcontextrestored", () => { this.dirty = true; });
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
        this.eye.resize(width, height);
        this.dirty = true;
    }

    /** Begins to draw a session, whose first frame is `frame`. */
    begin(session: SandMessage, frame: FrameMessage): void {
        this.meshes?.dispose();
        this.session = session;
        this.meshes = new SandMeshes(this.scene, session);
        this.meshes.showTool(!this.digs);  // a hand that has not pointed yet has no place
        const [red, green, blue] = frame.pieces.find((piece) => piece.background)!.background;
        this.scene.background = new Color().setRGB(red, green, blue, LinearSRGBColorSpace);
        this.eye.begin(kTray * Math.min(1, session.columns / session.rows), kTray * Math.min(1, session.rows / session.columns));
        this.show(frame);
    }
    /** Returns whether a frame of this sand was the last one. */
    shows(session: SandMessage): boolean { return this.session === session; }
    show(frame: FrameMessage): void {
        this.meshes!.show(frame.pieces);
        this.dirty = true;
    }
    /** Whether the hand of the page digs in the sand that begins next. */
    set digging(on: boolean) {
        this.digs = on;
        this.eye.digging = on;
    }
    /** Shows the tool of a hand, which now points at a place. */
    showTool(): void {
        if (this.meshes && !this.meshes.showsTool) {
            this.meshes.showTool(true);
            this.dirty = true;
        }
    }
    get showsTool(): boolean { return this.meshes?.showsTool ?? false; }
    set cutAndFill(on: boolean) {
        this.meshes!.programs.set("uCutAndFill", on ? 1 : 0);
        this.dirty = true;
    }

    /** Whether sand is drawn. */
    get ready(): boolean { return this.meshes !== undefined; }
    /** Goes near to a place of the sand [cell]. */
    goNear(x: number, y: number, height: number): void {
        const { cell } = this.session!;
        this.eye.goNear(new Vector3(x * cell, y * cell, height * cell).applyMatrix4(this.meshes!.sceneToRoom));
    }

    /** The eye, and the direction of its sight through a place in the window [CSS pixel], both in cells of the field. */
    sightThrough(clientX: number, clientY: number): number[] {
        const { left, top, width, height } = this.canvas.getBoundingClientRect(), { camera } = this.eye;
        camera.updateMatrixWorld();
        const roomToScene = new Matrix4().copy(this.meshes!.sceneToRoom).invert();
        const eye = new Vector3().copy(camera.position).applyMatrix4(roomToScene);
        const point = new Vector3(2 * (clientX - left) / width - 1, 1 - 2 * (clientY - top) / height, 0.5).unproject(camera).applyMatrix4(roomToScene);
        return [...eye.toArray(), ...point.sub(eye).toArray()].map((length) => length / this.session!.cell);
    }

    private draw(): void {
        if (!this.dirty || !this.meshes) {
            return;
        }
        this.dirty = false;
        const { camera } = this.eye;
        camera.updateMatrixWorld();
        const roomToClip = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
        this.meshes.programs.lookFrom(camera.position, roomToClip, new Vector2(this.canvas.width / 2, this.canvas.height / 2));
        this.renderer.render(this.scene, camera);
        this.drawn();
    }
}
