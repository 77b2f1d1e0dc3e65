// SPDX-License-Identifier: Apache-2.0
// Tests in node when the page keeps sand, and what it says if the browser refuses.
import assert from "node:assert/strict";
import { builtModule } from "./built_module.mjs";

const { Keeper } = await builtModule("kept/keeper.ts");
let clock = 0;  // ms
performance.now = () => clock;

/** Sand of which each test says what the hand has done. */
class Sand {
    step = 0;
    touched = 0;
    dug = false;
    get hash() { return `hash ${this.step}`; }
    get written() { return 100 + 10 * this.step; }
    journalFrom(offset) { return new ArrayBuffer(this.written - offset); }
    beginsWith(bytes) { return bytes.byteLength <= this.written; }
    state() { return new Uint8Array(3); }  // too large in some tests
    hover() { this.step += 1; }
    dig() {
        this.step += 1;
        this.touched += 1;
        this.dug = true;
    }
}
/** A browser that writes, or refuses with `refusal`. `refusesState`: it refuses pieces with a state. */
class Browser {
    pieces = [];
    states = 0;
    refusal = undefined;
    refusesState = false;
    gone = [];
    async write(session, { offset, bytes, state }) {
        if (this.refusal) {
            throw this.refusal;
        }
        if (state && this.refusesState) {
            throw full();
        }
        this.states += state ? 1 : 0;
        this.pieces.push({ id: session.id, offset, length: bytes.byteLength });
        return this.gone;
    }
}
const full = () => Object.assign(new Error("x"), { name: "QuotaExceededError" });
const settled = () => new Promise((resolve) => setTimeout(resolve));
function begun(browser, why = "") {
    const told = [], session = { id: "a", name: "dunes", began: 0, changed: 0, seconds: 0 };
    return { told, sand: new Sand(), keeper: new Keeper(browser, why, session, 60, (now) => told.push(now)) };
}

