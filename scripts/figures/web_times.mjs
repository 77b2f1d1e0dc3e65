// SPDX-License-Identifier: Apache-2.0
// Measures the page's replica in node (docs/web.md). Needs build/release (session_files, and verify_times of the target benchmarks) and build/web.
// usage: node scripts/figures/web_times.mjs times     processor's time for a step beside the native kernels, in turns
//        node scripts/figures/web_times.mjs moments   100 random moments after the first pass
//        node scripts/figures/web_times.mjs hour      an hour's session: memory during the first pass, then moments
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { builtModule } from "../../tests/web/built_module.mjs";
import { loadReplica } from "../../tests/web/loaded_replica.mjs";

const root = fileURLToPath(new URL("../../", import.meta.url)), programs = path.join(root, "build/release/bin"), built = path.join(root, "build/web/bin");
const what = process.argv[2], kRounds = 5, kMoments = 100;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "web_times-"));
process.on("exit", () => fs.rmSync(folder, { recursive: true }));
const { Keyframes, copyState } = await builtModule("replica/keyframes.ts");
const loaded = await loadReplica(built), wasm = loaded.wasm;
const state = () => loaded.state();

function open(file) {
    const refusal = loaded.open("session", [fs.readFileSync(file)]);
    if (refusal !== "") {
        throw new Error(refusal);
    }
}
function requireEqual() {
    if (wasm._sw_mismatches() !== 0) {
        throw new Error("hashes differ");
    }
}
/** Computes the whole session, and returns the processor's time for a step [ms]. */
function pass(file) {
    open(file);
    const began = process.cpuUsage();
    while (wasm._sw_advance() === 1) {}
    const spent = process.cpuUsage(began);
    requireEqual();
    return (spent.user + spent.system) / 1000 / wasm._sw_step();
}
const sorted = (numbers) => [...numbers].sort((a, b) => a - b);
const median = (numbers) => sorted(numbers)[Math.floor(numbers.length / 2)];
const write = (kind) => execFileSync(path.join(programs, "session_files"), [folder, kind], { cwd: root, encoding: "utf8" }).trim().split("\n").map((line) => line.split(" ")[0]);

function times() {
    console.log("session, wasm [ms], native baseline, native v3, wasm / baseline, wasm / v3");
    for (const name of write("times")) {
        const file = path.join(folder, name), found = { wasm: [], baseline: [], "x86-64-v3": [] };
        pass(file);  // compiles
        for (let round = 0; round < kRounds; ++round) {
            found.wasm.push(pass(file));
            for (const native of ["baseline", "x86-64-v3"]) {
                found[native].push(Number(execFileSync(path.join(programs, "verify_times"), [file, native], { encoding: "utf8" })));
            }
        }
        const [page, baseline, v3] = Object.values(found).map(median);
        console.log(`${name}: ${page.toFixed(3)} ${baseline.toFixed(3)} ${v3.toFixed(3)} ${(page / baseline).toFixed(2)} ${(page / v3).toFixed(2)}`);
    }
}

/** Runs the first pass with keyframes as the worker does. */
function passWithKeyframes(file, pause, afterKeyframe = () => {}) {
    open(file);
    const keyframes = new Keyframes(256 << 20, pause);
    keyframes.passed(0, 0, state);
    for (let before = performance.now(); wasm._sw_advance() === 1;) {
        const now = performance.now();
        keyframes.passed(wasm._sw_step(), now - before, () => {
            const bytes = state();
            afterKeyframe(keyframes);
            return bytes;
        });
        before = performance.now();
    }
    requireEqual();
    return keyframes;
}
/** Goes to random moments, and prints how long that takes. */
function moments(name, keyframes) {
    const last = JSON.parse(wasm.UTF8ToString(wasm._sw_session())).lastStep, took = [];
    let seed = 12345;
    for (let i = 0; i < kMoments; ++i) {
        seed = (Math.imul(seed, 1103515245) + 12345) >>> 0;
        const step = Math.floor(seed / 2 ** 32 * last), began = performance.now();
        const keyframe = keyframes.before(step);
        loaded.restore(keyframe.length, (into) => copyState(keyframe, into));
        while (wasm._sw_step() < step && wasm._sw_step_on() === 1) {}
        took.push(performance.now() - began);
    }
    requireEqual();
    const at = sorted(took);
    console.log(`${name}: ${keyframes.count} keyframes, ${(keyframes.bytes / 2 ** 20).toFixed(0)} MiB, ${kMoments} moments: p50 ${at[49].toFixed(0)} ms, p99 ${at[98].toFixed(0)} ms`);
}

function hour() {
    const [name] = write("hour"), samples = [];
    // More keyframes than in the page, so that they reach their limit early.
    const keyframes = passWithKeyframes(path.join(folder, name), 8, (kept) => {
        samples.push({ step: wasm._sw_step(), limited: kept.thinned, heap: wasm.HEAPU8.length, process: process.memoryUsage().rss });
    });
    const limit = samples.findIndex((sample) => sample.limited), after = samples.slice(limit);
    console.log(`${name}: ${wasm._sw_step()} steps, ${wasm._sw_matches()} hashes equal; the keyframes reached 256 MiB before step ${after[0]?.step}`);
    for (const what of ["heap", "process"]) {
        const mebibytes = after.map((sample) => sample[what] / 2 ** 20), least = Math.min(...mebibytes), most = Math.max(...mebibytes);
        console.log(`${what}: ${least.toFixed(0)} to ${most.toFixed(0)} MiB from there, ${(100 * (most / least - 1)).toFixed(1)} % more`);
    }
    moments(name, keyframes);
}

console.log(`load ${os.loadavg().map((n) => n.toFixed(2)).join(" ")}, node ${process.version}`);
if (what === "times") {
    times();
} else if (what === "moments") {
    for (const name of write("times")) {
        moments(name, passWithKeyframes(path.join(folder, name), 150));
    }
} else {
    hour();
}
