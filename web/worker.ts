// SPDX-License-Identifier: Apache-2.0
// Computes the sand. It works in slices, so that it answers the page between them.
import { Keyframes } from "./keyframes";
import type { FromWorker, OpenMessage, ToWorker } from "./messages";
import { Replica } from "./replica";

const kSliceMs = 12;
const kProgressMs = 100;

// A module with one vector instruction. A browser without vectors refuses it.
const kVectors = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11]);

let replica: Replica | undefined;
let keyframes = new Keyframes();
let session: { columns: number; rows: number; lastStep: number } | undefined;
let passed = false;           // whether the first pass has ended
let wanted = 0;               // step to show, after the first pass
let rate = 0;                 // steps per second
let playedAt = 0, playedFrom = 0;
let mayShow = true, shownStep = -1;
let lastProgress = -kProgressMs, toldStep = -1;
let working = false;

function tell(message: FromWorker, buffers: Transferable[] = []): void {
    (self as unknown as Worker).postMessage(message, buffers);
}

function tellProgress(now: number): void {
    const it = replica!;
    lastProgress = now;
    toldStep = passed ? it.step : -1;
    tell({ kind: "progress", step: it.step, hash: it.hash, matches: it.matches, mismatches: it.mismatches, passed });
}

/** Sends the present sand, if the page has drawn the frame before. */
function show(): void {
    if (!mayShow || replica!.step === shownStep) {
        return;
    }
    mayShow = false;
    shownStep = replica!.step;
    const sand = replica!.sand(session!.columns, session!.rows);
    const buffers = [sand.heights, sand.places, sand.corners].filter((array) => array !== undefined).map((array) => array!.buffer);
    tell({ kind: "frame", step: shownStep, tool: replica!.tool(), humidity: replica!.humidity, ...sand }, buffers as Transferable[]);
}

/** Works on the first pass for a slice. */
function pass(): void {
    const it = replica!, began = performance.now();
    let before = began;
    while (performance.now() - began < kSliceMs) {
        if (!it.advance()) {
            passed = true;
            wanted = it.step;
            break;
        }
        const now = performance.now();
        keyframes.passed(it.step, now - before, () => it.state());
        before = performance.now();
    }
}

/** Goes towards the wanted step for a slice. Returns whether it is reached. */
function goOn(): boolean {
    const it = replica!;
    const keyframe = keyframes.before(wanted);
    if (it.step > wanted || it.step < keyframe.step) {
        it.restore(keyframe.state);
    }
    const began = performance.now();
    while (it.step < wanted && performance.now() - began < kSliceMs) {
        if (!it.stepOn()) {
            break;
        }
    }
    return it.step >= wanted;
}

function nextWanted(now: number): void {
    const last = session!.lastStep;
    wanted = Math.max(0, Math.min(last, Math.round(playedFrom + (now - playedAt) * rate / 1000)));
    if (wanted === (rate > 0 ? last : 0)) {
        rate = 0;
    }
}

function work(): void {
    working = false;
    if (!replica || !session) {
        return;
    }
    try {
        let rests = false;
        if (!passed) {
            pass();
            show();
        } else {
            rests = goOn();
            if (rests) {
                show();
            }
            if (rests && rate !== 0) {
                nextWanted(performance.now());
                rests = false;
            }
        }
        const now = performance.now();
        if (toldStep !== replica.step && ((passed && rests) || now - lastProgress >= kProgressMs)) {
            tellProgress(now);
        }
        if (!rests) {
            again(rate !== 0 ? 4 : 0);
        }
    } catch (error) {
        fail(error as Error);
    }
}

/** Ends the session. */
function fail(error: Error): void {
    rate = 0;
    session = undefined;
    tell({ kind: "problem", text: error.message });
}

function again(ms = 0): void {
    if (!working) {
        working = true;
        setTimeout(work, ms);
    }
}

async function open({ name, address, parts }: OpenMessage): Promise<void> {
    try {
        if (!WebAssembly.validate(kVectors)) {
            throw new Error("This browser has no vectors in WebAssembly; use a browser of 2023 or later");
        }
        replica ??= await Replica.load();
        replica.open(name, parts);
    } catch (error) {
        tell({ kind: "problem", text: (error as Error).message });
        return;
    }
    const opened = replica.session();
    session = opened;
    keyframes = new Keyframes();
    keyframes.passed(0, 0, () => replica!.state());
    passed = false;
    rate = 0;
    shownStep = toldStep = -1;
    mayShow = true;
    const sand = replica.sand(opened.columns, opened.rows);
    tell({ kind: "session", address, tin: sand.heights === undefined, holes: replica.holes(opened.columns, opened.rows), ...opened });
    show();
    again();
}

self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
    if ("open" in data) {
        open(data.open).catch(fail);
        return;
    }
    if ("shown" in data) {
        mayShow = true;
    } else if ("seek" in data) {
        rate = 0;
        wanted = data.seek;
    } else if ("play" in data) {
        rate = data.play;
        playedAt = performance.now();
        playedFrom = replica?.step ?? 0;
        if (rate > 0 && playedFrom === session?.lastStep) {
            playedFrom = 0;
        }
    }
    again();
};
