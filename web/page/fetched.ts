// SPDX-License-Identifier: Apache-2.0
// Fetches files of the page's own server: parts of a journal, and scenes, which have the header of a journal.

const kJournal = [0x53, 0x57, 0x4a, 0x4c];  // "SWJL", as in journal/format.cpp

/** The bytes of a file, or why there are none. */
export type Fetched = { bytes: ArrayBuffer } | { why: string };

/** Returns what a server has sent that is no file of Sandwall. */
function described(bytes: ArrayBuffer): string {
    const text = new TextDecoder().decode(bytes.slice(0, 256)).trim();
    if (text === "") {
        return "an empty file";
    }
    return /^<(!doctype\s+html|html|head|\?xml|!--)/i.test(text) ? "a web page in its place" : "a file of another kind";
}

/**
 * Fetches a part of a journal, or a scene. The first bytes decide, because some servers answer every unknown path with
 * their index.html and the status of a file that exists. Throws what fetch() throws, such as without a network.
 */
export async function fetchSandwallFile(url: URL | string): Promise<Fetched> {
    const answer = await fetch(url);
    if (!answer.ok) {
        return { why: "the server does not have it" };
    }
    const bytes = await answer.arrayBuffer(), first = new Uint8Array(bytes, 0, Math.min(kJournal.length, bytes.byteLength));
    const isOurs = kJournal.every((byte, i) => first[i] === byte);
    return isOurs ? { bytes } : { why: `the server sends ${described(bytes)}` };
}
