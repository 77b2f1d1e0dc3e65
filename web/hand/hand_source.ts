// SPDX-License-Identifier: Apache-2.0
// The page's hand as the source of steps. A step is due whenever the time of one has passed, as in a session. Its sweeps
// are spread, so the worker answers between two steps.
import type { Keeper } from "../kept/keeper";
import { kReadingNumbers, type ToWorker } from "../replica/messages";
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
    private reading = new Float64Array(kReadingNumbers);  // that came last
    private paused = false;

    constructor(private readonly replica: Replica, private readonly stepsPerSecond: number, private readonly stage: Stage, private readonly keeper: Keeper) {
        this.tellMaterial();
    }

    take(message: ToWorker): void {
        this.resting = 0;
        try {
            if ("hand" in message) {
                this.point(message.hand);
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
                this.pause(message.pause);
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
    private point(readings: Float64Array): void {
        if (!this.paused) {  // no step would take them, so they would fill the memory
            this.replica.point(readings);
            this.reading = readings.slice(-kReadingNumbers);
            this.pressed = readings.at(-1) === 1;
        }
    }
    /** Pauses, or resumes. A pause lifts the tool, so that a stroke does not go on from there to where the pointer is afterwards. */
    private pause(on: boolean): void {
        if (on && this.pressed) {
            const [ms, ...sight] = this.reading;
            this.point(Float64Array.from([ms + 1, ...sight.slice(0, -1), 0]));
        }
        this.paused = on;
    }

    work(): number | undefined {
        const began = performance.now();
        this.due = Math.min(this.due + (began - this.last) * this.stepsPerSecond / 1000, kMostDue);
        this.last = began;
        this.due = this.waits ? 0 : this.due;
        while (this.due >= 1 && performance.now() - began < kSliceMs) {
            this.due -= 1;
            this.step();
        }
        if (this.changed && this.stage.show()) {
            this.changed = false;
        }
        const now = performance.now();
        if ((this.waits || now - this.told >= kProgressMs) && this.toldStep !== this.replica.step) {
            this.tellStep(this.longest >= kLongMs ? `A step of this sand takes ${Math.round(this.longest)} ms; the page waits for it.` : "");
            this.longest = 0;
        }
        this.keeper.work(this.replica, this.pressed);
        return this.waits ? this.keeper.waitMs : Math.max(0, (1 - this.due) * 1000 / this.stepsPerSecond);
    }
    /** Whether no step is made until a message comes. */
    private get waits(): boolean { return this.paused || this.resting > kMostResting; }

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
        this.toldMaterial = this.replica.materialText;
        this.stage.tell({ kind: "material", ...JSON.parse(this.toldMaterial) });
    }
    private tellStep(busy: string): void {
        this.told = performance.now();
        this.toldStep = this.replica.step;
        if (this.replica.materialText !== this.toldMaterial) {  // an undo or a redo has changed it
            this.tellMaterial();
        }
        const { hash, canUndo: undo, canRedo: redo } = this.replica;
        this.stage.tell({ kind: "dug", step: this.toldStep, hash, undo, redo, busy });
    }
}
