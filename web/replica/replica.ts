// SPDX-License-Identifier: Apache-2.0
// The replica's C functions (replica.cpp) as a class.

import type { KeptState } from "../kept/kept_sand";
import { kReadingNumbers, type Piece, type Words } from "./messages";

type Module = Record<string, any>;

const kArrays = [Float32Array, Int32Array, Uint32Array, Int16Array, Uint16Array, Uint8Array];  // in the order of web::Piece::Numbers
const kMostBytes = 2 ** 32 - 1;  // that a size of 32 bits can name; more than a page has

export class Replica {
    private constructor(private readonly wasm: Module) {}

    static async load(): Promise<Replica> {
        // The glue is not bundled, because it finds replica.wasm beside itself.
        const address = new URL("./replica.mjs", self.location.href).href;
        try {
            const made = await import(/* @vite-ignore */ address);
            return new Replica(await made.default());
        } catch (error) {
            throw new Error(`replica.mjs and replica.wasm cannot be loaded (${(error as Error).message}); put all files of the page on the server`);
        }
    }

    private text(address: number): string { return this.wasm.UTF8ToString(address); }
    private require(result: number): number {
        if (result < 0) {
            throw new Error(this.text(this.wasm._sw_problem()));
        }
        return result;
    }
    /** Returns an address, unless there is no memory. */
    private room(address: number): number { return this.require(address > 0 ? address : -1); }
    /** Returns the described value whose JSON is at an address. */
    private json(address: number) { return JSON.parse(this.text(address)); }

    private withText(text: string, call: (address: number) => number): number {
        const bytes = new TextEncoder().encode(text + "\0");
        const at = this.wasm._malloc(bytes.length);
        this.wasm.HEAPU8.set(bytes, at);
        try {
            return this.require(call(at));
        } finally {
            this.wasm._free(at);
        }
    }
    private add(parts: ArrayBuffer[]): void {
        this.wasm._sw_begin();
        for (const part of parts) {
            const at = this.room(this.wasm._sw_add_part(Math.min(part.byteLength, kMostBytes)));
            this.wasm.HEAPU8.set(new Uint8Array(part), at);
        }
    }

    /** Opens a journal. If it cannot be read, throws the sentence for the user, and the session before stays open. */
    open(name: string, parts: ArrayBuffer[]): void {
        this.add(parts);
        this.withText(name, (at) => this.wasm._sw_open(at));
    }
    /** Returns what a page must know of the sand that is shown. */
    session() { return this.json(this.wasm._sw_session()); }
    advance(): boolean { return this.require(this.wasm._sw_advance()) === 1; }
    stepOn(): boolean { return this.require(this.wasm._sw_step_on()) === 1; }
    get step(): number { return this.wasm._sw_step(); }
    /** Returns the place that a sight meets, or undefined: x and y [cell], height [scene unit], height [cell]. */
    look(sight: number[]): number[] | undefined {
        if (this.require(this.wasm._sw_look(...sight)) === 0) {
            return undefined;
        }
        return [...new Float64Array(this.wasm.HEAPU8.buffer, this.wasm._sw_place(), 4)];
    }
    get hash(): string { return this.text(this.wasm._sw_hash()); }
    get matches(): number { return this.wasm._sw_matches(); }
    get mismatches(): number { return this.wasm._sw_mismatches(); }

    /** Returns the whole state in the memory of WebAssembly, where the next call may change it. */
    state(): Uint8Array {
        const length = this.require(this.wasm._sw_state());
        const at = this.wasm._sw_state_bytes();
        return this.wasm.HEAPU8.subarray(at, at + length);
    }
    /** Restores a state of `length` bytes, which `write` writes. */
    restore(length: number, write: (into: Uint8Array) => void): void {
        const at = this.room(this.wasm._sw_room_for_state(length));
        write(this.wasm.HEAPU8.subarray(at, at + length));
        this.require(this.wasm._sw_restore());
    }
    /** Returns what differs from the drawing before. */
    draw(): Piece[] {
        const w = this.wasm, pieces: Piece[] = [];
        this.require(w._sw_draw());
        while (this.require(w._sw_next_piece()) === 1) {
            const piece: Piece = {};
            for (let i = 0; i < w._sw_arrays(); ++i) {
                piece[this.text(w._sw_array_name(i))] = new kArrays[w._sw_array_type(i)](w.HEAPU8.buffer, w._sw_array(i), w._sw_array_length(i)).slice();
            }
            pieces.push(piece);
        }
        return pieces;
    }

    // Digging

