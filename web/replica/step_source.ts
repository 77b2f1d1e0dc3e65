// SPDX-License-Identifier: Apache-2.0
// A source of the steps of the sand: a journal (journal_source.ts) or a hand (hand_source.ts).
import type { FromWorker, ToWorker } from "./messages";

/** What the worker does for a source. */
export interface Stage {
    tell(message: FromWorker, buffers?: Transferable[]): void;
    /** Sends the present sand, unless the page still draws the frame before. Returns whether it was sent. */
    show(): boolean;
}

export interface StepSource {
    /** Carries out a message of the page, if it is for this source. */
    take(message: ToWorker): void;
    /** Works for a slice. Returns after how many milliseconds it goes on, or undefined if it waits for a message. */
    work(): number | undefined;
}

export const kSliceMs = 12;
