// SPDX-License-Identifier: Apache-2.0
// What sessions begin with: a number, a sample scene, or the sand of a kept journal.
import type { KeptSession } from "../kept/kept_sand";
import type { Replica } from "../replica/replica";
import { kSliceMs } from "../replica/step_source";
import { fetchSandwallFile } from "./fetched";

const kReturnMs = 500;  // between two notes about sand that is computed again

/** Returns a session that has not begun. */
export function newSession(name: string): KeptSession {
    const id = [...crypto.getRandomValues(new Uint8Array(16))].map((byte) => byte.toString(16).padStart(2, "0")).join("");
    return { id, name, began: Date.now(), changed: Date.now(), seconds: 0 };
}
/** Fetches a sample scene. Throws with a sentence. */
export async function sceneNamed(name: string): Promise<ArrayBuffer> {
    const fetched = await fetchSandwallFile(new URL(`${encodeURIComponent(name)}.scene`, self.location.href)).catch(({ message }: Error) => ({ why: message }));
    if ("why" in fetched) {
        throw new Error(`${name}: cannot be fetched (${fetched.why}); build the page again`);
    }
    return fetched.bytes;
}

/** Computes the sand of a kept journal in slices. `note` gets how far it is. `check` is called between slices, and may throw. */
export async function computeKept(it: Replica, { name, seconds }: KeptSession, stepsPerSecond: number, note: (text: string) => void, check: () => void): Promise<void> {
    for (let told = performance.now(); ; ) {
        const began = performance.now();
        while (performance.now() - began < kSliceMs) {
            if (!it.returnOn()) {
                return;
            }
        }
        if (began - told > kReturnMs) {
            told = began;
            note(`Computing your sand of ${name} again: ${Math.floor(it.step / stepsPerSecond)} of ${seconds} s.`);
        }
        await new Promise((resolve) => setTimeout(resolve));
        check();
    }
}
