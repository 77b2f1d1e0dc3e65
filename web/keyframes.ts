// SPDX-License-Identifier: Apache-2.0
// Whole states of a session, outside the heap of WebAssembly, which never shrinks.

export interface Keyframe {
    step: number;
    state: ArrayBuffer;
}

/** Keeps a state whenever `ms` of computing have passed. Beyond `most` bytes, it drops every second one. */
export class Keyframes {
    private kept: Keyframe[] = [];
    private sum = 0;
    private spent = 0;
    private pause: number;

    constructor(private readonly most = 256 << 20, ms = 150) { this.pause = ms; }

    /** Notes that `ms` were spent up to `step`. `encode` makes the state of this step. */
    passed(step: number, ms: number, encode: () => ArrayBuffer): void {
        this.spent += ms;
        if (this.kept.length > 0 && this.spent < this.pause) {
            return;
        }
        this.spent = 0;
        const state = encode();
        this.kept.push({ step, state });
        this.sum += state.byteLength;
        while (this.sum > this.most && this.kept.length > 2) {
            this.kept = this.kept.filter((_, i) => i % 2 === 0);
            this.sum = this.kept.reduce((sum, keyframe) => sum + keyframe.state.byteLength, 0);
            this.pause *= 2;
        }
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
}
