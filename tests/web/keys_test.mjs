// SPDX-License-Identifier: Apache-2.0
// Tests in node that the page obeys the keys of a wall's window, as docs/pointer.md lists them.
import assert from "node:assert/strict";
import fs from "node:fs";
import { builtModule } from "./built_module.mjs";

const { kKeys, kOfTheBrowser, findKey, keyName } = await builtModule("page/key_list.ts");
const manual = fs.readFileSync(new URL("../../docs/pointer.md", import.meta.url), "utf8").split("## Buttons and keys")[1].split("\n## ")[0];
const rows = [...manual.matchAll(/^\| ((?:`[^`]+` ?)+) \| (.*) \|$/gm)].map(([, keys, effect]) => [[...keys.matchAll(/`([^`]+)`/g)].map(([, key]) => key), effect]);
assert.ok(rows.length > 15, "docs/pointer.md has no list of keys");
const ours = kKeys.flatMap(({ keys }) => keys);
assert.equal(new Set(ours).size, ours.length, "a key has two effects");
for (const [keys, effect] of rows) {
    for (const key of keys) {
        assert.ok(ours.includes(key) || kOfTheBrowser.includes(key), `the page has no key ${key}, which ${effect} in a window`);
    }
}

/** Returns an event of a key without modifiers, or with some. */
const event = (key, more = {}) => ({ key, code: "", ctrlKey: false, metaKey: false, altKey: false, shiftKey: false, repeat: false, ...more });
const names = [["z", { ctrlKey: true }, "Ctrl+Z"], ["z", { metaKey: true }, "Ctrl+Z"], ["R", { shiftKey: true }, "Shift+R"], ["+", { shiftKey: true }, "+"], ["?", { shiftKey: true }, "?"],
               [" ", {}, "Space"], ["PageUp", {}, "PgUp"], ["Escape", {}, "Esc"], ["я", { code: "KeyZ", ctrlKey: true }, "Ctrl+Z"], ["u", { altKey: true }, "Alt+U"]];
for (const [key, more, name] of names) {
    assert.equal(keyName(event(key, more)), name);
}
assert.deepEqual([findKey(event("3")).entry.action, findKey(event("3")).index], ["tool", 2]);
assert.equal(findKey(event("z")), undefined);
assert.equal(findKey(event("+", { repeat: true })).entry.action, "larger");
assert.equal(findKey(event("u", { repeat: true })), undefined, "a held key undoes once");
assert.equal(findKey(event("r", { ctrlKey: true })), undefined, "Ctrl+R is the browser's");
console.log(`the page has the ${rows.flatMap(([keys]) => keys).length} keys of a window`);
