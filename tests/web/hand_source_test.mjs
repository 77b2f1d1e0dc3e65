// SPDX-License-Identifier: Apache-2.0
// Tests in node when the page's hand makes steps, and what it does with the pointer during a pause.
import assert from "node:assert/strict";
import { builtModule } from "./built_module.mjs";

const { HandSource } = await builtModule("hand/hand_source.ts");

/** Sand that counts its steps, and the readings that wait for one. */
class Replica {
    step = 0;
    readings = [];
    rests = true;
    settlesNext = false;
    canUndo = false;
    canRedo = false;
    materialText = "{}";
    hash = "";
    point(numbers) {
        for (let i = 0; i < numbers.length; i += 8) {
            this.readings.push({ ms: numbers[i], x: numbers[i + 1], pressed: numbers[i + 7] === 1 });
        }
    }
    digOn() {
        this.step += 1;
        return false;
    }
}
const reading = (ms, x, pressed) => Float64Array.from([ms, x, 0, 0, 0, 0, -1, pressed ? 1 : 0]);
let clock = 1000;  // ms
performance.now = () => clock;
const pass = (ms) => { clock += ms; };
function begun() {
    const replica = new Replica(), told = [], keeper = { work() {}, hurry() {}, waitMs: undefined };
    return { replica, told, keeper, source: new HandSource(replica, 60, { tell: (message) => told.push(message), show: () => true }, keeper) };
}

{   // A pause lifts the tool, makes no step, and takes no readings, which would fill the memory.
    const { replica, source } = begun();
    source.take({ hand: reading(100, 5, true) });
    pass(60);
    assert.ok(source.work() >= 0);
    const { step } = replica;
    assert.ok(step > 0);
    source.take({ pause: true });
    for (let i = 0; i < 1000; ++i) {
        source.take({ hand: reading(200 + i, 6, i % 2 === 0) });
    }
    pass(60);
    assert.equal(source.work(), undefined, "a pause waits for a message");
    assert.deepEqual(replica.readings, [{ ms: 100, x: 5, pressed: true }, { ms: 101, x: 5, pressed: false }]);
    assert.equal(replica.step, step);
    source.take({ pause: false });
    pass(60);
    assert.ok(source.work() >= 0);
    assert.ok(replica.step > step);
    source.take({ hand: reading(2000, 7, true) });
    assert.deepEqual(replica.readings.at(-1), { ms: 2000, x: 7, pressed: true });
    source.take({ hand: reading(2010, 7, false) });
    source.take({ pause: true });
    assert.equal(replica.readings.length, 4, "a tool that hovers is not lifted");
}
{   // Sand at rest waits for the pointer, and meanwhile only for the next try to keep it, such as on a full disk.
    const { replica, source, keeper } = begun();
    for (let i = 0; i < 1000 && source.work() !== undefined; ++i) {
        pass(50);  // up to four steps
    }
    assert.equal(source.work(), undefined);
    const { step } = replica;
    keeper.waitMs = 4000;
    assert.equal(source.work(), 4000);
    pass(60);
    assert.equal(source.work(), 4000);
    assert.equal(replica.step, step, "to keep sand needs no step");
    source.take({ hand: reading(1, 1, false) });
    pass(60);
    assert.ok(source.work() < 20);
    assert.ok(replica.step > step);
}
{   // What keys change by notches is told.
    const { replica, told, source } = begun(), asked = [];
    Object.assign(replica, { changeByNotches: (...change) => asked.push(change), enlargeTool: () => asked.push("enlarge") });
    const materials = () => told.filter(({ kind }) => kind === "material").length;
    const before = materials();
    source.take({ of: "size", notches: -2 });
    source.take({ enlarge: true });
    assert.deepEqual([asked, materials() - before], [[["size", -2], "enlarge"], 2]);
}
{   // So is a material that a step has changed, such as an undo.
    const { replica, told, source } = begun();
    for (const text of ["{}", '{"tool":1}', '{"tool":1}']) {
        replica.materialText = text;
        pass(200);
        source.work();
    }
    assert.deepEqual(told.filter(({ kind }) => kind === "material"), [{ kind: "material" }, { kind: "material", tool: 1 }]);
}
console.log("the hand rests, pauses and changes the tool");
