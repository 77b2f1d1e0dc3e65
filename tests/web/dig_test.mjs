// SPDX-License-Identifier: Apache-2.0
// Digs with the page's replica in node, with every tool, edit and number of the material, and saves the journals.
// usage: node dig_test.mjs REPLICA_FOLDER FOLDER SCENE... Writes FOLDER/dug_NAME.journal and prints a line for each:
// FILE STEPS HASH. The native program compares them.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { loadReplica } from "./loaded_replica.mjs";

const [build, folder, ...scenes] = process.argv.slice(2);
const loaded = await loadReplica(build), replica = loaded.wasm;
let field;  // of the sand
const good = (result) => loaded.good(result);
/** Calls a function that must refuse, and returns its sentence. */
function refusal(call) {
    assert.equal(call(), -1);
    return loaded.problem;
}
const beginScene = (name, bytes) => { loaded.add([bytes]); return loaded.withText(name, (at) => replica._sw_dig_scene(at, 7, 9)); };
const beginGrid = (name, text) => { loaded.add([Buffer.from(text)]); return loaded.withText(name, (at) => replica._sw_dig_grid(at, 7, 9)); };
const setMaterial = (word, value) => loaded.withText(word, (at) => replica._sw_set_material(at, value));
const setTool = (part, value) => loaded.withText(String(value), (to) => loaded.withText(part, (at) => replica._sw_set_tool(at, to)));
const ask = (edit) => loaded.withText(edit, (at) => replica._sw_ask(at));

/** Looks straight down at the place (x, y), which counts in shares of the field. */
function point(ms, x, y, pressed) {
    good(replica._sw_point(ms, x * field.columns, y * field.rows, 20000, 0, 0, -1, pressed ? 1 : 0));
}

/** Draws loops for `count` steps, and lifts the tool at their end. */
function draw(count) {
    for (let i = 0; i < count; ++i) {
        const step = replica._sw_step();
        for (let k = 0; k < 3; ++k) {
            const t = (step + k / 3) / 60;
            point(1000 / 60 * (step + k / 3), 0.5 + 0.3 * Math.cos(1.3 * t), 0.5 + 0.3 * Math.sin(1.9 * t), i + 1 < count);
        }
        good(replica._sw_dig_on());
    }
}
function rest(count) {
    for (let i = 0; i < count; ++i) {
        good(replica._sw_dig_on());
    }
}

/** Returns the heights of a grid, or the sorted vertices of a TIN's triangles. */
function heights() {
    const pieces = loaded.draw(), of = (name) => pieces.find((piece) => piece[name])?.[name];
    return of("heights") ?? [...new Set(of("triangles"))].map((vertex) => [of("aHeight")[vertex], of("aGrid")[2 * vertex], of("aGrid")[2 * vertex + 1]].join(" ")).sort();
}

/** Digs with every tool, edit and some numbers of the material. */
function digWithAll() {
    field = loaded.session;
    const { radius } = loaded.material.tool;
    assert.match(refusal(() => ask("undo")), /nothing to undo/);
    const start = heights();
    let last;
    for (const [i, name] of loaded.words.tools.entries()) {
        last = heights();
        good(setTool("kind", name));
        good(setTool("radius", radius * (1 + i / 4)));
        good(setTool("heading", 30 * i));
        good(replica._sw_set_depth(0.3 + i / 10));
        draw(25);
        rest(4);
        assert.notDeepEqual(heights(), last, `the tool ${name} has dug nothing`);
        assert.equal(loaded.material.tool.kind, name);
    }
    good(ask("undo"));
    rest(1);
    assert.deepEqual(heights(), last, "an undo restores the sand from before the stroke");
    good(ask("redo"));
    rest(1);
    assert.notDeepEqual(heights(), last, "a redo brings the stroke back");
    assert.match(refusal(() => ask("redo")), /nothing to redo/);
    for (let i = 0; i < loaded.words.tools.length; ++i) {
        good(ask("undo"));
        rest(1);
    }
    assert.deepEqual(heights(), start, "undos restore the start");
    assert.match(refusal(() => ask("undo")), /nothing to undo/);
    good(setMaterial("humidity", 0.4));
    good(setMaterial("talus", 25));
    good(setMaterial("cohesion", radius / 2));
    draw(20);
    good(ask("settle"));
    rest(3);
    good(setTool("kind", "sphere"));
    draw(20);
    good(ask("reset"));
    rest(1);
    assert.deepEqual(heights(), start, "a reset restores the start");
    rest(1);
    draw(20);
    rest(10);
}

