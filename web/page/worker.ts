// SPDX-License-Identifier: Apache-2.0
// Computes the sand. It works in slices, so that it answers the page between them.
import { HandSource } from "../hand/hand_source";
import { JournalSource } from "../replica/journal_source";
import { Keyframes } from "../replica/keyframes";
import type { DigMessage, FromWorker, OpenMessage, ToWorker } from "../replica/messages";
import { Replica } from "../replica/replica";
import type { StepSource } from "../replica/step_source";

// A module with one vector instruction. A browser without vectors refuses it.
const kVectors = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11]);

let replica: Replica | undefined;
let source: StepSource | undefined;
let keyframes = new Keyframes();
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

/** Begins with the sand that the replica has now. */
function begin(next: StepSource): void {
    source = next;
    shownStep = -1;
    mayShow = true;
    failed = false;
}

async function open({ name, address, parts }: OpenMessage): Promise<void> {
    const it = await loaded();
    it.open(name, parts);
    const opened = it.session();
    begin(new JournalSource(it, opened, keyframes, { tell, show }));
    tell({ kind: "session", address, ...opened });
}

async function dig(message: DigMessage): Promise<void> {
    const it = await loaded();
    const text = message.file;
    if (text) {
        // The header says whether the sand fits, before all of a large file is read.
        it.checkGrid(message.name, await text.slice(0, 1 << 16).arrayBuffer(), text.size);
    }
    it.dig(message.name, message.scene ?? await text!.arrayBuffer(), text === undefined);
    keyframes = new Keyframes();  // digging needs no memory for states
    const begun = it.session();
    tell({ kind: "dig", ...begun, words: it.words });
    begin(new HandSource(it, begun.stepsPerSecond, { tell, show }));
}

/** Begins anew. If that is refused, the session before goes on. */
function start(beginning: Promise<void>): void {
    beginning.then(() => {
        show();
        again();
    }, (error: Error) => tell({ kind: "problem", text: error.message }));
}

self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
    if ("open" in data) {
        return start(open(data.open));
    }
    if ("dig" in data) {
        return start(dig(data.dig));
    }
    if ("shown" in data) {
        mayShow = true;
    } else {
        source?.take(data);
    }
    again();
};
