// SPDX-License-Identifier: Apache-2.0
// What page and worker tell each other. All buffers are transferred.

import type { Keeping } from "../kept/keeper";
import type { KeptSession } from "../kept/kept_sand";

export const kUnitsPerCell = 65536;  // units of height

export interface OpenMessage {
    name: string;
    address: string;           // of a journal that was fetched; empty for files
    parts: ArrayBuffer[];
}

/** New sand to dig in: a scene that was encoded natively, or a file with an ESRI ASCII grid. */
export interface DigMessage {
    name: string;
    file?: Blob;
}

/** Sand with which the page begins: the newest that is kept, or new sand of `scene`. */
export interface StartMessage {
    scene: string;
    only: boolean;             // goes on only with sand of `scene`
    mine: string;              // session that this tab had before; empty if none
}

/** What a hand can choose (web/words.cpp). */
export interface Words {
    tools: string[];
    material: { word: string; lowest: number; highest: number }[];
    edits: string[];
    depth: { lowest: number; highest: number; usual: number; notch: number };  // of the tool, in radii
}

/** The parts of a tool by their names. It has no others. */
export interface Tool {
    kind: string;
    radius: number;            // scene unit
    width?: number;            // over the length
    heading?: number;          // degrees
    foot?: string;
}

/** For each reading of the pointer: time in ms, eye, direction of the sight in cells, and 1 if it is pressed. */
export const kReadingNumbers = 8;

/** What keys and the wheel change by notches (web/hand/notches.hpp). */
export type Notched = "size" | "heading" | "humidity";

export type ToHand =
    | { hand: Float64Array }
    | { edit: string }
    | { tool: string; value: string }       // a part of the tool
    | { material: string; value: number }   // an operator's word, such as "talus"
    | { of: Notched; notches: number }      // of a key or the wheel
    | { enlarge: true }                     // a tool that is too small to be seen gets the usual size
    | { depth: number }                     // of the tool, in radii
    | { save: true }
    | { pause: boolean }
    | { keep: true };                       // at once, because the page may be closed

export type ToWorker =
    | ToHand
    | { open: OpenMessage }
    | { dig: DigMessage }
    | { start: StartMessage }
    | { again: true }      // new sand of the scene that is dug
    | { goOn: string }     // session that is kept
    | { forget: string }   // session that is kept
    | { seek: number }
    | { look: number[]; near: boolean }   // eye and direction of the sight [cell]
    | { play: number }     // steps per second; negative: backwards; 0: stop
    | { shown: true };     // the page has drawn a frame, and may get the next

/** What is drawn of any sand. */
export interface SandMessage {
    name: string;
    shortcoming: string;
    hasHeights: boolean;       // for each cell, which a TIN has not
    columns: number;
    rows: number;
    cell: number;              // scene unit
    stepsPerSecond: number;
    middle: number;            // height in the middle of the room [cell]
}

export interface SessionMessage extends SandMessage {
    kind: "session";
    address: string;           // of the OpenMessage
    lastStep: number;
    hashes: number;
    marks: { step: number; what: string }[];  // strokes, resumes, and edits by their names
}

/** The page can dig now, or when the kept sand has been computed. */
export interface DigBegunMessage extends SandMessage {
    kind: "dig";
    words: Words;
    sceneMaterial: Material;
    since?: number;            // when the kept sand was dug last [ms since 1970]; absent if it is new
    note: string;              // why it is not the sand that was asked for; empty if it is
}

/** The sand under the pointer: x, y [cell], height [scene unit], height [cell]. Absent beside the sand. */
export interface PlaceMessage {
    kind: "place";
    place?: number[];
    near: boolean;             // of the question
}

/** The hand can dig. If the sand was kept, it is that of this step. */
export interface HandMessage {
    kind: "hand";
    step: number;
    hash: string;
}

/** How well the sand is kept that is dug. */
export interface KeepingMessage extends Keeping {
    kind: "keeping";
}

/** The sessions that this browser keeps, the newest first, and the one that is dug. */
export interface SessionsMessage {
    kind: "sessions";
    sessions: KeptSession[];
    current: string;
}

/** A material in the units of a scene file. */
export interface Material {
    material: Record<string, number>;  // by an operator's word
    tool: Tool;
}
/** The material that was asked for. */
export interface MaterialMessage extends Material {
    kind: "material";
}

/** How far the hand's steps are. `busy` says what keeps the worker from answering; empty if nothing does. */
export interface DugMessage {
    kind: "dug";
    step: number;
    hash: string;
    undo: boolean;             // whether a stroke or an edit can be undone
    redo: boolean;             // whether an undo can be redone
    busy: string;
}

export interface JournalMessage {
    kind: "journal";
    name: string;
    bytes: ArrayBuffer;
}

/** A sentence about something that was refused. The session goes on. */
export interface NoteMessage {
    kind: "note";
    text: string;
}

export type Numbers = Float32Array | Int32Array | Uint32Array | Int16Array | Uint16Array | Uint8Array;

/**
 * Arrays of a drawing by name (web/drawing/drawing.cpp): what differs from the frame before.
 *
 * `uNAME`: a uniform of the wall's shaders. `vertices`: the number of all vertices of new sand. `first`: the number of the
 * first vertex in `aHeight`, `aGrid`, `aNormal` and `aShade`. `triangles`: numbers of vertices, of new sand. `sides`,
 * `boards`, `tool`: eight numbers for each vertex of a solid body. `grain`: texels of all levels, and `grainPeriod`: their
 * side [m]. `ball`: 1 if the tool is a ball. `background`: its colour. `heights`: of a grid [unit].
 */
export type Piece = Record<string, Numbers>;

export interface FrameMessage {
    kind: "frame";
    step: number;
    pieces: Piece[];
    heights?: Int32Array;      // of a grid [unit]
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

export type FromHand = DigBegunMessage | MaterialMessage | DugMessage | JournalMessage | NoteMessage | HandMessage | KeepingMessage | SessionsMessage;
export type FromWorker = SessionMessage | FrameMessage | PlaceMessage | ProgressMessage | ProblemMessage | FromHand;