function save(name) {
    const length = replica._sw_journal();
    good(length);
    const at = replica._sw_state_bytes();
    const file = `dug_${name}.journal`;
    fs.writeFileSync(path.join(folder, file), replica.HEAPU8.slice(at, at + length));
    console.log(`${file} ${replica._sw_step()} ${loaded.hash}`);
}

/** Returns a grid with a hill, and with a corner without data. */
function hill(columns, rows, header) {
    const lines = [header];
    for (let row = 0; row < rows; ++row) {
        lines.push(Array.from({ length: columns }, (_, column) => row + column < 12 ? -9999
            : (500 + 40 * Math.exp(-((column - columns / 2) ** 2 + (row - rows / 2) ** 2) / 400)).toFixed(3)).join(" "));
    }
    return lines.join("\n") + "\n";
}
const headerOf = (columns, rows, more) => `ncols ${columns}\nnrows ${rows}\n${more}`;

for (const scene of scenes) {
    const name = path.basename(scene, ".scene");
    good(beginScene(name, fs.readFileSync(scene)));
    digWithAll();
    save(name);
}
good(beginGrid("hill.asc", hill(120, 90, headerOf(120, 90, "xllcorner 4000\nyllcorner 5000\ncellsize 2\nNODATA_value -9999"))));
digWithAll();
// What is refused changes nothing.
const before = loaded.hash;
assert.match(refusal(() => setMaterial("talus", 90)), /^talus must be within \[0, 90\), got 90/);
assert.match(refusal(() => setMaterial("stone", 1)), /^a material has no 'stone'/);
assert.match(refusal(() => setTool("radius", 1e9)), /radius/);
assert.match(refusal(() => setTool("kind", "spoon")), /^a tool's kind cannot be 'spoon'/);
assert.match(refusal(() => replica._sw_set_depth(3)), /^the depth must be within/);
assert.match(refusal(() => ask("load")), /^there is no edit 'load'/);
assert.match(refusal(() => beginGrid("x.asc", "no grid")), /^x\.asc:1: /);
assert.match(refusal(() => beginGrid("x.asc", headerOf(3, 2, "cellsize 1\n1 2 3\n4 five 6\n"))), /^x\.asc:5: a height must be a finite number, got 'five'/);
assert.match(refusal(() => beginGrid("x.asc", headerOf(3, 2, "cellsize 1\n1 2 3\n4 5"))), /^x\.asc:5: the file ends/);
assert.match(refusal(() => beginGrid("x.asc", hill(40, 40, headerOf(40, 40, "xllcorner 8\nyllcorner 47\ncellsize 0.0001\nNODATA_value -9999")))), /^x\.asc: its lengths seem to be degrees/);
assert.match(refusal(() => beginGrid("x.asc", headerOf(16384, 16384, "cellsize 1\n1 2 3\n"))), /^x\.asc: 16384 x 16384 cells need at least [0-9]+ MiB, and a page has [0-9]+ MiB/);
assert.match(refusal(() => { loaded.add([Buffer.from(headerOf(9000, 9000, "cellsize 1\n1 2"))]); return loaded.withText("x.asc", (at) => replica._sw_check_grid(at, 5e8)); }), /a page has/);
assert.match(refusal(() => beginGrid("x.asc", headerOf(3, 2, "dx 1\ndy 2\n1 2 3\n4 5 6\n"))), /^x\.asc: has cells of 1 x 2/);
assert.match(refusal(() => beginGrid("x.asc", headerOf(3, 2, "cellsize 1\n1 2 3\n4 5 9000\n"))), /^x\.asc: heights from 1 to 9000 span more/);
assert.match(refusal(() => beginScene("x.scene", Buffer.from("no scene"))), /^x\.scene: not a Sandwall journal file/);
assert.equal(loaded.hash, before);
for (let i = 0; i < 16; ++i) {
    good(ask("reset"));
}
assert.match(refusal(() => ask("reset")), /^16 edits wait for their steps already/);
rest(17);
save("hill");
