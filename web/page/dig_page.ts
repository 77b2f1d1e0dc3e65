// SPDX-License-Identifier: Apache-2.0
// The part of the page that digs.
import { timeOf } from "../kept/keeper";
import type { View } from "../drawing/view";
import { DigPointer } from "../hand/dig_pointer";
import type { DigBegunMessage, DugMessage, FromHand, HandMessage, SandMessage, ToWorker } from "../replica/messages";
import { DigPanel } from "./dig_panel";
import { KeptList } from "./kept_list";
import type { KeyAction } from "./key_list";
import { sayThis } from "./say";

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
const kHasFingers = matchMedia("(pointer: coarse)").matches;
const numbers = document.getElementById("numbers")!;

export class DigPage {
    private readonly panel: DigPanel;
    private readonly kept: KeptList;
    private readonly pointer?: DigPointer;
    private ready = false;       // whether the hand can dig
    private paused = false;
    private greeting = "";       // sentence with which the hand begins
    private sand?: SandMessage;  // none while the page shows a journal

    constructor(private readonly page: Page, canvas: HTMLCanvasElement, private readonly view: View | undefined, private readonly noPicture: string,
                near: (clientX: number, clientY: number) => void) {
        this.kept = new KeptList((message) => page.tell(message));
        this.panel = new DigPanel((message) => page.tell(message), (scene) => this.open(scene), () => this.again());
        if (view) {
            const send = (readings: Float64Array) => {
                view.showTool();
                page.tell({ hand: readings }, [readings.buffer]);
            };
            this.pointer = new DigPointer(canvas, view, send, () => this.sand !== undefined && view.shows(this.sand), (x, y) => near(x, y));
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
            case "note": return sayThis(message.text);
            case "journal":
                this.page.save(new Blob([message.bytes], { type: "application/octet-stream" }), message.name);
                sayThis(`${message.name} is saved. ${kContinues}`, true);
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
            this.view.digging = true;
        }
        this.paused = this.ready = false;
        const since = opened.since === undefined ? "" : `This is your sand of ${timeOf(opened.since)}. "New sand" in "More" begins anew, and this sand stays.`;
        const how = kHasFingers ? 'draw with a finger. "Help" is in "More".' : "draw with the left button. H shows all keys.";
        this.greeting = [opened.note, since, `${opened.name}: ${how}`,
                         opened.shortcoming, this.noPicture].filter((part) => part !== "").join(" ");
    }
    private beginHand({ step, hash }: HandMessage): void {
        Object.assign(document.body.dataset, { hand: "yes", goesOnStep: step, goesOnHash: hash });
        this.ready = true;
        if (step === 0) {
            this.panel.beginLargeEnough();
        }
        sayThis(this.greeting);
    }
    /** The page shows a journal from now on. */
    end(): void {
        this.sand = undefined;
        this.panel.begin(undefined);
        this.kept.begin();
        delete document.body.dataset.digging;
        delete document.body.dataset.hand;
        if (this.view) {
            this.view.digging = false;
        }
    }

    private showStep(message: DugMessage): void {
        const { step, hash, busy } = message;
        Object.assign(document.body.dataset, { step, hash, busy });
        numbers.textContent = [`${(step / this.sand!.stepsPerSecond).toFixed(1)} s, step ${step}, state hash ${hash}`, busy].filter((part) => part !== "").join(". ");
        this.panel.showStep(message);
    }

    /** Lifts the tool. Returns false if it is not pressed. */
    lift(): boolean { return this.pointer?.lift() ?? false; }
    get digs(): boolean { return this.sand !== undefined; }
    /** Does what a key asks for, while the page digs. */
    act(action: KeyAction, index: number): void {
        const { panel, page } = this;
        if (!this.ready) {
            return;
        }
        switch (action) {
            case "tool": return panel.chooseTool(index);
            case "larger": return panel.changeBy("size", 1);
            case "smaller": return panel.changeBy("size", -1);
            case "turnLeft": return panel.changeBy("heading", 1);
            case "turnRight": return panel.changeBy("heading", -1);
            case "sceneTool": return panel.restoreTool();
            case "wetter": return panel.changeBy("humidity", 1);
            case "drier": return panel.changeBy("humidity", -1);
            case "undo": return page.tell({ edit: "undo" });
            case "redo": return page.tell({ edit: "redo" });
            case "newSand": return this.again();
            case "save": return page.tell({ save: true });
            case "pause":
                this.paused = !this.paused;
                page.tell({ pause: this.paused });
                return sayThis(this.paused ? "Paused. Space resumes." : "Resumed.", this.paused);
        }
    }
    /** What the wheel changes. */
    readonly wheel = { depth: (by: number) => this.ready && this.panel.deepen(by), size: (by: number) => this.ready && this.panel.changeBy("size", -by) };
    private again(): void {
        if (this.kept.mayLeave()) {
            this.page.tell({ again: true });
        }
    }
    /** Begins with new sand of a scene. */
    open(scene: string): void {
        if (this.kept.mayLeave()) {
            this.page.tell({ dig: { name: scene } });
        }
    }

    /** Asks before sand is left that is not kept. Returns whether it may be. */
    mayLeave(): boolean { return this.kept.mayLeave(); }
    /** Begins with the newest kept sand, or with new sand of a sample scene. `only`: not with kept sand of other scenes. */
    start(scene: string, only: boolean): void {
        this.panel.scene = scene;
        this.page.tell({ start: { scene, only, mine: this.kept.mine } });
    }
}
