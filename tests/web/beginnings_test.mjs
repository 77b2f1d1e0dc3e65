// SPDX-License-Identifier: Apache-2.0
// Tests in node which sand the worker shows when a person chooses other sand while kept sand is computed.
import assert from "node:assert/strict";
import { builtModule } from "./built_module.mjs";

Object.assign(globalThis, {
    self: { location: new URL("http://127.0.0.1/") },
    fetch: async () => new Response("SWJL a scene"),
});
const { Beginnings } = await builtModule("page/beginnings.ts");

/** A replica that says what it was asked for. `records` of a kept journal are computed, the rest of it never ends. */
class Replica {
    asked = [];
    name = "";
    records = Infinity;
    step = 0;
    touched = 0;
    dug = false;
    rests = true;
    settlesNext = false;
    canUndo = false;
    canRedo = false;
    materialText = "{}";
    words = {};
    sceneMaterial = {};
    get hash() { return `hash ${this.step}`; }
    get written() { return 100; }
    session() { return { name: this.name, shortcoming: "", stepsPerSecond: 60 }; }
    begin(how, name) {
        this.asked.push(`${how} ${name}`);
        this.name = name;
    }
    dig(name) { this.begin("dig", name); }
    digAgain() { this.begin("again", this.name); }
    return(name, bytes, state) {
        if (bytes.byteLength === 0) {
            throw new Error(`${name}: is empty`);
        }
        this.begin(state ? "return from a state" : "return", name);
    }
    returnOn() { return --this.records >= 0; }
    beginsWith() { return true; }
    digOn() { return false; }
}
/** A browser that keeps the sand of `a` and of `b`, of which that of `b` is damaged. `held` has the sessions that a tab has. */
class Kept {
    all = ["a", "b"].map((id) => ({ id, name: `sand of ${id}`, began: 0, changed: 0, seconds: 9 }));
    held = new Set();
    async list() { return this.all; }
    async hold(id) {
        if (this.held.has(id)) {
            return undefined;
        }
        this.held.add(id);
        return () => this.held.delete(id);
    }
    async read(id) {
        const session = this.all.find((kept) => kept.id === id);
        return session && { session, bytes: new ArrayBuffer(id === "b" ? 0 : 100), state: { step: 1, hash: "0", bytes: new ArrayBuffer(1) } };
    }
    async remove(id) {
        const there = !this.held.has(id);
        this.all = there ? this.all.filter((kept) => kept.id !== id) : this.all;
        return there;
    }
}
/** Returns a worker's beginnings. `ask` queues them as page/worker.ts does; `computes` waits until kept sand is computed. */
function begun() {
    const replica = new Replica(), kept = new Kept(), told = [], problems = [], sources = [];
    const stage = { tell: (message) => told.push(message), show: () => true, begin: (next) => sources.push(next), loaded: async () => replica };
    const beginnings = new Beginnings(stage, async () => kept);
    let queue = Promise.resolve();
    const ask = (message) => (queue = queue.then(beginnings.take(message)).catch((error) => problems.push(error.message)));
    const computes = async () => {
        while (!replica.asked.some((asked) => asked.startsWith("return"))) {
            await new Promise((resolve) => setTimeout(resolve));
        }
    };
    return { replica, kept, told, problems, sources, beginnings, ask, computes, hands: () => told.filter(({ kind }) => kind === "hand").length };
}
const bounded = setTimeout(() => { throw new Error("a computation does not end"); }, 60_000);

{   // The newest choice counts. What is computed ends at once, and is not begun again; a choice between them does nothing.
    const { replica, kept, problems, sources, ask, computes, hands } = begun();
    void ask({ goOn: "a" });
    await computes();
    assert.ok(kept.held.has("a"));
    void ask({ dig: { name: "ripples" } });
    void ask({ again: true });
    await ask({ dig: { name: "dunes" } });
    assert.deepEqual(replica.asked, ["return from a state sand of a", "dig dunes"]);
    assert.deepEqual([problems, hands(), sources.at(-1) !== undefined], [[], 1, true]);
    assert.equal(kept.held.has("a"), false, "another tab can take it");
}
{   // So does it when the page begins with kept sand.
    const { replica, problems, ask, computes } = begun();
    void ask({ start: { scene: "dunes", only: false, mine: "" } });
    await computes();
    await ask({ dig: { name: "ripples" } });
    assert.deepEqual([replica.asked, problems], [["return from a state sand of a", "dig ripples"], []]);
}
{   // If the newest choice is refused, new sand of the scene that was computed follows.
    const { replica, problems, sources, ask, computes, hands } = begun();
    void ask({ goOn: "a" });
    await computes();
    await ask({ goOn: "b" });
    assert.deepEqual(replica.asked, ["return from a state sand of a", "again sand of a"]);
    assert.deepEqual([problems, hands(), sources.at(-1) !== undefined], [["sand of b: is empty"], 1, true]);
}
{   // To remove sand is no choice of sand.
    const { replica, kept, told, problems, beginnings, ask, computes, hands } = begun();
    const going = ask({ goOn: "a" });
    await computes();
    assert.equal(beginnings.take({ forget: "b" }), undefined);
    await beginnings.forget("b");
    assert.deepEqual(kept.all.map(({ id }) => id), ["a"]);
    await beginnings.forget("a");
    assert.equal(told.at(-1).text, "A tab digs in this sand, so it stays.");
    replica.records = 10;  // the computation is near its end
    await going;
    assert.deepEqual([replica.asked, problems, hands()], [["return from a state sand of a"], [], 1]);
    assert.ok(kept.held.has("a"));
}
{   // Sand that another tab removes while this one takes it.
    const { replica, kept, told, problems, ask } = begun();
    kept.read = async () => undefined;
    await ask({ start: { scene: "dunes", only: false, mine: "" } });
    assert.deepEqual([replica.asked, problems], [["dig dunes"], []]);
    assert.equal(told.find(({ kind }) => kind === "dig").note, "The kept sand of sand of a was removed in another tab. This tab has new sand.");
    await ask({ goOn: "b" });
    assert.deepEqual(problems, ["The kept sand of sand of b was removed in another tab."]);
    assert.equal(kept.held.has("b"), false);
}
clearTimeout(bounded);
console.log("the newest choice of sand counts");
