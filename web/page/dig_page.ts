// SPDX-License-Identifier: Apache-2.0
// The part of the page that digs.
import { timeOf } from "../kept/keeper";
import type { View } from "../drawing/view";
import { DigPointer } from "../hand/dig_pointer";
import type { DigBegunMessage, DugMessage, FromHand, HandMessage, SandMessage, ToWorker } from "../replica/messages";
import { DigPanel } from "./dig_panel";
import { KeptList } from "./kept_list";

/** What digging uses of the page. */
export interface Page {
    tell(message: ToWorker, buffers?: Transferable[]): void;
    beginSand(sand: SandMessage): void;
    save(blob: Blob, name: string): void;
    problem(text: string): void;
}

// The words of a session's last line (scripts/launcher/resume_command.py), for a folder that the person makes.
const kContinues = "Put it into a folder of its own, such as out/dug. `scripts/sandwall run --resume --out out/dug --wall walls/configs/desktop.toml "
    + "--device pointer` continues with this sand.";
const say = document.getElementById("say")!, numbers = document.getElementById("numbers")!;

export class DigPage {
    private readonly panel: DigPanel;
    private readonly kept: KeptList;
    private greeting = "";       // sentence with which the hand begins
    private sand?: SandMessage;  // none while the page shows a journal

    constructor(private readonly page: Page, canvas: HTMLCanvasElement, private readonly view: View | undefined, private readonly noPicture: string) {
        this.kept = new KeptList((message) => page.tell(message));
        this.panel = new DigPanel((message) => page.tell(message), (scene) => this.kept.mayLeave() && page.tell({ dig: { name: scene } }),
                                  () => this.kept.mayLeave() && page.tell({ again: true }));
        if (view) {
            new DigPointer(canvas, view, (readings) => page.tell({ hand: readings }, [readings.buffer]), () => this.sand !== undefined && view.shows(this.sand));
        }
    }

    take(message: FromHand): void {
        switch (message.kind) {
            case "dig": return this.begin(message);
            case "material": return this.panel.showMaterial(message);
            case "dug": return this.showStep(message);
            case "hand": return this.beginHand(message);
            case "keeping": return this.kept.showKeeping(message);
            case "sessions": return this.kept.show(message);
            case "note": say.textContent = message.text; return;
            case "journal":
                this.page.save(new Blob([message.bytes], { type: "application/octet-stream" }), message.name);
                say.textContent = `${message.name} is saved. ${kContinues}`;
                return;
        }
    }

    private begin(opened: DigBegunMessage): void {
        this.page.beginSand(opened);
        this.sand = opened;
        this.panel.begin(opened);
        this.kept.begin();
        for (const key of ["steps", "hashes", "matches", "mismatches", "passed"]) {
            delete document.body.dataset[key];
        }
        Object.assign(document.body.dataset, { digging: opened.name, hand: "no" });
        if (this.view) {
            this.view.eye.digging = true;
        }
        const since = opened.since === undefined ? "" : `This is your sand of ${timeOf(opened.since)}. New sand begins anew, and this sand stays.`;
        this.greeting = [opened.note, since, `${opened.name}: press the left button or a finger, and dig. The right button or two fingers turn the sand.`,
                         opened.shortcoming, this.noPicture].filter((part) => part !== "").join(" ");
    }
    private beginHand({ step, hash }: HandMessage): void {
        Object.assign(document.body.dataset, { hand: "yes", goesOnStep: step, goesOnHash: hash });
        say.textContent = this.greeting;
    }
    /** The page shows a journal from now on. */
    end(): void {
        this.sand = undefined;
        this.panel.begin(undefined);
        this.kept.begin();
        delete document.body.dataset.digging;
        delete document.body.dataset.hand;
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

    /** Asks before sand is left that is not kept. Returns whether it may be. */
    mayLeave(): boolean { return this.kept.mayLeave(); }
    /** Begins with the newest kept sand, or with new sand of a sample scene. `only`: not with kept sand of other scenes. */
    start(scene: string, only: boolean): void {
        this.panel.scene = scene;
        this.page.tell({ start: { scene, only, mine: this.kept.mine } });
    }
}
