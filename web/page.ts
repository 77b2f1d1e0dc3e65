// SPDX-License-Identifier: Apache-2.0
// The page: opens sessions, shows what the worker computes, and says whether its hashes are those of the session.
import { DigPage } from "./dig_page";
import {
    type FrameMessage, type FromWorker, kUnitsPerCell, type ProgressMessage, type SandMessage, type SessionMessage, type ToWorker,
} from "./messages";
import { View } from "./view";

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const canvas = element<HTMLCanvasElement>("sand"), say = element("say"), numbers = element("numbers"), slider = element<HTMLInputElement>("step");
const playButton = element<HTMLButtonElement>("play"), cutButton = element<HTMLButtonElement>("cut");
const query = new URLSearchParams(location.search);

let sand: SandMessage | undefined;      // of the session, or of the hand
let session: SessionMessage | undefined;  // none while the page digs
let begun = false;                       // whether the session's first frame has come
let frame: FrameMessage | undefined;     // the last one
let progress: ProgressMessage | undefined;
let playing = false;
let pendingStep = Number(query.get("step") ?? NaN);

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
    view = new View(canvas, () => tell({ shown: true }));
    const eye = eyeOfAddress();
    if (eye) {
        view.eye = eye;
    }
} catch {
    noPicture = "This browser has no WebGL 2, so there is no picture. The sand is computed and compared all the same.";
}

function seconds(step: number): string {
    const all = step / (session?.stepsPerSecond ?? 60), minutes = Math.floor(all / 60);
    return `${minutes}:${(all - 60 * minutes).toFixed(1).padStart(4, "0")}`;
}

function describe(): void {
    if (!session || !progress) {
        return;
    }
    const { step, hash, matches, mismatches, passed } = progress, all = session.hashes;
    const doing = passed ? (mismatches === 0 ? `All ${matches} hashes equal those of the session.` : `${mismatches} of ${all} hashes differ from the session.`)
                         : `Computing the sand: step ${step} of ${session.lastStep}, ${matches} of ${all} hashes compared.`;
    const text = [session.name + ":", doing, passed ? session.shortcoming : "", noPicture].filter((part) => part !== "").join(" ");
    if (say.textContent !== text) {
        say.textContent = text;
    }
    const shown = frame?.step ?? step;
    numbers.textContent = `${seconds(shown)} of ${seconds(session.lastStep)}, step ${shown}, state hash of step ${step}: ${hash}`;
}

function showMarks(of: SessionMessage): void {
    const marks = element("marks");
    marks.replaceChildren();
    for (let i = 0; i < of.marks.length && i < 4000; i += 2) {
        const mark = document.createElement("i");
        mark.style.left = `${100 * of.marks[i] / Math.max(of.lastStep, 1)}%`;
        mark.className = of.marks[i + 1] === 0 ? "stroke" : "edit";
        marks.append(mark);
    }
}

function beginSand(opened: SandMessage): void {
    setPlaying(false);
    sand = opened;
    session = undefined;
    begun = false;
    progress = undefined;
    document.title = `${opened.name} – Sandwall`;
    delete document.body.dataset.problem;
    cutButton.disabled = element<HTMLButtonElement>("heights").disabled = opened.tin;
    cutButton.setAttribute("aria-pressed", "false");
    element<HTMLButtonElement>("picture").disabled = view === undefined;
}

function begin(opened: SessionMessage): void {
    beginSand(opened);
    session = opened;
    dig.end();
    Object.assign(document.body.dataset, { steps: opened.lastStep, hashes: opened.hashes, passed: "no" });
    slider.max = String(opened.lastStep);
    slider.disabled = playButton.disabled = true;
    element<HTMLButtonElement>("link").disabled = opened.address === "";
    showMarks(opened);
}

function take(message: ProgressMessage): void {
    progress = message;
    const { step, hash, matches, mismatches, passed } = message;
    Object.assign(document.body.dataset, { step, hash, matches, mismatches, passed: passed ? "yes" : "no" });
    if (!passed) {
        element("computed").style.width = `${100 * step / Math.max(session!.lastStep, 1)}%`;
    } else if (slider.disabled) {
        element("computed").style.width = "100%";
        slider.disabled = playButton.disabled = false;
        if (Number.isFinite(pendingStep)) {
            seek(Math.max(0, Math.min(session!.lastStep, Math.round(pendingStep))));
        }
        pendingStep = NaN;
    }
    if (passed && playing && step === (speed() > 0 ? session!.lastStep : 0)) {
        setPlaying(false);
    }
    describe();
}

function show(next: FrameMessage): void {
    frame = next;
    document.body.dataset.shown = String(next.step);
    if (document.activeElement !== slider || playing) {
        slider.value = String(next.step);
    }
    slider.setAttribute("aria-valuetext", `step ${next.step}, ${seconds(next.step)}`);
    if (!view) {
        tell({ shown: true });
    } else if (begun) {
        view.show(next);
    } else {
        view.begin(sand!, next);
    }
    begun = true;
    describe();
}

function problem(text: string): void {
    document.body.dataset.problem = text;
    say.textContent = text;
}

worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
    switch (data.kind) {
        case "session": return begin(data);
        case "frame": return show(data);
        case "progress": return take(data);
        case "problem": return problem(data.text);
        default: return dig.take(data);
    }
};
worker.onerror = (event) => problem(`The page's worker has failed: ${event.message}`);

const dig = new DigPage({ tell, beginSand, save, problem }, canvas, view, noPicture);

// Moments

const speed = () => Number(element<HTMLSelectElement>("speed").value);
function setPlaying(on: boolean): void {
    playing = on;
    playButton.textContent = on ? "Stop" : "Play";
    tell({ play: on && session ? speed() * session.stepsPerSecond : 0 });
}
function seek(step: number): void {
    if (playing) {
        setPlaying(false);
    }
    tell({ seek: step });
}
slider.oninput = () => seek(Number(slider.value));
playButton.onclick = () => setPlaying(!playing);
element("speed").onchange = () => { if (playing) { setPlaying(true); } };
cutButton.onclick = () => {
    const on = cutButton.getAttribute("aria-pressed") !== "true";
    cutButton.setAttribute("aria-pressed", String(on));
    if (view && begun) {
        view.cutAndFill = on;
    }
};

// Results

function save(blob: Blob, name: string): void {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
element("picture").onclick = () => canvas.toBlob((blob) => { if (blob) { save(blob, `${sand!.name}_${frame!.step}.png`); } });

/** Returns the heights as an ESRI ASCII grid in scene units, with its rows from the north. */
function asciiGrid(of: SandMessage, heights: Int32Array): string {
    const lines = [`ncols ${of.columns}`, `nrows ${of.rows}`, "xllcorner 0", "yllcorner 0", `cellsize ${of.cell}`];
    for (let y = of.rows - 1; y >= 0; --y) {
        lines.push(Array.from(heights.subarray(y * of.columns, (y + 1) * of.columns), (height) => height * of.cell / kUnitsPerCell).join(" "));
    }
    return lines.join("\n") + "\n";
}
element("heights").onclick = () => {
    if (sand && frame?.heights) {
        save(new Blob([asciiGrid(sand, frame.heights)], { type: "text/plain" }), `${sand.name}_${frame.step}.asc`);
    }
};
element("link").onclick = async () => {
    const eye = view ? `&view=${view.eye.map((n) => n.toFixed(4)).join(",")}` : "";
    const link = `${location.origin}${location.pathname}?journal=${encodeURIComponent(session!.address)}&step=${frame?.step ?? 0}${eye}`;
    history.replaceState(null, "", link);
    try {
        await navigator.clipboard.writeText(link);
        say.textContent = "The link to this moment is copied.";
    } catch {
        say.textContent = "The address of this page is now the link to this moment.";
    }
};

// Sessions

/** Returns the number of a part: 1 for session.journal, 2 for session.journal.2. */
const partOf = (name: string) => Number(/\.journal\.(\d+)$/.exec(name)?.[1] ?? 1);

async function openFiles(files: File[]): Promise<void> {
    if (files.length === 0) {
        return;
    }
    const grid = files.find((file) => !/\.journal(\.\d+)?$/.test(file.name) && /\.(asc|txt|grd)$/i.test(file.name));
    if (grid) {
        tell({ dig: { name: grid.name, file: grid } });
        return;
    }
    files.sort((a, b) => partOf(a.name) - partOf(b.name));
    try {
        const parts = await Promise.all(files.map((file) => file.arrayBuffer()));
        tell({ open: { name: files[0].name, address: "", parts } }, parts);
    } catch (error) {
        problem(`${files[0].name}: cannot be read (${(error as Error).message})`);
    }
}
element<HTMLInputElement>("files").onchange = (event) => void openFiles([...(event.target as HTMLInputElement).files!]);
addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("over"); });
addEventListener("dragleave", () => document.body.classList.remove("over"));
addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("over");
    void openFiles([...event.dataTransfer!.files]);
});

/** Fetches a journal of this page's own server, part by part. */
async function fetchJournal(path: string): Promise<void> {
    const url = new URL(path, location.href);
    if (url.origin !== location.origin) {
        return problem("The page only opens journals of its own server; drop the files instead.");
    }
    const parts: ArrayBuffer[] = [];
    for (let part = 1; ; ++part) {
        const answer = await fetch(part === 1 ? url : `${url.href}.${part}`);
        if (!answer.ok) {
            break;
        }
        parts.push(await answer.arrayBuffer());
    }
    if (parts.length === 0) {
        return problem(`${path}: the server does not have it; check the address`);
    }
    tell({ open: { name: url.pathname.slice(url.pathname.lastIndexOf("/") + 1), address: url.pathname, parts } }, parts);
}
const named = query.get("journal"), scene = query.get("dig");
if (scene !== null) {
    void dig.open(scene);
} else if (named !== null) {
    say.textContent = `Fetching ${named}`;
    fetchJournal(named).catch((error: Error) => problem(`${named}: cannot be fetched (${error.message})`));
} else if (noPicture !== "") {
    say.textContent = noPicture;
}
