// SPDX-License-Identifier: Apache-2.0
// The page's hand as the source of steps. A step is due whenever the time of one has passed, as in a session. Its sweeps
// are spread, so the worker answers between two steps.
import type { Keeper } from "../kept/keeper";
import type { ToWorker } from "../replica/messages";
import type { Replica } from "../replica/replica";
import { kSliceMs, type Stage, type StepSource } from "../replica/step_source";

const kMostResting = 600;  // steps without any change, after which the hand waits for the page
const kMostDue = 4;        // steps. A slow browser leaves out the rest, and so does a slow wall
const kProgressMs = 100;
const kLongMs = 100;       // a step that takes longer is felt

export class HandSource implements StepSource {
    private due = 0;               // steps
    private last = performance.now();
    private changed = true;        // since the frame that was sent last
    private told = -kProgressMs;
    private toldStep = -1;
    private toldMaterial = "";
    private longest = 0;           // ms, of a step since the message before
    private resting = 0;           // steps
    private pressed = false;
    private paused = false;

    constructor(private readonly replica: Replica, private readonly stepsPerSecond: number, private readonly stage: Stage, private readonly keeper: Keeper) {
        this.tellMaterial();
    }

    take(message: ToWorker): void {
        this.resting = 0;
        try {
            if ("hand" in message) {
                this.replica.point(message.hand);
                this.pressed = message.hand.at(-1) === 1;
            } else if ("edit" in message) {
                this.replica.ask(message.edit);
            } else if ("tool" in message) {
                this.replica.setTool(message.tool, message.value);
            } else if ("material" in message) {
                this.replica.setMaterial(message.material, message.value);
            } else if ("depth" in message) {
                this.replica.setDepth(message.depth);
            } else if ("notches" in message) {
                this.replica.changeByNotches(message.of, message.notches);
            } else if ("enlarge" in message) {
                this.replica.enlargeTool();
            } else if ("pause" in message) {
                this.paused = message.pause;
            } else if ("keep" in message) {
                this.keeper.hurry();
            } else if ("save" in message) {
                const bytes = this.replica.journal();
                this.keeper.save(this.replica);
                this.stage.tell({ kind: "journal", name: "session.journal", bytes }, [bytes]);
            }
        } catch (error) {
            this.stage.tell({ kind: "note", text: (error as Error).message });
        }
        if (["tool", "material", "notches", "enlarge"].some((change) => change in message)) {
            this.tellMaterial();
        }
    }

    work(): number | undefined {
        const began = performance.now();
        this.due = Math.min(this.due + (began - this.last) * this.stepsPerSecond / 1000, kMostDue);
        this.last = began;
        this.due = this.paused ? 0 : this.due;
        while (this.due >= 1 && performance.now() - began < kSliceMs) {
            this.due -= 1;
            this.step();
        }
        if (this.changed && this.stage.show()) {
            this.changed = false;
        }
        const now = performance.now();
        if (now - this.told >= kProgressMs && this.toldStep !== this.replica.step) {
            this.tellStep(this.longest >= kLongMs ? `A step of this sand takes ${Math.round(this.longest)} ms; the page waits for it.` : "");
            this.longest = 0;
        }
        this.keeper.work(this.replica, this.pressed);
        return (this.paused || this.resting > kMostResting) && !this.keeper.waits ? undefined : Math.max(0, (1 - this.due) * 1000 / this.stepsPerSecond);
    }

    private step(): void {
        if (this.replica.settlesNext) {
            this.tellStep("All sand settles; the page waits for it.");
        }
        const before = performance.now();
        this.resting = this.replica.rests ? this.resting + 1 : 0;
        this.changed = this.replica.digOn() || this.changed;
        this.longest = Math.max(this.longest, performance.now() - before);
    }

    private tellMaterial(): void {
        this.toldMaterial = JSON.stringify(this.replica.material);
        this.stage.tell({ kind: "material", ...this.replica.material });
    }
    private tellStep(busy: string): void {
        this.told = performance.now();
        this.toldStep = this.replica.step;
        if (JSON.stringify(this.replica.material) !== this.toldMaterial) {  // an undo or a redo has changed it
            this.tellMaterial();
        }
        this.stage.tell({ kind: "dug", step: this.toldStep, hash: this.replica.hash, undo: this.replica.canUndo, busy });
    }
}
