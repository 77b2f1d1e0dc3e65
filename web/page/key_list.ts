// SPDX-License-Identifier: Apache-2.0
// The keys of the page, with the names and effects of docs/pointer.md, and the help that shows them.

export type KeyAction = "tool" | "larger" | "smaller" | "turnLeft" | "turnRight" | "sceneTool" | "wetter" | "drier" | "undo" | "redo" | "newSand" | "frame"
    | "pause" | "save" | "picture" | "statistics" | "help" | "escape" | "onlyInAWindow";
export interface KeyEntry {
    action: KeyAction;
    keys: string[];
    effect: string;
    repeats?: boolean;   // whether a held key acts again
}

export const kKeys: KeyEntry[] = [
    { action: "tool", keys: ["1", "2", "3", "4", "5", "6"], effect: "chooses the tool" },
    { action: "larger", keys: ["+", "=", "PgUp"], effect: "larger tool; nearer, if the page shows a session", repeats: true },
    { action: "smaller", keys: ["-", "PgDn"], effect: "smaller tool; farther, if the page shows a session", repeats: true },
    { action: "turnLeft", keys: [","], effect: "turns tool left", repeats: true },
    { action: "turnRight", keys: ["."], effect: "turns tool right", repeats: true },
    { action: "sceneTool", keys: ["0"], effect: "tool of the scene" },
    { action: "wetter", keys: ["W"], effect: "wetter sand", repeats: true },
    { action: "drier", keys: ["D"], effect: "drier sand", repeats: true },
    { action: "undo", keys: ["Ctrl+Z", "U"], effect: "undoes a stroke or an edit" },
    { action: "redo", keys: ["Ctrl+Y", "Ctrl+Shift+Z"], effect: "redoes it" },
    { action: "newSand", keys: ["Shift+R"], effect: "new sand; the sand before is kept" },
    { action: "frame", keys: ["Home", "V"], effect: "frames the terrain" },
    { action: "pause", keys: ["Space"], effect: "pauses or resumes" },
    { action: "save", keys: ["Ctrl+S"], effect: "saves the session as a file" },
    { action: "picture", keys: ["F12"], effect: "saves a picture, unless the browser takes the key" },
    { action: "statistics", keys: ["S"], effect: "details" },
    { action: "help", keys: ["F1", "?", "H"], effect: "this help" },
    { action: "escape", keys: ["Esc"], effect: "closes the help, else lifts the tool, else leaves full screen" },
    { action: "onlyInAWindow", keys: ["G", "M", "F", "T", "F9"], effect: "only in a window of a wall" },
];
/** Keys of a window that a page leaves to the browser. */
export const kOfTheBrowser = ["F11", "Ctrl+Q"];

const kTouches: [string, string][] = [
    ["left button, pen, finger", "digs"],
    ["wheel, two fingers apart", "comes nearer, to the place under the pointer"],
    ["double click or tap", "goes near to that place"],
    ["Shift+wheel", "depth of the tool"],
    ["Ctrl+wheel", "size of the tool"],
    ["right button, two fingers", "turns the sand"],
    ["middle, Shift+right", "moves the sand"],
    ["arrow keys on the sand", "move it; with Shift they turn it"],
    ["Tab", "goes to the next control"],
];

/** Returns the name of a key as docs/pointer.md has it. */
export function keyName({ key, code, ctrlKey, metaKey, altKey, shiftKey }: KeyboardEvent): string {
    const names: Record<string, string> = { " ": "Space", PageUp: "PgUp", PageDown: "PgDn", Escape: "Esc" };
    // On a keyboard of another script, the place of a letter counts.
    const isForeign = key.length === 1 && key.charCodeAt(0) > 127 && code.startsWith("Key");
    const own = isForeign ? code.slice(3) : names[key] ?? (key.length === 1 ? key.toUpperCase() : key);
    return (ctrlKey || metaKey ? "Ctrl+" : "") + (altKey ? "Alt+" : "") + (shiftKey && /^[A-Z]$/.test(own) ? "Shift+" : "") + own;
}
/** Returns the entry of a key, its place there, and whether it acts. A held key acts again only if its entry `repeats`. */
export function findKey(event: KeyboardEvent): { entry: KeyEntry; index: number; acts: boolean } | undefined {
    const name = keyName(event), entry = kKeys.find(({ keys }) => keys.includes(name));
    return entry && { entry, index: entry.keys.indexOf(name), acts: !event.repeat || entry.repeats === true };
}

/** Returns the help: all touches and keys. */
export function helpTable(): HTMLElement {
    const table = document.createElement("table");
    const add = (keys: string[], effect: string, kind: string) => {
        const row = table.insertRow(), first = row.insertCell();
        first.append(...keys.flatMap((key) => [Object.assign(document.createElement(kind), { textContent: key }), " "]));
        row.insertCell().textContent = effect;
    };
    kTouches.forEach(([touch, effect]) => add([touch], effect, "span"));
    kKeys.forEach(({ keys, effect }) => add(keys, effect, "kbd"));
    const all = document.createElement("div"), words = document.createElement("p");
    words.textContent = "A session is all that was dug, from its first stroke on. The browser keeps the ten newest; a private window forgets them when it is "
        + "closed. Esc or a press closes this help.";
    all.append(words, table);
    return all;
}
