// SPDX-License-Identifier: Apache-2.0
// Opens files: those that a person drops or chooses, and a journal of the page's own server.
import type { ToWorker } from "../replica/messages";
import { fetchSandwallFile } from "./fetched";

/** What opening uses of the page. */
export interface Opener {
    tell(message: ToWorker, buffers?: Transferable[]): void;
    problem(text: string): void;
    /** Asks before sand is left that is not kept. */
    mayLeave(): boolean;
}

/** Returns the number of a part: 1 for session.journal, 2 for session.journal.2. */
const partOf = (name: string) => Number(/\.journal\.(\d+)$/.exec(name)?.[1] ?? 1);

async function openFiles(files: File[], page: Opener): Promise<void> {
    if (files.length === 0 || !page.mayLeave()) {
        return;
    }
    const grid = files.find((file) => !/\.journal(\.\d+)?$/.test(file.name) && /\.(asc|txt|grd)$/i.test(file.name));
    if (grid) {
        page.tell({ dig: { name: grid.name, file: grid } });
        return;
    }
    files.sort((a, b) => partOf(a.name) - partOf(b.name));
    try {
        const parts = await Promise.all(files.map((file) => file.arrayBuffer()));
        page.tell({ open: { name: files[0].name, address: "", parts } }, parts);
    } catch (error) {
        page.problem(`${files[0].name}: cannot be read (${(error as Error).message})`);
    }
}

/** Opens the files that are dropped on the page, or chosen. */
export function openDroppedFiles(page: Opener): void {
    const input = document.getElementById("files") as HTMLInputElement, over = (is: boolean) => document.body.classList.toggle("over", is);
    input.onchange = () => {
        const files = [...input.files!];
        input.value = "";  // otherwise a browser sends no event when a file is chosen again, after it has changed
        void openFiles(files, page);
    };
    addEventListener("dragover", (event) => {
        event.preventDefault();
        over(true);
    });
    addEventListener("dragleave", () => over(false));
    addEventListener("drop", (event: DragEvent) => {
        event.preventDefault();
        over(false);
        void openFiles([...event.dataTransfer!.files], page);
    });
}

/** Fetches a journal of this page's own server, part by part, and opens it. */
export async function fetchJournal(path: string, page: Opener): Promise<void> {
    const url = new URL(path, location.href);
    if (url.origin !== location.origin) {
        return page.problem("The page only opens journals of its own server; drop the files instead.");
    }
    const parts: ArrayBuffer[] = [];
    for (;;) {
        const part = await fetchSandwallFile(parts.length === 0 ? url : `${url.href}.${parts.length + 1}`);
        if ("bytes" in part) {
            parts.push(part.bytes);
        } else if (parts.length === 0) {
            return page.problem(`${path}: ${part.why}; check the address`);
        } else {
            break;
        }
    }
    page.tell({ open: { name: url.pathname.slice(url.pathname.lastIndexOf("/") + 1), address: url.pathname, parts } }, parts);
}
