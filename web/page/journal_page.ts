// SPDX-License-Identifier: Apache-2.0
// The part of the page that shows a journal: the timeline, and whether the hashes are those of the session.
import type { FrameMessage, ProgressMessage, SessionMessage, ToWorker } from "../replica/messages";
import { sayThis } from "./say";

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const numbers = element("numbers"), slider = element<HTMLInputElement>("step"), speed = element<HTMLSelectElement>("speed");
const playButton = element<HTMLButtonElement>("play");

const kMostMarks = 2000;

export class JournalPage {
    private session?: SessionMessage;   // none while the page digs
    private progress?: ProgressMessage;
    private shown?: number;             // step of the picture
    private playing = false;

    /** `pendingStep` is the step to show after the first pass, or NaN. */
    constructor(private readonly tell: (message: ToWorker) => void, private readonly noPicture: string, private pendingStep: number) {
        slider.oninput = () => this.seek(Number(slider.value));
        playButton.onclick = () => this.play(!this.playing);
        speed.onchange = () => {
            if (this.playing) {
                this.play(true);
            }
        };
    }

    /** The page has ended the sand before. */
    begin(opened: SessionMessage): void {
        this.session = opened;
        Object.assign(document.body.dataset, { steps: opened.lastStep, hashes: opened.hashes, passed: "no" });
        slider.max = String(opened.lastStep);
        slider.disabled = playButton.disabled = true;
        this.showMarks(opened);
    }
    /** The page shows other sand from now on. */
    end(): void {
        this.play(false);
        this.session = this.progress = this.shown = undefined;
    }

    take(message: ProgressMessage): void {
        this.progress = message;
        const { step, hash, matches, mismatches, passed } = message, last = this.session!.lastStep;
        Object.assign(document.body.dataset, { step, hash, matches, mismatches, passed: passed ? "yes" : "no" });
        if (!passed) {
            element("computed").style.width = `${100 * step / Math.max(last, 1)}%`;
        } else if (slider.disabled) {
            element("computed").style.width = "100%";
            slider.disabled = playButton.disabled = false;
            if (Number.isFinite(this.pendingStep)) {
                this.seek(Math.max(0, Math.min(last, Math.round(this.pendingStep))));
            }
            this.pendingStep = NaN;
        }
        if (passed && this.playing && step === (Number(speed.value) > 0 ? last : 0)) {
            this.play(false);
        }
        this.describe();
    }
    show({ step }: FrameMessage): void {
        this.shown = step;
        if (document.activeElement !== slider || this.playing) {
            slider.value = String(step);
        }
        slider.setAttribute("aria-valuetext", `step ${step}, ${this.seconds(step)}`);
        this.describe();
    }

    private seconds(step: number): string {
        const all = step / (this.session?.stepsPerSecond ?? 60), minutes = Math.floor(all / 60);
        return `${minutes}:${(all - 60 * minutes).toFixed(1).padStart(4, "0")}`;
    }
    private describe(): void {
        if (!this.session || !this.progress) {
            return;
        }
        const { step, hash, matches, mismatches, passed } = this.progress, { name, lastStep, hashes: all, shortcoming } = this.session;
        const doing = passed ? (mismatches === 0 ? `the same sand as the wall, ${matches} of ${all} times.` : `other sand than the wall, ${mismatches} of ${all} times.`)
                             : `computing the sand, ${this.seconds(step)} of ${this.seconds(lastStep)}. So far the same as the wall, ${matches} of ${all} times.`;
        const text = [`${name}:`, doing, passed ? shortcoming : "", this.noPicture].filter((part) => part !== "").join(" ");
        sayThis(text, true);
        const shown = this.shown ?? step;
        numbers.textContent = `${this.seconds(shown)} of ${this.seconds(lastStep)}, step ${shown}, state hash of step ${step}: ${hash}`;
    }
    private showMarks({ marks, lastStep }: SessionMessage): void {
        const timeline = element("marks");
        timeline.replaceChildren();
        for (const { step, what } of marks.slice(0, kMostMarks)) {
            const mark = document.createElement("i");
            mark.style.left = `${100 * step / Math.max(lastStep, 1)}%`;
            mark.className = what === "stroke" ? "stroke" : "edit";
            timeline.append(mark);
        }
    }

    /** Plays, or stops. */
    toggle(): void {
        if (!playButton.disabled) {
            this.play(!this.playing);
        }
    }
    private play(on: boolean): void {
        this.playing = on;
        playButton.textContent = on ? "Stop" : "Play";
        this.tell({ play: on && this.session ? Number(speed.value) * this.session.stepsPerSecond : 0 });
    }
    private seek(step: number): void {
        if (this.playing) {
            this.play(false);
        }
        this.tell({ seek: step });
    }
}
