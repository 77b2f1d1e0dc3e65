// SPDX-License-Identifier: Apache-2.0
// Tests in node that the page obeys the keys of a wall's window, as docs/pointer.md lists them.
import assert from "node:assert/strict";
import fs from "node:fs";
import { builtModule } from "./built_module.mjs";

const { kKeys, kOfTheBrowser, findKey, keyName } = await builtModule("page/key_list.ts");
const manual = fs.readFileSync(new URL("../../docs/pointer.md", import.meta.url), "utf8").split("## Buttons and keys")[1].split("\n## ")[0];
const rows = [...manual.matchAll(/^\| ((?:`[^`]+` ?)+) \| (.*) \|$/gm)].map(([, keys, effect]) => [[...keys.matchAll(/`([^`]+)`/g)].map(([, key]) => key), effect]);
assert.ok(rows.length > 15, "docs/pointer.md has no list of keys");
const ours = kKeys.flatMap(({ keys }) => keys), theirs = rows.flatMap(([keys]) => keys);
assert.equal(new Set(ours).size, ours.length, "a key has two effects");
assert.deepEqual([...ours, ...kOfTheBrowser].sort(), [...theirs].sort(), "docs/pointer.md and the page have other keys");
for (const { keys, effect } of kKeys.filter(({ action }) => action !== "onlyInAWindow")) {
    assert.ok(rows.some(([row]) => keys.every((key) => row.includes(key))), `${keys.join(" ")}, ${effect}: are several rows of docs/pointer.md`);
}
const onlyInAWindow = kKeys.find(({ action }) => action === "onlyInAWindow").keys;
assert.deepEqual(rows.filter(([, effect]) => /wireframe|hill-shade|force|test pattern|film/.test(effect)).flatMap(([keys]) => keys).sort(), [...onlyInAWindow].sort());

/** Returns an event of a key without modifiers, or with some. */
const event = (key, more = {}) => ({ key, code: "", ctrlKey: false, metaKey: false, altKey: false, shiftKey: false, repeat: false, ...more });
const names = [["z", { ctrlKey: true }, "Ctrl+Z"], ["z", { metaKey: true }, "Ctrl+Z"], ["R", { shiftKey: true }, "Shift+R"], ["+", { shiftKey: true }, "+"], ["?", { shiftKey: true }, "?"],
               [" ", {}, "Space"], ["PageUp", {}, "PgUp"], ["Escape", {}, "Esc"], ["я", { code: "KeyZ", ctrlKey: true }, "Ctrl+Z"], ["u", { altKey: true }, "Alt+U"]];
for (const [key, more, name] of names) {
    assert.equal(keyName(event(key, more)), name);
}
assert.deepEqual([findKey(event("3")).entry.action, findKey(event("3")).index], ["tool", 2]);
assert.equal(findKey(event("z")), undefined);
assert.deepEqual(["+", "u"].map((key) => findKey(event(key)).acts), [true, true]);
assert.deepEqual(["+", "u"].map((key) => findKey(event(key, { repeat: true })).acts), [true, false], "a held key undoes once");
assert.equal(findKey(event("r", { ctrlKey: true })), undefined, "Ctrl+R is the browser's");

// What a page does with an event: whether it acts, and whether the browser does nothing.
globalThis.HTMLElement = class {
    constructor(...selectors) { this.selectors = selectors; }
    matches(list) { return list.split(", ").some((selector) => this.selectors.includes(selector)); }
};
globalThis.document = new EventTarget();
const { Keys } = await builtModule("page/keys.ts"), acts = [];
new Keys(new EventTarget(), (action) => acts.push(action), {}, () => true);
function pressed(key, target, more = {}) {
    const down = Object.assign(new Event("keydown", { cancelable: true }), event(key, more));
    Object.defineProperty(down, "target", { value: target });
    acts.length = 0;
    document.dispatchEvent(down);
    return [acts.join(), down.defaultPrevented];
}
const sand = new HTMLElement("canvas"), select = new HTMLElement("select"), number = new HTMLElement("input[type=number]", "input"), depth = new HTMLElement("input[type=range]", "input");
const control = { ctrlKey: true }, held = { repeat: true };
for (const [key, target, more, action, prevented] of [
    ["s", sand, control, "save", true], ["s", sand, { ...control, ...held }, "", true], ["s", select, control, "save", true], ["s", number, control, "save", true],
    ["z", number, control, "", false], ["z", depth, control, "undo", true], ["2", number, {}, "", false], ["2", sand, {}, "tool", true], ["w", select, {}, "", false],
    [" ", new HTMLElement("button"), {}, "", false], [" ", sand, {}, "pause", true], [" ", sand, held, "", true], ["Home", depth, {}, "", false], ["+", depth, {}, "", false],
    ["+", sand, held, "larger", true], ["F1", select, {}, "help", true], ["Escape", number, {}, "escape", true], ["x", sand, {}, "", false], ["r", sand, control, "", false],
]) {
    assert.deepEqual(pressed(key, target, more), [action, prevented], `${key} ${JSON.stringify(more)} on ${target.selectors[0]}`);
}
console.log(`the page has the ${theirs.length} keys of a window, and no others`);
