// SPDX-License-Identifier: Apache-2.0
// Whole states of a session, outside the heap of WebAssembly, which never shrinks.

export interface Keyframe {
    step: number;
    length: number;         // of the state [byte]
    blocks: Uint8Array[];   // its bytes; the last block is not full
}

const kBlock = 1 << 16;     // [byte]

/**
 * Keeps a state whenever `ms` of computing have passed. When `most` bytes are full, it drops every second one.
 * The states are in blocks that are used again. A browser frees the memory of buffers late, so with a new buffer for
 * each state the process would need half as much again.
 */
export class Keyframes {
    private kept: Keyframe[] = [];
    private free: Uint8Array[] = [];
    private blocks = 0;     // that exist
    private spent = 0;
    private pause: number;

    constructor(private readonly most = 256 << 20, private readonly ms = 150) { this.pause = ms; }

    /** Drops all states, and keeps their memory for those of another session. */
    clear(): void {
        for (const { blocks } of this.kept) {
            this.free.push(...blocks);
        }
        this.kept = [];
        this.spent = 0;
        this.pause = this.ms;
    }

    /** Notes that `ms` were spent up to `step`. `encode` makes the state of this step, which is copied. */
    passed(step: number, ms: number, encode: () => Uint8Array): void {
        this.spent += ms;
        if (this.kept.length > 0 && this.spent < this.pause) {
            return;
        }
        this.spent = 0;
        const state = encode(), needed = Math.ceil(state.length / kBlock);
        while (this.room < needed && this.kept.length > 2) {
            this.dropEverySecond();
        }
        const blocks = Array.from({ length: needed }, () => this.block());
        blocks.forEach((block, i) => block.set(state.subarray(i * kBlock, (i + 1) * kBlock)));
        this.kept.push({ step, length: state.length, blocks });
    }
    /** Returns the last keyframe at or before a step. */
    before(step: number): Keyframe {
        let low = 0;
        for (let high = this.kept.length; high - low > 1;) {
            const middle = (low + high) >> 1;
            this.kept[middle].step <= step ? (low = middle) : (high = middle);
        }
        return this.kept[low];
    }
    get count(): number { return this.kept.length; }
    /** Memory of all states [byte]. */
    get bytes(): number { return (this.blocks - this.free.length) * kBlock; }
    /** Whether states were dropped. */
    get thinned(): boolean { return this.pause > this.ms; }

    /** Blocks that a state can have now. */
    private get room(): number { return Math.floor(this.most / kBlock) - this.blocks + this.free.length; }
    private block(): Uint8Array {
        const used = this.free.pop();
        this.blocks += used ? 0 : 1;
        return used ?? new Uint8Array(kBlock);
    }
    private dropEverySecond(): void {
        for (const { blocks } of this.kept.filter((_, i) => i % 2 === 1)) {
            this.free.push(...blocks);
        }
        this.kept = this.kept.filter((_, i) => i % 2 === 0);
        this.pause *= 2;
    }
}

/** Writes the state of a keyframe to `into`, which has its length. */
export function copyState({ length, blocks }: Keyframe, into: Uint8Array): void {
    blocks.forEach((block, i) => into.set(block.subarray(0, length - i * kBlock), i * kBlock));
}
