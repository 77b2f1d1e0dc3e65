// SPDX-License-Identifier: Apache-2.0
// Keeps the session that is dug: writes what its journal has gained, off the frame, whenever the hand has changed the sand.
import type { Replica } from "../replica/replica";
import { type KeptSand, type KeptSession, type KeptState, kMostKept } from "./kept_sand";

const kEachMs = 1000;          // between two pieces of a stroke
const kAgainMs = 5000;         // after the browser has refused a piece
const kStateShare = 1 / 100;   // of the time, at most, for encoding states
const kFirstStateMs = 5000;    // before a session has a state

/** Returns when a session was dug last, as a person writes it. */
export const timeOf = (ms: number) => new Date(ms).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });

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
    private told = "";
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

    /** Whether sand waits to be written, such as on a full disk. work() must be called again then. */
    get waits(): boolean { return this.data !== undefined && this.unkept; }
    /** Writes the next piece if it is time. Call it between steps. */
    work(replica: Replica, engaged: boolean): void {
        this.report(replica);
        const now = performance.now(), newSand = replica.touched !== this.touched || (this.wanted && this.written > 0 && replica.written > this.written);
        if (!this.data || this.writing || !replica.dug || !newSand) {
            this.wanted &&= newSand && this.data !== undefined;
            return;
        }
        const pause = this.why !== "" ? kAgainMs : engaged ? kEachMs : 0;
        if (this.wanted || now - this.triedAt >= pause) {
            this.wanted = false;
            this.triedAt = now;
            this.writing = this.write(replica).finally(() => { this.writing = undefined; });
        }
    }

    private state(replica: Replica): KeptState | undefined {
        const began = performance.now();
        if (began < this.stateAt) {
            return undefined;
        }
        const { step, hash } = replica, bytes = replica.state().slice().buffer, took = performance.now() - began;
        this.stateAt = began + Math.max(took / kStateShare, kEachMs);
        return { step, hash, bytes };
    }
    private async write(replica: Replica): Promise<void> {
        const { step, hash, touched, written } = replica, offset = this.written, before = this.why;
        Object.assign(this.session, { changed: Date.now(), seconds: Math.round(step / this.stepsPerSecond) });
        let gone: string[] = [];
        try {
            const removed = await this.data!.write(this.session, { offset, bytes: replica.journalFrom(offset), state: this.state(replica) });
            [this.written, this.touched, this.kept, this.why] = [written, touched, { step, hash }, ""];
            gone = removed.map(({ name, changed }) => `This browser keeps ${kMostKept} sessions, so the oldest was removed: ${name} of ${timeOf(changed)}.`);
            if (before !== "") {
                gone.push("The sand is kept again.");
            }
        } catch (error) {
            const { name, message } = error as Error;
            this.why = name === "QuotaExceededError" ? "its storage is full" : message || name;
        }
        if (!this.ended) {
            this.report(replica, gone);
        }
    }

    private report(replica: Replica, gone: string[] = []): void {
        const { kept, why } = this, { id } = this.session;
        const unkept = this.unkept = replica.dug && replica.touched !== this.touched && replica.touched !== this.saved, now = JSON.stringify([unkept, why, kept]);
        if (now !== this.told || gone.length > 0) {
            this.told = now;
            this.tell({ id, unkept, why, kept, gone });
        }
    }
}
