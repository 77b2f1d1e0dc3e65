// SPDX-License-Identifier: Apache-2.0
// The wall's shaders, put together as programs for the page's meshes, and the numbers that all of them share.
import {
    BufferGeometry, DataTexture, GLSL3, type IUniform, Matrix3, Matrix4, Mesh, RawShaderMaterial, type Scene, Vector2, Vector3, Vector4,
} from "three";
import ball from "../shapes/shaders/ball.glsl";
import light from "../shapes/shaders/light.glsl";
import near from "../shapes/shaders/near.frag.glsl";
import sheen from "../shapes/shaders/sheen.glsl";
import side from "../shapes/shaders/side.vert.glsl";
import solid from "../shapes/shaders/solid.vert.glsl";
import stamp from "../shapes/shaders/stamp.glsl";
import sunlit from "../shapes/shaders/sunlit.glsl";
import toolFragment from "../shapes/shaders/tool.frag.glsl";
import wood from "../shapes/shaders/wood.frag.glsl";
import heightsVertex from "./heights.vert.glsl";
import lightVertex from "./light_vertex.glsl";
import tinVertex from "./tin.vert.glsl";
import { isBall, lightOf, type Tool } from "./tool_shape";

export type Uniforms = Record<string, IUniform>;

const kPrecision = "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n";
const kNoTool = new Vector4(0, 0, 1e9, 1);  // too far away to take any light
// three.js binds attributes by these names.
const named = (vertex: string) => vertex.replace(/layout\(location = \d\) /g, "").replaceAll("aPosition", "position")
    .replaceAll("aNormal", "normal").replaceAll("aAlong", "along");
const kSolid = named(solid);

/** Vertex and fragment shader of a kind of mesh. */
export const kPrograms = {
    heights: [lightVertex + heightsVertex, near],
    holeEdges: ["#define HOLE_EDGES\n" + lightVertex + heightsVertex, near],
    tin: [lightVertex + tinVertex, near],
    sides: [named(side), near],
    boards: [kSolid, wood],
    tool: [kSolid, toolFragment],
};

/** Returns the albedo of wet sand, as wetAlbedo() of render_node/scene_painter.cpp does. */
function wetAlbedo(dry: number, humidity: number): number {
    const share = 0.68 * humidity * (2 - humidity);
    return dry * (1 - share) / (1 - share * Math.max(0, Math.min(1, dry)));
}

/** The meshes of a session, and what their shaders share. */
export class SandPrograms {
    private meshes: { mesh: Mesh; program: keyof typeof kPrograms; uniforms: Uniforms }[] = [];
    private made = "";  // for which tool and sand the programs were made
    private readonly uniforms: Uniforms;

    /** `look` is that of a SandMessage. `scale` is that of the room [m per scene unit]. */
    constructor(private readonly scene: Scene, private readonly look: Float32Array, sceneToRoom: Matrix4, scale: number, grain: DataTexture) {
        this.uniforms = {
            uSceneToRoom: { value: sceneToRoom }, uRoomToClip: { value: new Matrix4() }, uSceneToClip: { value: new Matrix4() },
            uEye: { value: new Vector3() }, uHalfPicture: { value: new Vector2() }, uSun: { value: new Vector3(look[6], look[7], look[8]).normalize() },
            uSand: { value: new Vector3() }, uWet: { value: 0 }, uTool: { value: new Vector4() }, uToolSpace: { value: new Matrix3() },
            uToolSun: { value: new Vector3() }, uToolStep: { value: 1 }, uGrain: { value: grain },
            uGrainScale: { value: scale / (256 * 0.0006) }, uCutAndFill: { value: 0 },
        };
    }
    add(geometry: BufferGeometry, program: keyof typeof kPrograms, uniforms: Uniforms = {}): Mesh {
        const mesh = new Mesh(geometry);
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

    /** Shows the sand's humidity, and the tool in it. */
    take(tool: Tool, humidity: number): void {
        this.make(tool, humidity > 0);
        this.uniforms.uSand.value.set(...[0, 1, 2].map((i) => wetAlbedo(this.look[i], humidity)));
        this.uniforms.uWet.value = humidity;
        if (tool.radius === 0) {
            this.uniforms.uTool.value.copy(kNoTool);
            return;
        }
        const lit = lightOf(tool, this.uniforms.uSun.value), { x, y, z } = isBall(tool) ? tool.place : lit.centre;
        this.uniforms.uTool.value.set(x, y, z, isBall(tool) ? 1 / tool.radius : 1);
        this.uniforms.uToolSpace.value.copy(lit.space);
        this.uniforms.uToolSun.value.copy(lit.sun);
        this.uniforms.uToolStep.value = lit.step;
    }
    /** Gives all meshes the programs for this tool and for dry or wet sand. */
    private make(tool: Tool, wet: boolean): void {
        const wanted = `${isBall(tool)} ${wet}`;
        if (wanted === this.made) {
            return;
        }
        this.made = wanted;
        const shared = kPrecision + light + (wet ? sheen : "") + sunlit + (isBall(tool) ? ball : stamp);
        for (const { mesh, program, uniforms } of this.meshes) {
            const [vertex, fragment] = kPrograms[program];
            (mesh.material as RawShaderMaterial).dispose();
            mesh.material = new RawShaderMaterial({
                glslVersion: GLSL3, vertexShader: shared + vertex, fragmentShader: shared + fragment, uniforms: { ...this.uniforms, ...uniforms },
            });
        }
    }

    set cutAndFill(on: boolean) { this.uniforms.uCutAndFill.value = on ? 1 : 0; }
    /** `eye` is in the room. */
    lookFrom(eye: Vector3, roomToClip: Matrix4, halfPicture: Vector2): void {
        const { uRoomToClip, uSceneToClip, uSceneToRoom, uEye, uHalfPicture } = this.uniforms;
        uRoomToClip.value.copy(roomToClip);
        uSceneToClip.value.multiplyMatrices(roomToClip, uSceneToRoom.value);
        uEye.value.copy(eye).applyMatrix4(new Matrix4().copy(uSceneToRoom.value).invert());
        uHalfPicture.value.copy(halfPicture);
    }
}
