// SPDX-License-Identifier: Apache-2.0
// The page's replica in node, for tests and measurements.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

/** Loads replica.mjs and replica.wasm of a folder, such as build/web/bin. */
export async function loadReplica(folder) {
    const make = (await import(pathToFileURL(path.resolve(folder, "replica.mjs")))).default;
    return new LoadedReplica(await make({ wasmBinary: fs.readFileSync(path.join(folder, "replica.wasm")) }));
}

class LoadedReplica {
    /** `wasm` has the C functions of web/replica.cpp and web/dig.cpp. */
    constructor(wasm) { this.wasm = wasm; }

    text(address) { return this.wasm.UTF8ToString(address); }
    get hash() { return this.text(this.wasm._sw_hash()); }
    /** The described values whose JSON these functions return. */
    get session() { return JSON.parse(this.text(this.wasm._sw_session())); }
    get words() { return JSON.parse(this.text(this.wasm._sw_words())); }
    get material() { return JSON.parse(this.text(this.wasm._sw_material())); }
    get problem() { return this.text(this.wasm._sw_problem()); }
    /** Fails with the replica's sentence if the result of a function says so. Returns the result. */
    good(result) {
        assert.ok(result >= 0, this.problem);
        return result;
    }

    /** Calls a function with the address of a text. */
    withText(text, call) {
        const bytes = new TextEncoder().encode(text + "\0");
        const at = this.wasm._malloc(bytes.length);
        this.wasm.HEAPU8.set(bytes, at);
        const result = call(at);
        this.wasm._free(at);
        return result;
    }
    /** Passes the bytes of a file, or of a journal's parts, to the function that is called next. */
    add(parts) {
        this.wasm._sw_begin();
        for (const part of parts) {
            const at = this.wasm._sw_add_part(part.length);
            assert.ok(at > 0, this.problem);
            this.wasm.HEAPU8.set(part, at);
        }
    }
    /** Opens a journal. Returns "" or the sentence of the refusal. */
    open(name, parts) {
        this.add(parts);
        return this.withText(name, (at) => this.wasm._sw_open(at)) === 0 ? "" : this.problem;
    }

    /** Encodes the whole state. The bytes are a view of the replica's memory, which the next call may change. */
    state() {
        const length = this.good(this.wasm._sw_state()), at = this.wasm._sw_state_bytes();
        return this.wasm.HEAPU8.subarray(at, at + length);
    }
    /** Restores a state of `length` bytes, which `write` writes. */
    restore(length, write) {
        const at = this.wasm._sw_room_for_state(length);
        assert.ok(at > 0, this.problem);
        write(this.wasm.HEAPU8.subarray(at, at + length));
        this.good(this.wasm._sw_restore());
    }

    /** Returns the pieces of a drawing, as Replica.draw() of web/replica/replica.ts does. */
    draw() {
        const w = this.wasm, pieces = [], arrays = [Float32Array, Int32Array, Uint32Array, Int16Array, Uint16Array, Uint8Array];
        this.good(w._sw_draw());
        while (this.good(w._sw_next_piece()) === 1) {
            pieces.push(Object.fromEntries(Array.from({ length: w._sw_arrays() }, (_, i) => [this.text(w._sw_array_name(i)),
                new arrays[w._sw_array_type(i)](w.HEAPU8.buffer, w._sw_array(i), w._sw_array_length(i)).slice()])));
        }
        return pieces;
    }
}
