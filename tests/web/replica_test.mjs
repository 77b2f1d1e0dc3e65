// SPDX-License-Identifier: Apache-2.0
// Replays sessions with the page's replica in node, and compares their hashes with those that the native program wrote.
// usage: node replica_test.mjs REPLICA_FOLDER SESSIONS LIST. Prints a line for each session; fails at a difference.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { loadReplica } from "./loaded_replica.mjs";

const [build, folder, list] = process.argv.slice(2);
const loaded = await loadReplica(build), replica = loaded.wasm;
const open = (name, parts) => loaded.open(name, parts);

function partsOf(file, count) {
    const names = [file, ...Array.from({ length: count - 1 }, (_, i) => `${file}.${i + 2}`)];
    return names.map((name) => fs.readFileSync(path.join(folder, name)));
}

function replay(file, count, steps, hashes, hash) {
    assert.equal(open(file, partsOf(file, count)), "");
    assert.equal(loaded.session.shortcoming, "");
    assert.equal(loaded.session.lastStep, steps, file);
    assert.equal(loaded.session.hashes, hashes, file);
    const started = process.cpuUsage();
    let middle = null;
    while (replica._sw_advance() === 1) {
        if (middle === null && replica._sw_step() >= steps / 2) {
            middle = { step: replica._sw_step(), hash: loaded.hash, state: loaded.state().slice() };
        }
    }
    const spent = process.cpuUsage(started), ms = (spent.user + spent.system) / 1000 / steps;
    assert.equal(replica._sw_mismatches(), 0, file);
    assert.equal(replica._sw_matches(), hashes, file);
    assert.equal(replica._sw_step(), steps, file);
    assert.equal(loaded.hash, hash, file);
    // Back to the middle and forwards again. The hashes are compared again, and counted once.
    loaded.restore(middle.state.length, (into) => into.set(middle.state));
    assert.equal(replica._sw_step(), middle.step);
    assert.equal(loaded.hash, middle.hash);
    while (replica._sw_step_on() === 1) {}
    assert.equal(loaded.hash, hash, `${file}, from the middle`);
    assert.deepEqual([replica._sw_matches(), replica._sw_mismatches()], [hashes, 0], file);
    console.log(`${file}: ${hashes} of ${hashes} hashes, ${hash}, ${ms.toFixed(2)} ms of processor a step`);
}

const sessions = fs.readFileSync(list, "utf8").trim().split("\n").map((line) => line.split(" "));
assert.ok(sessions.length > 5);
const pieces = {};  // of the drawing, by session
for (const [file, count, steps, hashes, hash] of sessions) {
    replay(file, Number(count), Number(steps), Number(hashes), hash);
    pieces[file] = loaded.draw();
    const again = loaded.draw().some((piece) => piece.aHeight);
    assert.equal(again, !loaded.session.hasHeights, `${file}: of a grid, only what has changed is drawn again`);
}
const numbersOf = (file, name) => pieces[file].flatMap((piece) => [...(piece[name] ?? [])]);
// What pages draw: all vertices have their triangles, and beside cells without ground there are more.
for (const { 0: file } of sessions) {
    const [count] = numbersOf(file, "vertices"), corners = pieces[file].flatMap((piece) => (piece.triangles ? [piece.triangles] : []));
    assert.equal(pieces[file].reduce((sum, piece) => sum + (piece.aHeight?.length ?? 0), 0), count, file);
    assert.ok(corners.length > 0 && corners.every((part) => part.every((corner) => corner < count)), file);
    assert.ok(numbersOf(file, "sides").length > 0 && numbersOf(file, "boards").length > 0, file);
}
// The tool of each kind has triangles, and its light.
for (const { 0: file } of sessions.filter(([name]) => name.startsWith("tool_"))) {
    assert.ok(numbersOf(file, "tool").length > 3 * 8, file);
    assert.equal(numbersOf(file, "ball")[0], file === "tool_sphere.journal" ? 1 : 0, file);
    assert.equal(numbersOf(file, "uEngaged")[0], 1, file);
}

// Bad files leave the session before open.
const [file, count, steps] = sessions.at(-1);
const last = loaded.hash;
const good = partsOf(file, Number(count));
const changed = (at, to) => { const bytes = Buffer.from(good[0]); bytes[at] = to; return [bytes]; };
assert.match(open("x", [Buffer.alloc(0)]), /^x: is empty/);
assert.match(open("x", [Buffer.from("no journal at all")]), /^x: not a Sandwall journal file/);
assert.match(open("x", changed(4, 77)), /^x: written by sandwall 1\.2\.3 .* A page cannot run another release/);
assert.match(open("x", changed(60, good[0][60] ^ 1)), /^x: its header is cut off or damaged/);
assert.equal(loaded.hash, last);
// A torn tail and damage in the middle open up to there.
assert.equal(open(file, [good[0].subarray(0, good[0].length - 3)]), "");
assert.match(loaded.session.shortcoming, /bytes are an incomplete write/);
const middle = Math.floor(good[0].length * 0.98);
assert.equal(open(file, changed(middle, good[0][middle] ^ 1)), "");
assert.match(loaded.session.shortcoming, /damaged at byte [0-9]+ of/);
assert.ok(loaded.session.lastStep > 0 && loaded.session.lastStep < Number(steps), "some steps are intact");
while (replica._sw_advance() === 1) {}
assert.equal(replica._sw_mismatches(), 0);
// A part or a state that is too large is a sentence, and the session goes on.
const before = loaded.hash;
for (const makeRoom of [replica._sw_add_part, replica._sw_room_for_state]) {
    for (const size of [2 ** 31 - 4096, 2 ** 32 - 1]) {
        assert.equal(makeRoom(size), 0);
        assert.equal(loaded.problem, "This page has no more memory");
    }
}
assert.equal(loaded.hash, before);
assert.ok(loaded.draw().length > 0);

console.log(`${sessions.length} sessions equal the native program's`);
