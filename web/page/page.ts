// SPDX-License-Identifier: Apache-2.0
// The page: passes what the worker computes to its parts, and draws it.
import { View } from "../drawing/view";
import type { FrameMessage, FromWorker, SandMessage, SessionMessage, ToWorker } from "../replica/messages";
import { DigPage } from "./dig_page";
import { JournalPage } from "./journal_page";
import { showOthers } from "./others";
import type { KeyAction } from "./key_list";
import { Keys } from "./keys";
import { Layout } from "./layout";
import { PlaceUnderPointer } from "./place";
import { Results, save, textOfEye } from "./results";
import { hush, sayThis } from "./say";
import { fetchJournal, openDroppedFiles } from "./session_files";

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const canvas = element<HTMLCanvasElement>("sand"), cutButton = element<HTMLButtonElement>("cut");
// What the parts of the page take from the sand that begins.
const kKnown = ["kind", "name", "shortcoming", "hasHeights", "columns", "rows", "cell", "stepsPerSecond", "middle", "address", "lastStep", "hashes", "marks", "words", "sceneMaterial", "since", "note"];
const kFirstScene = "dunes";
const kCloser = 0.87;  // share of the distance
const query = new URLSearchParams(location.search);

const worker = new Worker("worker.js", { type: "module" });
const tell = (message: ToWorker, buffers: Transferable[] = []) => worker.postMessage(message, buffers);

/** Returns the six numbers of the address's `view`, if it has them. */
function eyeOfAddress(): number[] | undefined {
    const numbers = (query.get("view") ?? "").split(",").map(Number);
    return numbers.length === 6 && numbers.every(Number.isFinite) ? numbers : undefined;
}

let view: View | undefined;
let noPicture = "";
try {
    view = new View(canvas, () => {
        Object.assign(document.body.dataset, { view: textOfEye(view!), tool: view!.showsTool ? "yes" : "no" });
        tell({ shown: true });
    });
    const eye = eyeOfAddress();
    if (eye) {
        view.eye.places = eye;
    }
} catch {
    noPicture = "This browser has no WebGL 2, so there is no picture. The sand is computed and compared all the same.";
}

function problem(text: string): void {
    document.body.dataset.problem = text;
    sayThis(text, true);
}

const journal = new JournalPage(tell, noPicture, Number(query.get("step") ?? NaN));
const place = view && new PlaceUnderPointer(canvas, view, tell);
const dig = new DigPage({ tell, beginSand, save, problem }, canvas, view, noPicture, (x, y) => place?.look(x, y, true));
const layout = new Layout((name) => dig.open(name));
const results = new Results(canvas, view);

let sand: SandMessage | undefined;  // of the session, or of the hand
let begun = false;                  // whether its first frame has come

/** Begins to show other sand. `address` is that of its journal, if it was fetched. */
function beginSand(opened: SandMessage, address = ""): void {
    journal.end();
    sand = opened;
    begun = false;
    document.title = `${opened.name} – Sandwall`;
    for (const old of ["problem", "shown", "step", "hash"]) {
        delete document.body.dataset[old];
    }
    cutButton.disabled = !opened.hasHeights;
    cutButton.setAttribute("aria-pressed", "false");
    results.begin(opened, address);
    place?.begin(opened.cell);
    showOthers("sand", opened, kKnown);
}
function beginJournal(opened: SessionMessage): void {
    beginSand(opened, opened.address);
    dig.end();
    journal.begin(opened);
}

function show(frame: FrameMessage): void {
    document.body.dataset.shown = String(frame.step);
    results.show(frame);
    if (!view) {
        tell({ shown: true });
    } else if (begun) {
        view.show(frame);
    } else {
        view.begin(sand!, frame);
    }
    begun = true;
    journal.show(frame);
}
cutButton.onclick = () => {
    const on = cutButton.getAttribute("aria-pressed") !== "true";
    cutButton.setAttribute("aria-pressed", String(on));
    if (view && begun) {
        view.cutAndFill = on;
    }
};

worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
    switch (data.kind) {
        case "session": return beginJournal(data);
        case "frame": return show(data);
        case "progress": return journal.take(data);
        case "place": return place?.take(data);
        case "problem": return problem(data.text);
        case "dig":
            if (data.since !== undefined) {
                layout.invite(false);  // a person's own sand
            }
            return dig.take(data);
        default: return dig.take(data);
    }
};
// A worker that could not be loaded sends an event without a message.
worker.onerror = ({ message }) => problem(message ? `The page's worker has failed: ${message}` : "worker.js cannot be loaded; put all files of the page on the server");

const opener = { tell, problem, mayLeave: () => dig.mayLeave() };
openDroppedFiles(opener);

/** Does what a key asks for. */
function act(action: KeyAction, index: number): void {
    switch (action) {
        case "help": return layout.showHelp(!layout.helps);
        case "escape":
            if (!layout.close() && !dig.lift() && document.fullscreenElement) {
                void document.exitFullscreen();
            }
            return;
        case "statistics": return layout.showDetails();
        case "frame": return view?.eye.lookAtAll();
        case "picture": return element("picture").click();
        case "onlyInAWindow": return sayThis("This key works only in a window of a wall. H shows all keys.");
    }
    if (dig.digs) {
        return dig.act(action, index);
    }
    switch (action) {
        case "pause": return journal.toggle();
        case "larger": return view?.eye.approach(kCloser);
        case "smaller": return view?.eye.approach(1 / kCloser);
    }
}
new Keys(canvas, act, dig.wheel, () => dig.digs);
canvas.addEventListener("pointerdown", hush);
canvas.addEventListener("dblclick", ({ clientX, clientY }) => {
    if (!dig.digs) {
        place?.look(clientX, clientY, true);
    }
});

const named = query.get("journal"), scene = query.get("dig");
if (named !== null && scene === null) {
    sayThis(`Fetching ${named}`, true);
    fetchJournal(named, opener).catch((error: Error) => problem(`${named}: cannot be fetched (${error.message})`));
} else {
    dig.start(scene ?? kFirstScene, scene !== null);
    layout.invite(scene === null && view !== undefined);
}
