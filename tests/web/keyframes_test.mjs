// SPDX-License-Identifier: Apache-2.0
// Tests that keyframes return the states that they were given, and that they stay within their memory.
import assert from "node:assert/strict";
import { builtModule } from "./built_module.mjs";

const { copyState, Keyframes } = await builtModule("replica/keyframes.ts");
const kMost = 8 << 20, kSteps = 400;

/** Returns the state of a step: its length and its bytes depend on the step alone. */
const stateOf = (step, seed) => new Uint8Array(20_000 + (step * 7919) % 150_000).map((_, i) => (seed + step * 31 + i * 17 + (i >> 16)) & 255);
function given({ length, blocks }) {
    const state = new Uint8Array(length);
    copyState({ length, blocks }, state);
    return state;
}

const keyframes = new Keyframes(kMost, 10);
const blocks = new Set();
for (const seed of [1, 2]) {
    keyframes.clear();
    assert.deepEqual([keyframes.count, keyframes.bytes, keyframes.thinned], [0, 0, false]);
    let encoded = 0;
    for (let step = 0; step < kSteps; ++step) {
        keyframes.passed(step, 5, () => {
            ++encoded;
            return stateOf(step, seed);
        });
        assert.ok(keyframes.bytes <= kMost, `${keyframes.bytes} bytes at step ${step}`);
        const { step: kept, ...state } = keyframes.before(step);
        assert.ok(kept <= step);
        assert.deepEqual(given(state), stateOf(kept, seed), `state of step ${kept}`);
    }
    assert.ok(keyframes.thinned && keyframes.bytes > kMost / 4 && encoded < kSteps / 2);
    let before = -1;
    for (let step = 0; step < kSteps; ++step) {
        const keyframe = keyframes.before(step);
        assert.ok(keyframe.step <= step && keyframe.step >= before);
        keyframe.blocks.forEach((block) => blocks.add(block));
        before = keyframe.step;
    }
    assert.equal(keyframes.before(0).step, 0, "the start stays");
    assert.ok(before > kSteps * 0.8, "and the end has a state, too");
}
// The second session has the memory of the first.
assert.ok(blocks.size * (1 << 16) <= kMost, `${blocks.size} blocks`);

// One step may have more than all memory.
const small = new Keyframes(1 << 16, 0);
for (let step = 0; step < 5; ++step) {
    small.passed(step, 1, () => stateOf(step, 3));
    assert.deepEqual(given(small.before(step)), stateOf(step, 3));
}
console.log("keyframes return their states, within their memory");
