// SPDX-License-Identifier: Apache-2.0
// Keeps the session that is dug: writes what its journal has gained, off the frame, whenever the hand has changed the sand.
import type { Replica } from "../replica/replica";
import { type KeptSand, type KeptSession, type KeptState, kMostKept, type LostSand } from "./kept_sand";

const kEachMs = 1000;          // between two pieces of a stroke
const kAgainMs = 5000;         // after the browser has refused a piece; twice as long after each further one
const kMostAgainMs = 60_000;
const kStateShare = 1 / 100;   // of the time, at most, for encoding states
const kFirstStateMs = 5000;    // before a session has a state
const kNextStateMs = 60_000;   // after a state did not fit

/** Returns when a session was dug last, as a person writes it. */
export const timeOf = (ms: number) => new Date(ms).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });

const isLost = (error: Error): error is LostSand => error.name === "LostSand";

/** How well a session is kept. */
export interface Keeping {
    id: string;
    unkept: boolean;          // whether the newest sand is not kept yet, or cannot be
    why: string;              // why it cannot be kept; empty if it can
    kept: { step: number; hash: string };
    gone: string[];           // sentences about sessions that had to go
}

export class Keeper {
    private written = 0;            // bytes of the journal that are kept
    private touched = 0;            // steps of the hand among them
    private saved = -1;             // steps of the hand in the file that was saved last
    private triedAt = -Infinity;
    private stateAt = performance.now() + kFirstStateMs;
    private writing?: Promise<void>;
    private ended = false;          // the replica has other sand
    private wanted = false;         // a piece as soon as possible
    private why: string;
    private refusals = 0;           // without a piece between them
    private told?: Keeping;
    private unkept = false;
    private kept = { step: 0, hash: "" };

    /** `data` is absent if the browser keeps nothing, and `why` then says so. `tell` gets each change. */
    constructor(private readonly data: KeptSand | undefined, why: string, private readonly session: KeptSession, private readonly stepsPerSecond: number,
                private readonly tell: (keeping: Keeping) => void) {
        this.why = why;
    }

    /** The session continues with `bytes` of a journal, which are kept. */
    goOn(replica: Replica, bytes: ArrayBuffer): void {
        // A journal that another release has begun is written anew.
        this.written = replica.beginsWith(bytes) ? bytes.byteLength : 0;
        this.touched = this.written > 0 ? replica.touched : 0;
        this.kept = { step: replica.step, hash: replica.hash };
        this.report(replica);
    }
    /** All sand so far is in a file. */
    save(replica: Replica): void { this.saved = replica.touched; }
    /** Keeps the newest sand as soon as possible. */
    hurry(): void { this.wanted = true; }

    /** Keeps what is not kept yet. Call end() before the replica has other sand. */
    async flush(replica: Replica): Promise<void> {
        await this.writing;
        if (this.data && replica.dug && replica.touched !== this.touched) {
            await this.write(replica);
        }
    }
    end(): void { this.ended = true; }

    /** After how many milliseconds work() must be called again, such as on a full disk; undefined if nothing waits to be written. */
    get waitMs(): number | undefined {
        if (!this.data || !(this.unkept || this.writing)) {
            return undefined;
        }
        return this.writing ? kEachMs : Math.max(0, this.triedAt + this.pause(true) - performance.now());
    }
    /** Returns the least time between two pieces [ms]. */
    private pause(engaged: boolean): number {
        if (this.refusals > 0) {
            return Math.min(kAgainMs * 2 ** (this.refusals - 1), kMostAgainMs);
        }
        return engaged ? kEachMs : 0;
    }
    /** Writes the next piece if it is time. Call it between steps. */
    work(replica: Replica, engaged: boolean): void {
        this.report(replica);
        const now = performance.now(), newSand = replica.touched !== this.touched || (this.wanted && this.written > 0 && replica.written > this.written);
        if (!this.data || this.writing || !replica.dug || !newSand) {
            this.wanted &&= newSand && this.data !== undefined;
            return;
        }
        if (this.wanted || now - this.triedAt >= this.pause(engaged)) {
            this.wanted = false;
            this.writing = this.write(replica).finally(() => { this.writing = undefined; });
        }
    }

    /** Returns a state if it is time for one. A journal is kept without one, too, so none is returned if the memory is full. */
    private state(replica: Replica): KeptState | undefined {
        const began = performance.now();
        if (began < this.stateAt) {
            return undefined;
        }
        try {
            const { step, hash } = replica, bytes = replica.state().slice().buffer, took = performance.now() - began;
            this.stateAt = began + Math.max(took / kStateShare, kEachMs);
            return { step, hash, bytes };
        } catch {
            this.stateAt = began + kNextStateMs;
            return undefined;
        }
    }
    /** Writes the journal from `offset` on, with a state if there is one and the browser takes it. */
    private async writeFrom(offset: number, replica: Replica, bytes: ArrayBuffer): Promise<KeptSession[]> {
        const state = this.state(replica);
        if (state) {
            try {
                return await this.data!.write(this.session, { offset, bytes, state });
            } catch (error) {
                if (isLost(error as Error)) {
                    throw error;
                }
                this.stateAt = performance.now() + kNextStateMs;  // the state alone may be too large
            }
        }
        return this.data!.write(this.session, { offset, bytes });
    }
    private async write(replica: Replica): Promise<void> {
        const { step, hash, touched, written } = replica, before = this.why;
        this.triedAt = performance.now();
        Object.assign(this.session, { changed: Date.now(), seconds: Math.round(step / this.stepsPerSecond) });
        let gone: string[] = [];
        try {
            const all = this.written === 0, removed = await this.writeFrom(this.written, replica, replica.journalFrom(this.written)).catch((error) => {
                if (all || this.ended || !isLost(error)) {
                    throw error;
                }
                // The replica may have made further steps meanwhile, so no state of it belongs to these bytes.
                return this.data!.write(this.session, { offset: 0, bytes: replica.journalFrom(0).slice(0, written) });
            });
            [this.written, this.touched, this.kept, this.why, this.refusals] = [written, touched, { step, hash }, "", 0];
            gone = removed.map(({ name, changed }) => `This browser keeps ${kMostKept} sessions, so the oldest was removed: ${name} of ${timeOf(changed)}.`);
            if (before !== "") {
                gone.push("The sand is kept again.");
            }
        } catch (error) {
            const { name, message } = error as Error;
            this.why = name === "QuotaExceededError" ? "its storage is full" : message || name;
            this.refusals += 1;
        }
        if (!this.ended) {
            this.report(replica, gone);
        }
    }

    private report(replica: Replica, gone: string[] = []): void {
        const { kept, why } = this, { id } = this.session;
        const unkept = this.unkept = replica.dug && replica.touched !== this.touched && replica.touched !== this.saved, { told } = this;
        if (!told || told.unkept !== unkept || told.why !== why || told.kept !== kept || gone.length > 0) {
            this.told = { id, unkept, why, kept, gone };
            this.tell(this.told);
        }
    }
}
