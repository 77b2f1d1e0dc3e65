// SPDX-License-Identifier: Apache-2.0
// Tests of web/kept/kept_sand.ts with the IndexedDB and the locks of a browser, in two tabs.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import path from "node:path";
import { root } from "./browser.mjs";

/** Opens a tab of the page's address without the page, with `kept`: the module and an open KeptSand. */
async function newTab(browser, address) {
    const { buildSync } = createRequire(`${root}web/package.json`)("esbuild");
    const built = buildSync({ entryPoints: [path.join(root, "web/kept/kept_sand.ts")], bundle: true, format: "iife", globalName: "kept", write: false });
    const tab = await browser.newPage();
    await tab.goto(`${address}page.css`);
    await tab.evaluate(built.outputFiles[0].text);
    await tab.evaluate(async () => {
        globalThis.sand = await kept.KeptSand.open();
        /** Writes a piece of `length` bytes. Returns the ids that had to go, or what was refused. */
        globalThis.write = (id, changed, offset, length) => sand.write({ id, name: "flat", began: 0, changed, seconds: 1 }, { offset, bytes: new Uint8Array(length).fill(offset + 1).buffer })
            .then((gone) => gone.map((session) => session.id), ({ name }) => name);
        globalThis.read = async (id) => {
            const found = await sand.read(id);
            return found && [...new Uint8Array(found.bytes)];
        };
    });
    return tab;
}
const ids = (tab) => tab.evaluate(async () => (await sand.list()).map(({ id }) => id));

export async function testKeptSand(browser, address) {
    const [one, other] = [await newTab(browser, address), await newTab(browser, address)];
    const write = (tab, ...piece) => tab.evaluate((all) => globalThis.write(...all), piece), read = (tab, id) => tab.evaluate((of) => globalThis.read(of), id);
    // Pieces follow each other. A piece that is written again replaces all behind it.
    assert.deepEqual([await write(one, "a", 1, 0, 2), await write(one, "a", 2, 2, 1), await read(other, "a")], [[], [], [1, 1, 3]]);
    assert.deepEqual([await write(one, "a", 3, 0, 1), await read(other, "a")], [[], [1]]);
    // A piece whose beginning is gone is refused, because nobody could read it.
    assert.deepEqual([await write(one, "a", 3, 2, 1), await read(other, "a")], ["LostSand", [1]]);
    assert.equal(await other.evaluate(() => sand.remove("a")), true);
    assert.deepEqual([await write(one, "a", 3, 1, 1), await read(other, "a"), await ids(one)], ["LostSand", undefined, []]);

    // The eleventh session is one too many. One that another tab has taken meanwhile stays.
    for (let i = 0; i < 10; ++i) {
        await write(one, `s${i}`, i, 0, 1);
    }
    await other.evaluate(async () => { globalThis.letGo = await sand.hold("s0"); });
    await one.evaluate(() => { navigator.locks.query = async () => ({ held: [], pending: [] }); });  // as it was before
    assert.deepEqual(await write(one, "s10", 10, 0, 1), ["s1"]);
    assert.deepEqual([await one.evaluate(() => sand.remove("s0")), await read(other, "s0")], [false, [1]]);
    // A tab that takes a session while it is removed waits, and finds it gone.
    const taken = await one.evaluate(async () => {
        const removed = sand.remove("s2"), held = sand.hold("s2");
        const found = await held.then(() => sand.read("s2"));
        return [await removed, found === undefined];
    });
    assert.deepEqual(taken, [true, true]);
    await other.evaluate(() => letGo());

    // A database that another page has closed, or the browser without a word, is opened again.
    await other.evaluate(() => new Promise((resolve, reject) => {
        const request = indexedDB.deleteDatabase("sandwall");
        Object.assign(request, { onsuccess: resolve, onerror: reject });
    }));
    assert.deepEqual([await write(one, "b", 20, 0, 2), await ids(one), await ids(other)], [[], ["b"], ["b"]]);
    await one.evaluate(() => sand.data.close());
    assert.deepEqual([await write(one, "b", 21, 2, 1), await read(one, "b")], [[], [1, 1, 3]]);
    await one.evaluate(() => sand.remove("b"));
    await one.close();
    await other.close();
}
