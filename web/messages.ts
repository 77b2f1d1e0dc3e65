// SPDX-License-Identifier: Apache-2.0
// What page and worker tell each other. All buffers are transferred.

export const kUnitsPerCell = 65536;  // units of height

export interface OpenMessage {
    name: string;
    address: string;           // of a journal that was fetched; empty for files
    parts: ArrayBuffer[];
}

export type ToWorker =
    | { open: OpenMessage }
    | { seek: number }
    | { play: number }     // steps per second; negative: backwards; 0: stop
    | { shown: true };     // the page has drawn a frame, and may get the next

export interface SessionMessage {
    kind: "session";
    address: string;           // of the OpenMessage
    name: string;
    shortcoming: string;
    tin: boolean;
    columns: number;
    rows: number;
    cell: number;              // scene unit
    stepsPerSecond: number;
    lastStep: number;
    hashes: number;
    marks: Int32Array;         // pairs of a step and its kind: 0 is a stroke, 1 to 5 are edits, 6 is a resume
    look: Float32Array;        // RGB of sand and background, direction to the sun, 1 if the field has boards, height in the middle [cell]
    holes?: Uint8Array;        // of a grid: 1 for a cell without ground; undefined if all cells have ground
}

export interface FrameMessage {
    kind: "frame";
    step: number;
    tool: Float32Array;        // x, y, z, radius [cell], engaged, kind, half width [cell], heading, mirrored
    humidity: number;          // of the sand, 0 to 1
    heights?: Int32Array;      // of a grid [unit]
    places?: Float32Array;     // of a TIN [cell]
    corners?: Uint32Array;
}

/** `step` and `hash` are of the newest step that was computed. */
export interface ProgressMessage {
    kind: "progress";
    step: number;
    hash: string;
    matches: number;
    mismatches: number;
    passed: boolean;           // whether the first pass has ended
}

export interface ProblemMessage {
    kind: "problem";
    text: string;
}

export type FromWorker = SessionMessage | FrameMessage | ProgressMessage | ProblemMessage;