    /** Begins to dig in an encoded scene or in the text of a grid. Refuses as open() does. */
    dig(name: string, bytes: ArrayBuffer, isScene: boolean): void {
        const [high, low] = crypto.getRandomValues(new Uint32Array(2));
        this.add([bytes]);
        this.withText(name, (at) => isScene ? this.wasm._sw_dig_scene(at, high, low) : this.wasm._sw_dig_grid(at, high, low));
    }
    /** Begins anew on the sand with which the session that is dug now began. */
    digAgain(): void {
        const [high, low] = crypto.getRandomValues(new Uint32Array(2));
        this.require(this.wasm._sw_dig_again(high, low));
    }
    /** Begins to go on with a kept journal, from a kept state if there is one. returnOn() computes its steps. */
    return(name: string, bytes: ArrayBuffer, state?: KeptState): void {
        this.add([bytes]);
        this.withText(name, (at) => this.wasm._sw_return(at));
        if (state) {
            const at = this.room(this.wasm._sw_room_for_state(state.bytes.byteLength));
            this.wasm.HEAPU8.set(new Uint8Array(state.bytes), at);
            this.require(this.wasm._sw_return_from(state.step, parseInt(state.hash.slice(0, 8), 16), parseInt(state.hash.slice(8), 16)));
        }
    }
    /** Takes the next record. Returns false behind the last one, and throws if no hand can go on. */
    returnOn(): boolean { return this.require(this.wasm._sw_return_on()) === 1; }
    /** Checks the header of a grid, of which all has `size` bytes. */
    checkGrid(name: string, first: ArrayBuffer, size: number): void {
        this.add([first]);
        this.withText(name, (at) => this.wasm._sw_check_grid(at, size));
    }
    point(readings: Float64Array): void {
        for (let i = 0; i + kReadingNumbers <= readings.length; i += kReadingNumbers) {
            this.require(this.wasm._sw_point(...readings.subarray(i, i + kReadingNumbers)));
        }
    }
    digOn(): boolean { return this.require(this.wasm._sw_dig_on()) === 1; }
    get settlesNext(): boolean { return this.wasm._sw_settles_next() === 1; }
    get words(): Words { return this.json(this.wasm._sw_words()); }
    /** The material with all changes that were asked for, as JSON. */
    get materialText(): string { return this.text(this.wasm._sw_material()); }
    get sceneMaterial() { return this.json(this.wasm._sw_scene_material()); }
    get canUndo(): boolean { return this.wasm._sw_can_undo() === 1; }
    get canRedo(): boolean { return this.wasm._sw_can_redo() === 1; }
    ask(edit: string): void { this.withText(edit, (at) => this.wasm._sw_ask(at)); }
    setDepth(depth: number): void { this.require(this.wasm._sw_set_depth(depth)); }
    setMaterial(word: string, value: number): void { this.withText(word, (at) => this.wasm._sw_set_material(at, value)); }
    setTool(part: string, value: string): void {
        this.withText(value, (to) => this.withText(part, (at) => this.wasm._sw_set_tool(at, to)));
    }
    /** Changes size, heading or humidity as keys of a window do. */
    changeByNotches(of: string, notches: number): void { this.withText(of, (at) => this.wasm._sw_change_by_notches(at, notches)); }
    /** Gives a tool that is too small to be seen the usual size. */
    enlargeTool(): void { this.require(this.wasm._sw_enlarge_tool()); }
    /** How many steps the hand or an edit has changed. */
    get touched(): number { return this.wasm._sw_touched(); }
    /** Whether the scene's sand has been changed. */
    get dug(): boolean { return this.wasm._sw_dug() === 1; }
    /** Whether the next step changes nothing. */
    get rests(): boolean { return this.wasm._sw_rests() === 1; }
    /** The length of the journal so far, without an end. */
    get written(): number { return this.wasm._sw_written(); }
    journalFrom(offset: number): ArrayBuffer {
        const at = this.wasm._sw_written_bytes();
        return this.wasm.HEAPU8.slice(at + offset, at + this.written).buffer;
    }
    /** Returns whether the journal begins with these bytes. */
    beginsWith(bytes: ArrayBuffer): boolean {
        const at = this.wasm._sw_written_bytes(), ours = this.wasm.HEAPU8.subarray(at, at + this.written) as Uint8Array, others = new Uint8Array(bytes);
        return others.length <= ours.length && others.every((byte, i) => byte === ours[i]);
    }
    journal(): ArrayBuffer {
        const length = this.require(this.wasm._sw_journal());
        const at = this.wasm._sw_state_bytes();
        return this.wasm.HEAPU8.slice(at, at + length).buffer;
    }
}
