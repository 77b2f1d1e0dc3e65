// SPDX-License-Identifier: Apache-2.0
// Tests that a tool which the page hides throws no shadow. The page hides it until a pointer has shown where it is.
import assert from "node:assert/strict";
import { builtModule } from "./built_module.mjs";

const { SandMeshes } = await builtModule("drawing/sand_meshes.ts");
const scene = { add() {}, background: null };
const meshes = new SandMeshes(scene, { columns: 40, rows: 30, cell: 0.1, middle: 0 });
const frameWithTool = (x) => [{ uTool: new Float32Array([x, 2, 3, 4]), uModel: new Float32Array([x, 2, 3, 0.25]), ball: new Float32Array([1]), uWet: new Float32Array([0]) }];
const lit = () => [...meshes.programs.uniforms.uTool.value];
const far = [0, 0, 1e9, 1].map(Math.fround);

meshes.show(frameWithTool(1));
assert.deepEqual([meshes.showsTool, lit()], [true, [1, 2, 3, 4]]);
meshes.showTool(false);
assert.deepEqual([meshes.showsTool, lit()], [false, far], "no shadow without its tool");
meshes.show(frameWithTool(5));
assert.deepEqual([meshes.showsTool, lit()], [false, far], "nor in later frames");
meshes.showTool(true);
assert.deepEqual([meshes.showsTool, lit()], [true, [5, 2, 3, 4]], "the shadow of the place where the tool is now");
