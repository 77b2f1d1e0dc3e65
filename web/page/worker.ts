// SPDX-License-Identifier: Apache-2.0
// Computes the sand. It works in slices, so that it answers the page between them.
import type { FromWorker, ToWorker } from "../replica/messages";
import { Replica } from "../replica/replica";
import type { StepSource } from "../replica/step_source";
import { Beginnings } from "./beginnings";

// A module with one vector instruction. A browser without vectors refuses it.
const kVectors = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11]);

let replica: Replica | undefined;
let source: StepSource | undefined;
let mayShow = true, shownStep = -1;
let working = false;
let failed = false;           // a step has failed, so that no other follows

function tell(message: FromWorker, buffers: Transferable[] = []): void {
    (self as unknown as Worker).postMessage(message, buffers);
}

/** Sends the present sand, if the page has drawn the frame before. */
function show(): boolean {
    if (!mayShow || replica!.step === shownStep) {
        return false;
    }
    mayShow = false;
    shownStep = replica!.step;
    const pieces = replica!.draw(), heights = pieces.find((piece) => piece.heights)?.heights as Int32Array | undefined;
    tell({ kind: "frame", step: shownStep, pieces, heights }, pieces.flatMap((piece) => Object.values(piece).map((array) => array.buffer as ArrayBuffer)));
    return true;
}

function work(): void {
    working = false;
    if (failed) {
        return;
    }
    try {
        const pause = source?.work();
        if (pause !== undefined) {
            again(pause);
        }
    } catch (error) {
        fail(error as Error);
    }
}

/** Ends the work on the session. What was dug can still be saved. */
function fail(error: Error): void {
    failed = true;
    tell({ kind: "problem", text: error.message });
}

function again(ms = 0): void {
    if (!working) {
        working = true;
        setTimeout(work, ms);
    }
}

async function loaded(): Promise<Replica> {
    if (!WebAssembly.validate(kVectors)) {
        throw new Error("This browser has no vectors in WebAssembly; use a browser of 2023 or later");
    }
    return replica ??= await Replica.load();
}

/** Shows other sand, whose steps come from `next`. Nothing works until then. */
function begin(next?: StepSource): void {
    source = next;
    shownStep = -1;
    mayShow = true;
    failed = false;
}
const beginnings = new Beginnings({ tell, show, begin, loaded });
let queue = Promise.resolve();

/** Begins anew, after what has begun before. If that is refused, the session before goes on. */
function start(beginning: () => Promise<void>): void {
    queue = queue.then(beginning).catch((error: Error) => tell({ kind: "problem", text: error.message })).then(() => {
        if (source) {
            show();
            again();
        }
    });
}

self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
    const beginning = beginnings.take(data);
    if (beginning) {
        return start(beginning);
    }
    if ("forget" in data) {
        return void beginnings.forget(data.forget).catch((error: Error) => tell({ kind: "note", text: `The kept sand cannot be removed: ${error.message || error.name}.` }));
    }
    if ("look" in data) {
        const place = source && replica!.look(data.look);
        return tell({ kind: "place", place, near: data.near });
    }
    if ("shown" in data) {
        mayShow = true;
    } else {
        source?.take(data);
    }
    again();
};
