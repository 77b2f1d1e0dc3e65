// SPDX-License-Identifier: Apache-2.0
// The wall's shaders, put together as programs for the page's meshes, and the numbers that all of them share.
import { BufferGeometry, GLSL3, type IUniform, Matrix4, Mesh, RawShaderMaterial, type Scene, Vector2, Vector3 } from "three";
import ball from "../../shapes/shaders/ball.glsl";
import light from "../../shapes/shaders/light.glsl";
import near from "../../shapes/shaders/near.frag.glsl";
import sand from "../../shapes/shaders/sand.vert.glsl";
import sheen from "../../shapes/shaders/sheen.glsl";
import side from "../../shapes/shaders/side.vert.glsl";
import solid from "../../shapes/shaders/solid.vert.glsl";
import stamp from "../../shapes/shaders/stamp.glsl";
import sunlit from "../../shapes/shaders/sunlit.glsl";
import toolFragment from "../../shapes/shaders/tool.frag.glsl";
import wood from "../../shapes/shaders/wood.frag.glsl";
import type { Piece } from "../replica/messages";
import cutAndFill from "./cut_and_fill.vert.glsl";

export type Uniforms = Record<string, IUniform>;

const kPrecision = "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n";

/** Vertex and fragment shader of a kind of mesh. */
export const kPrograms = {
    sand: ["#define main placeSand\n" + sand + "#undef main\n" + cutAndFill, near],
    sides: [side, near],
    boards: [solid, wood],
    tool: [solid, toolFragment],
};

/** The meshes of a session, and what their shaders share. */
export class SandPrograms {
    private meshes: { mesh: Mesh; program: keyof typeof kPrograms; uniforms: Uniforms }[] = [];
    private made = "";  // for which tool and sand the programs were made
    private readonly uniforms: Uniforms;

    constructor(private readonly scene: Scene, sceneToRoom: Matrix4) {
        this.uniforms = {
            uSceneToRoom: { value: sceneToRoom }, uRoomToClip: { value: new Matrix4() }, uSceneToClip: { value: new Matrix4() },
            uEye: { value: new Vector3() }, uHalfPicture: { value: new Vector2() }, uCutAndFill: { value: 0 },
        };
    }
    /** Adds a mesh. `uniforms` are its own. */
    add(program: keyof typeof kPrograms, uniforms: Uniforms = {}): Mesh {
        const mesh = new Mesh(new BufferGeometry());
        mesh.frustumCulled = false;
        this.meshes.push({ mesh, program, uniforms });
        this.scene.add(mesh);
        return mesh;
    }
    /** Takes all meshes out of the scene. */
    dispose(): void {
        for (const { mesh } of this.meshes) {
            mesh.geometry.dispose();
            (mesh.material as RawShaderMaterial).dispose();
            this.scene.remove(mesh);
        }
    }

    set(name: string, value: unknown): void { (this.uniforms[name] ??= { value }).value = value; }
    /** Takes the arrays that have the name of a uniform. */
    take(piece: Piece): void {
        for (const [name, numbers] of Object.entries(piece)) {
            if (name.startsWith("u")) {
                this.set(name, numbers.length === 1 ? numbers[0] : numbers);
            }
        }
    }
    /** Gives all meshes the programs for dry or wet sand, and for a tool that is a ball or another. */
    make(ballTool: boolean): void {
        const wet = this.uniforms.uWet.value > 0, wanted = `${ballTool} ${wet}`;
        if (wanted === this.made) {
            return;
        }
        this.made = wanted;
        const shared = kPrecision + light + (wet ? sheen : "") + sunlit + (ballTool ? ball : stamp);
        for (const { mesh, program, uniforms } of this.meshes) {
            const [vertex, fragment] = kPrograms[program];
            (mesh.material as RawShaderMaterial).dispose();
            mesh.material = new RawShaderMaterial({
                glslVersion: GLSL3, vertexShader: shared + vertex, fragmentShader: shared + fragment, uniforms: { ...this.uniforms, ...uniforms },
            });
        }
    }

    /** `eye` is in the room. */
    lookFrom(eye: Vector3, roomToClip: Matrix4, halfPicture: Vector2): void {
        const { uRoomToClip, uSceneToClip, uSceneToRoom, uEye, uHalfPicture } = this.uniforms;
        uRoomToClip.value.copy(roomToClip);
        uSceneToClip.value.multiplyMatrices(roomToClip, uSceneToRoom.value);
        uEye.value.copy(eye).applyMatrix4(new Matrix4().copy(uSceneToRoom.value).invert());
        uHalfPicture.value.copy(halfPicture);
    }
}
