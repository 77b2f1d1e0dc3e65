// SPDX-License-Identifier: Apache-2.0
// The part of the page that digs.
import type { View } from "../drawing/view";
import { DigPointer } from "../hand/dig_pointer";
import type { DigBegunMessage, DugMessage, FromHand, SandMessage, ToWorker } from "../replica/messages";
import { DigPanel } from "./dig_panel";
import { fetchSandwallFile } from "./fetched";

/** What digging uses of the page. */
export interface Page {
    tell(message: ToWorker, buffers?: Transferable[]): void;
    beginSand(sand: SandMessage): void;
    save(blob: Blob, name: string): void;
    problem(text: string): void;
}

const say = document.getElementById("say")!, numbers = document.getElementById("numbers")!;

export class DigPage {
    private readonly panel: DigPanel;
    private sand?: SandMessage;  // none while the page shows a journal

    constructor(private readonly page: Page, canvas: HTMLCanvasElement, private readonly view: View | undefined, private readonly noPicture: string) {
        this.panel = new DigPanel((message) => page.tell(message), (scene) => void this.open(scene));
        if (view) {
            new DigPointer(canvas, view, (readings) => page.tell({ hand: readings }, [readings.buffer]), () => this.sand !== undefined && view.shows(this.sand));
        }
    }

    take(message: FromHand): void {
        switch (message.kind) {
            case "dig": return this.begin(message);
            case "material": return this.panel.showMaterial(message);
            case "dug": return this.showStep(message);
            case "note": say.textContent = message.text; return;
            case "journal": return this.page.save(new Blob([message.bytes], { type: "application/octet-stream" }), message.name);
        }
    }

    private begin(opened: DigBegunMessage): void {
        this.page.beginSand(opened);
        this.sand = opened;
        this.panel.begin(opened);
        for (const key of ["steps", "hashes", "matches", "mismatches", "passed"]) {
            delete document.body.dataset[key];
        }
        document.body.dataset.digging = opened.name;
        if (this.view) {
            this.view.eye.digging = true;
        }
        say.textContent = [`${opened.name}: press the left button or a finger, and dig. The right button or two fingers turn the sand.`,
                           opened.shortcoming, this.noPicture].filter((part) => part !== "").join(" ");
    }
    /** The page shows a journal from now on. */
    end(): void {
        this.sand = undefined;
        this.panel.begin(undefined);
        delete document.body.dataset.digging;
        if (this.view) {
            this.view.eye.digging = false;
        }
    }

    private showStep(message: DugMessage): void {
        const { step, hash, busy } = message;
        Object.assign(document.body.dataset, { step, hash, busy });
        numbers.textContent = [`${(step / this.sand!.stepsPerSecond).toFixed(1)} s, step ${step}, state hash ${hash}`, busy].filter((part) => part !== "").join(". ");
        this.panel.showStep(message);
    }

    /** Begins to dig in a sample scene. */
    async open(scene: string): Promise<void> {
        try {
            const file = await fetchSandwallFile(`${encodeURIComponent(scene)}.scene`);
            if ("why" in file) {
                throw new Error(file.why);
            }
            this.page.tell({ dig: { name: scene, scene: file.bytes } }, [file.bytes]);
        } catch (error) {
            this.page.problem(`${scene}: cannot be fetched (${(error as Error).message}); build the page again`);
        }
    }
}