{   // Each piece begins behind the one before. Sand that nobody has changed is not kept.
    const browser = new Browser(), { sand, keeper, told } = begun(browser);
    sand.hover();
    keeper.work(sand, false);
    await settled();
    assert.deepEqual(browser.pieces, []);
    sand.dig();
    keeper.work(sand, false);
    assert.equal(told.at(-1).unkept, true);
    await settled();
    assert.deepEqual([told.at(-1).unkept, told.at(-1).kept], [false, { step: 2, hash: "hash 2" }]);
    sand.hover();
    keeper.work(sand, false);
    await settled();
    sand.dig();
    keeper.work(sand, false);
    await settled();
    assert.deepEqual(browser.pieces, [{ id: "a", offset: 0, length: 120 }, { id: "a", offset: 120, length: 20 }]);
    sand.hover();
    keeper.hurry();  // the page may be closed
    keeper.work(sand, false);
    await settled();
    assert.equal(browser.pieces.length, 3);
    // A stroke is not written step by step.
    sand.dig();
    keeper.work(sand, true);
    await settled();
    assert.equal(browser.pieces.length, 3);
    await keeper.flush(sand);
    assert.deepEqual(browser.pieces.at(-1), { id: "a", offset: 150, length: 10 });
    browser.gone = [{ name: "writing", changed: 0 }];
    sand.dig();
    await keeper.flush(sand);
    assert.match(told.at(-1).gone[0], /^This browser keeps 10 sessions, so the oldest was removed: writing of /);
}
{   // Kept sand continues behind its bytes. If another release has written them, all is written again.
    const browser = new Browser(), { sand, keeper } = begun(browser);
    sand.dig();
    keeper.goOn(sand, new ArrayBuffer(110));
    sand.dig();
    await keeper.flush(sand);
    assert.deepEqual(browser.pieces, [{ id: "a", offset: 110, length: 10 }]);
    const other = begun(browser);
    other.sand.dig();
    other.keeper.goOn(other.sand, new ArrayBuffer(1000));
    await other.keeper.flush(other.sand);
    assert.equal(browser.pieces.at(-1).offset, 0);
}
{   // A browser that keeps nothing. A file is as good.
    const { sand, keeper, told } = begun(undefined, "it has no IndexedDB");
    sand.dig();
    keeper.work(sand, false);
    assert.deepEqual([told.at(-1).unkept, told.at(-1).why, keeper.waitMs], [true, "it has no IndexedDB", undefined]);
    keeper.save(sand);
    keeper.work(sand, false);
    assert.equal(told.at(-1).unkept, false);
    sand.dig();
    keeper.work(sand, false);
    assert.equal(told.at(-1).unkept, true);
}
{   // A full disk, and then not.
    const browser = new Browser(), { sand, keeper, told } = begun(browser);
    browser.refusal = full();
    sand.dig();
    await keeper.flush(sand);
    assert.deepEqual([told.at(-1).unkept, told.at(-1).why, keeper.waitMs > 0], [true, "its storage is full", true]);
    browser.refusal = undefined;
    await keeper.flush(sand);
    assert.deepEqual([told.at(-1).unkept, told.at(-1).why, told.at(-1).gone], [false, "", ["The sand is kept again."]]);
    assert.deepEqual(browser.pieces, [{ id: "a", offset: 0, length: 110 }]);
    assert.equal(keeper.waitMs, undefined);
}
{   // On a full disk the page tries again after 5 s, and then ever more rarely.
    const browser = new Browser(), { sand, keeper, told } = begun(browser), waits = [];
    browser.refusal = full();
    sand.dig();
    for (let i = 0; i < 6; ++i) {
        keeper.work(sand, false);
        await settled();
        waits.push(keeper.waitMs);
        clock += keeper.waitMs - 1;
        browser.refusal = new Error("was asked too early");
        keeper.work(sand, false);
        await settled();
        browser.refusal = full();
        clock += 1;
    }
    assert.deepEqual(waits, [5000, 10_000, 20_000, 40_000, 60_000, 60_000]);
    assert.deepEqual(told.map(({ unkept, why }) => [unkept, why]), [[true, ""], [true, "its storage is full"]], "the page is told of changes alone");
    browser.refusal = undefined;
    keeper.work(sand, false);
    await settled();
    assert.deepEqual([told.at(-1).unkept, keeper.waitMs], [false, undefined]);
    sand.dig();
    browser.refusal = full();
    keeper.work(sand, false);
    await settled();
    assert.equal(keeper.waitMs, 5000);
}
{   // A state that the memory or the browser has no room for keeps no sand from being kept. It is tried again after a minute.
    const browser = new Browser(), { sand, keeper, told } = begun(browser);
    let states = 0;
    async function dig(ms) {
        clock += ms;
        sand.dig();
        await keeper.flush(sand);
        assert.deepEqual([told.at(-1).unkept, told.at(-1).why], [false, ""]);
    }
    sand.state = () => {
        states += 1;
        throw new Error("This page has no more memory");
    };
    await dig(6000);
    await dig(6000);
    assert.deepEqual([browser.pieces.length, states], [2, 1]);
    sand.state = () => {
        states += 1;
        return new Uint8Array(3);
    };
    browser.refusesState = true;
    await dig(60_000);
    await dig(6000);
    assert.deepEqual([browser.pieces.length, states, browser.states], [4, 2, 0]);
    browser.refusesState = false;
    await dig(60_000);
    assert.deepEqual([browser.pieces.length, states, browser.states], [5, 3, 1]);
    assert.deepEqual(browser.pieces.map(({ offset }) => offset), [0, 110, 120, 130, 140]);
}
{   // If the browser has lost what was kept, all is written anew.
    const browser = new Browser(), { sand, keeper, told } = begun(browser), write = browser.write.bind(browser);
    sand.dig();
    await keeper.flush(sand);
    browser.write = async (session, piece) => {
        if (piece.offset > 0) {
            throw Object.assign(new Error("gone"), { name: "LostSand" });
        }
        return write(session, piece);
    };
    sand.dig();
    await keeper.flush(sand);
    assert.deepEqual(browser.pieces, [{ id: "a", offset: 0, length: 110 }, { id: "a", offset: 0, length: 120 }]);
    assert.deepEqual([told.at(-1).unkept, told.at(-1).why], [false, ""]);
}
console.log("the page keeps what the hand has dug, and says so if it cannot");
