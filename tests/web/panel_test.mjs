// SPDX-License-Identifier: Apache-2.0
// Fills the controls for digging in node: with the words of the replica, and with words of which no page knows.
// usage: node panel_test.mjs REPLICA_FOLDER SCENE
import assert from "node:assert/strict";
import fs from "node:fs";
import { builtModule } from "./built_module.mjs";
import { loadReplica } from "./loaded_replica.mjs";

const [build, scene] = process.argv.slice(2);
const elements = new Map();  // by id

/** What the panel uses of an element. */
class Control {
    value = "";
    textContent = "";
    disabled = false;
    options = [];
    classList = { toggle() {} };
    append(...options) { this.options.push(...options); }
    replaceChildren(...options) {
        this.options = options;
        this.value = options[0].value;
    }
    setAttribute(name, text) { this[name] = text; }
    get valueAsNumber() { return Number(this.value); }
    before(control) { elements.set(control.id, control); }
    get selectedIndex() { return this.options.findIndex(({ value }) => value === this.value); }
}
const html = fs.readFileSync(new URL("../../web/page/index.html", import.meta.url), "utf8");
for (const [, id] of html.matchAll(/ id="(\w+)"/g)) {
    elements.set(id, new Control());
}
Object.assign(globalThis, {
    SCENES: ["writing"],
    Option: class { constructor(text, value = text) { Object.assign(this, { text, value }); } },
    document: { body: new Control(), createElement: () => new Control(), getElementById: (id) => elements.get(id) ?? null },
});
const { DigPanel } = await builtModule("page/dig_panel.ts");
const of = (id) => elements.get(id), offered = (id) => of(id).options.map(({ value }) => value);

/** Returns a panel that has begun with these words, and what it tells. */
function begun(words, material) {
    const told = [], panel = new DigPanel((message) => told.push(message), () => {}, () => told.push({ edit: "reset" }));
    panel.begin({ ...loaded.session, words, sceneMaterial: material });
    panel.showMaterial({ kind: "material", ...material });
    return { panel, told };
}

const loaded = await loadReplica(build);
loaded.add([fs.readFileSync(scene)]);
loaded.good(loaded.withText("scene", (at) => loaded.wasm._sw_dig_scene(at, 7, 9)));
const { words, material } = loaded;
const { panel, told } = begun(words, material);
assert.deepEqual(offered("tool"), words.tools);
assert.deepEqual(offered("word"), Object.keys(material.material));
for (const name of words.tools) {
    of("tool").value = name;
    of("tool").onchange();
    const { tool, value } = told.pop();
    loaded.good(loaded.withText(value, (to) => loaded.withText(tool, (at) => loaded.wasm._sw_set_tool(at, to))));
    const now = loaded.material;
    panel.showMaterial({ kind: "material", ...now });
    assert.equal(of("tool").value, name);
    for (const part of ["width", "heading", "foot"]) {
        assert.equal(of(part).disabled, now.tool[part] === undefined, `${name}: ${part}`);
    }
}
for (const { word, lowest, highest } of words.material) {
    of("word").value = word;
    of("word").onchange();
    const { value, min, max } = of("number");
    assert.deepEqual([value, min, max], [+material.material[word].toPrecision(6), lowest, highest]);
}
assert.equal(of("others").textContent, "", "the page knows all that it gets");

// The rules for keys and the wheel are those of the replica.
const depth = of("depth");
assert.deepEqual([depth.min, depth.max, depth.step, depth.value], [0.1, 2, 0.1, "0.5"]);
for (const [notches, value] of [[2, 0.7], [100, 2], [-1, 1.9], [-100, 0.1]]) {
    panel.deepen(notches);
    assert.deepEqual([told.pop(), depth.value, depth["aria-valuetext"]], [{ depth: value }, String(value), `${Math.round(100 * value)} % of the radius`]);
}
of("larger").onclick();
of("smaller").onclick();
panel.changeBy("heading", -1);
panel.changeBy("humidity", 1);
panel.beginLargeEnough();
const byNotches = told.splice(-5);
assert.deepEqual(byNotches, [{ of: "size", notches: 1 }, { of: "size", notches: -1 }, { of: "heading", notches: -1 }, { of: "humidity", notches: 1 }, { enlarge: true }]);
const { radius, heading } = loaded.material.tool;
for (const { of: what, notches } of byNotches.slice(1, 4)) {
    loaded.good(loaded.withText(what, (at) => loaded.wasm._sw_change_by_notches(at, notches)));
}
assert.deepEqual([loaded.material.tool.radius, loaded.material.tool.heading, loaded.material.material.humidity], [radius / 1.25, (heading + 355) % 360, 0.1]);
loaded.good(loaded.wasm._sw_enlarge_tool());

// What a page does not know is offered, or shown by its name.
const more = begun({ ...words, tools: [...words.tools, "spoon"], edits: [...words.edits, "shake"], seas: ["red"] },
                   { ...material, air: 1, tool: { ...material.tool, tilt: 3 } });
assert.equal(offered("tool").at(-1), "spoon");
assert.equal(of("shake").textContent, "shake");
for (const edit of [...words.edits, "shake"]) {
    of(edit).onclick();
    assert.deepEqual(more.told.pop(), { edit });
}
for (const text of ['words: seas ["red"]', "hand: air 1", "tool: tilt 3"]) {
    assert.ok(of("others").textContent.includes(text), of("others").textContent);
}
console.log(`the page offers ${words.tools.length} tools, ${words.material.length} numbers and ${words.edits.length} edits`);
