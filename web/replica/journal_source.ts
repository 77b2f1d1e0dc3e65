// SPDX-License-Identifier: Apache-2.0
// A journal as the source of steps. The first pass computes every step once; then any moment can be shown.
import { copyState, type Keyframes } from "./keyframes";
import type { ToWorker } from "./messages";
import type { Replica } from "./replica";
import { kSliceMs, type Stage, type StepSource } from "./step_source";

const kProgressMs = 100;

export class JournalSource implements StepSource {
    private passed = false;           // whether the first pass has ended
    private wanted = 0;               // step to show, after the first pass
    private rate = 0;                 // steps per second
    private playedAt = 0;
    private playedFrom = 0;
    private lastProgress = -kProgressMs;
    private toldStep = -1;

    constructor(private readonly replica: Replica, private readonly session: { lastStep: number }, private readonly keyframes: Keyframes,
                private readonly stage: Stage) {
        keyframes.clear();
        keyframes.passed(0, 0, () => replica.state());
    }

    take(message: ToWorker): void {
        if ("seek" in message) {
            this.rate = 0;
            this.wanted = message.seek;
        } else if ("play" in message) {
            this.rate = message.play;
            this.playedAt = performance.now();
            this.playedFrom = this.replica.step;
            if (this.rate > 0 && this.playedFrom === this.session.lastStep) {
                this.playedFrom = 0;
            }
        }
    }

    work(): number | undefined {
        let rests = false;
        if (!this.passed) {
            this.pass();
            this.stage.show();
        } else {
            rests = this.goOn();
            if (rests) {
                this.stage.show();
            }
            if (rests && this.rate !== 0) {
                this.nextWanted(performance.now());
                rests = false;
            }
        }
        const now = performance.now();
        if (this.toldStep !== this.replica.step && ((this.passed && rests) || now - this.lastProgress >= kProgressMs)) {
            this.tellProgress(now);
        }
        return rests ? undefined : this.rate !== 0 ? 4 : 0;
    }

    private tellProgress(now: number): void {
        const it = this.replica;
        this.lastProgress = now;
        this.toldStep = this.passed ? it.step : -1;
        this.stage.tell({ kind: "progress", step: it.step, hash: it.hash, matches: it.matches, mismatches: it.mismatches, passed: this.passed });
    }

    /** Works on the first pass for a slice. */
    private pass(): void {
        const it = this.replica, began = performance.now();
        let before = began;
        while (performance.now() - began < kSliceMs) {
            if (!it.advance()) {
                this.passed = true;
                this.wanted = it.step;
                break;
            }
            const now = performance.now();
            this.keyframes.passed(it.step, now - before, () => it.state());
            before = performance.now();
        }
    }

    /** Goes towards the wanted step for a slice. Returns whether it is reached. */
    private goOn(): boolean {
        const it = this.replica;
        const keyframe = this.keyframes.before(this.wanted);
        if (it.step > this.wanted || it.step < keyframe.step) {
            it.restore(keyframe.length, (into) => copyState(keyframe, into));
        }
        const began = performance.now();
        while (it.step < this.wanted && performance.now() - began < kSliceMs) {
            if (!it.stepOn()) {
                break;
            }
        }
        return it.step >= this.wanted;
    }

    private nextWanted(now: number): void {
        const last = this.session.lastStep;
        this.wanted = Math.max(0, Math.min(last, Math.round(this.playedFrom + (now - this.playedAt) * this.rate / 1000)));
        if (this.wanted === (this.rate > 0 ? last : 0)) {
            this.rate = 0;
        }
    }
}
