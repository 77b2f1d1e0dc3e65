// SPDX-License-Identifier: Apache-2.0
// Begins with sand in the worker: of a journal, of a scene or grid, or of a session that the browser keeps.
import { HandSource } from "../hand/hand_source";
import { Keeper } from "../kept/keeper";
import { KeptSand, type KeptSession, type KeptState } from "../kept/kept_sand";
import { JournalSource } from "../replica/journal_source";
import { Keyframes } from "../replica/keyframes";
import type { DigMessage, OpenMessage, StartMessage, ToWorker } from "../replica/messages";
import type { Replica } from "../replica/replica";
import type { Stage, StepSource } from "../replica/step_source";
import { computeKept, newSession, sceneNamed } from "./sessions";

/** What beginnings use of the worker. */
export interface BeginningStage extends Stage {
    /** Other sand is shown from now on. Its steps come from `next`; without it, nothing works. */
    begin(next?: StepSource): void;
    loaded(): Promise<Replica>;
}

/** Ends a beginning, because the person has chosen other sand meanwhile. */
class Superseded extends Error {}
/** Another tab has removed the sand. */
class Removed extends Error {}

export class Beginnings {
    private keyframes = new Keyframes();
    private keeper?: Keeper;              // of the session that is dug
    private letGo?: () => void;           // gives its lock back
    private isBetween = false;            // the replica has sand whose steps no source makes
    private current = "";                 // its id
    private asked = 0;                    // beginnings
    private running = 0;                  // number of the one that runs
    private readonly keeping: Promise<{ data?: KeptSand; why: string }>;

    constructor(private readonly stage: BeginningStage, open: () => Promise<KeptSand> = KeptSand.open) {
        this.keeping = open().then((data) => ({ data, why: "" }), (error: Error) => ({ data: undefined, why: error.message }));
    }

    /**
     * Returns how to begin as a message asks, or undefined if it asks for something else. The newest beginning counts: those
     * before it end, and do nothing if they have not begun. They are carried out one after the other.
     */
    take(message: ToWorker): (() => Promise<void>) | undefined {
        const beginning = this.beginningOf(message);
        if (!beginning) {
            return undefined;
        }
        const number = ++this.asked;
        return async () => {
            this.running = number;
            if (number === this.asked) {
                await beginning().catch((error) => this.refuse(error));
            }
        };
    }
    /** Ends the beginning that runs if there is a newer one. */
    private goOnIfNewest(): void {
        if (this.running !== this.asked) {
            throw new Superseded();
        }
    }
    /** A beginning was refused. The session before goes on. If that is gone, what it had is kept, and new sand of its scene follows. */
    private async refuse(error: Error): Promise<void> {
        if (error instanceof Superseded) {
            return;
        }
        if (this.isBetween) {
            const it = await this.stage.loaded();
            it.digAgain();
            await this.beginHand(it, newSession(it.session().name), this.tellDig(it, ""));
        }
        throw error;
    }
    private beginningOf(message: ToWorker): (() => Promise<void>) | undefined {
        if ("open" in message) {
            return () => this.open(message.open);
        } else if ("dig" in message) {
            return () => this.dig(message.dig);
        } else if ("start" in message) {
            return () => this.startWith(message.start);
        } else if ("again" in message) {
            return () => this.again();
        } else if ("goOn" in message) {
            return () => this.goOnWith(message.goOn);
        }
        return undefined;
    }

    /** Keeps the newest sand of the present session, as far as the browser does. */
    private async flush(): Promise<void> { await this.keeper?.flush(await this.stage.loaded()); }
    /** Ends the session, because the replica has other sand. */
    private end(): void {
        this.keeper?.end();
        this.keeper = undefined;
        this.letGo?.();
        this.letGo = undefined;
        this.begin();
    }
    private begin(next?: StepSource): void {
        this.isBetween = next === undefined;
        this.stage.begin(next);
    }

    private async open({ name, address, parts }: OpenMessage): Promise<void> {
        const it = await this.stage.loaded();
        await this.flush();
        it.open(name, parts);
        this.end();
        const opened = it.session();
        this.begin(new JournalSource(it, opened, this.keyframes, this.stage));
        this.stage.tell({ kind: "session", address, ...opened });
    }

    /** Tells the page about the sand that the replica has now. */
    private tellDig(it: Replica, note: string, since?: number): number {
        this.keyframes = new Keyframes();  // digging needs no memory for states
        const begun = it.session();
        this.stage.tell({ kind: "dig", ...begun, words: it.words, sceneMaterial: it.sceneMaterial, since, note });
        return begun.stepsPerSecond;
    }
    /** Lets the hand dig in the sand of a session. */
    private async beginHand(it: Replica, session: KeptSession, stepsPerSecond: number, bytes?: ArrayBuffer): Promise<void> {
        const { data, why } = await this.keeping;
        this.letGo ??= await data?.hold(session.id);
        this.keeper = new Keeper(data, why, session, stepsPerSecond, (now) => {
            this.stage.tell({ kind: "keeping", ...now });
            if (now.kept.step > 0) {
                void this.tellSessions();
            }
        });
        if (bytes) {
            this.keeper.goOn(it, bytes);
        }
        this.begin(new HandSource(it, stepsPerSecond, this.stage, this.keeper));
        this.stage.tell({ kind: "hand", step: it.step, hash: it.hash });
        this.current = session.id;
        await this.tellSessions();
    }
    private async tellSessions(): Promise<void> {
        const { data } = await this.keeping;
        try {
            this.stage.tell({ kind: "sessions", sessions: (await data?.list()) ?? [], current: this.current });
        } catch {
            // The browser has closed the database. The next piece says so.
        }
    }

    /** Begins with new sand. */
    private async dig({ name, file }: DigMessage, note = "", scene = file ? undefined : sceneNamed(name)): Promise<void> {
        const it = await this.stage.loaded();
        if (file) {
            // The header says whether the sand fits, before all of a large file is read.
            it.checkGrid(name, await file.slice(0, 1 << 16).arrayBuffer(), file.size);
        }
        const bytes = await (scene ?? file!.arrayBuffer());
        await this.flush();
        this.goOnIfNewest();
        it.dig(name, bytes, scene !== undefined);
        this.end();
        await this.beginHand(it, newSession(it.session().name), this.tellDig(it, note));
    }
    private async again(): Promise<void> {
        const it = await this.stage.loaded();
        await this.flush();
        it.digAgain();
        this.end();
        await this.beginHand(it, newSession(it.session().name), this.tellDig(it, ""));
    }

    /** Goes on with a kept session. Throws a sentence if another tab has it, or if it cannot be read. */
    private async goOn({ id, name }: KeptSession): Promise<void> {
        const it = await this.stage.loaded(), data = (await this.keeping).data!;
        const held = await data.hold(id);
        if (!held) {
            throw new Error(`Another tab digs in the kept sand of ${name}.`);
        }
        let stepsPerSecond = 0;
        const from = async (session: KeptSession, bytes: ArrayBuffer, state?: KeptState) => {
            it.return(name, bytes.slice(0), state);
            this.end();
            stepsPerSecond = this.tellDig(it, "", session.changed);
            this.stage.show();  // the sand of the scene, of which the page makes the box and the difference to the start
            await computeKept(it, session, stepsPerSecond, (text) => this.stage.tell({ kind: "note", text }), () => this.goOnIfNewest());
        };
        let kept: { session: KeptSession; bytes: ArrayBuffer };
        try {
            const read = await data.read(id);
            if (!read) {
                throw new Removed(`The kept sand of ${name} was removed in another tab.`);
            }
            kept = read;
            const { session, bytes, state } = read;
            await this.flush();
            this.goOnIfNewest();
            await from(session, bytes, state).catch((error) => {
                if (!state || error instanceof Superseded) {
                    throw error;
                }
                return from(session, bytes);  // the state may be damaged
            });
        } catch (error) {
            held();
            throw error;
        }
        const shortcoming = it.session().shortcoming;
        if (shortcoming === "") {
            this.letGo = held;
            await this.beginHand(it, kept.session, stepsPerSecond, kept.bytes);
        } else {
            held();
            await this.beginHand(it, newSession(name), stepsPerSecond);
            this.stage.tell({ kind: "note", text: `The kept sand of ${name} continues up to here, as a session of its own: ${shortcoming}.` });
        }
    }
    /** Begins with the newest kept sand, or with new sand. */
    private async startWith({ scene, only, mine }: StartMessage): Promise<void> {
        const fetched = sceneNamed(scene);
        fetched.catch(() => {});  // it may not be needed
        let note = "";
        try {
            const listed = ((await (await this.keeping).data?.list()) ?? []).filter(({ name }) => !only || name === scene);
            const newest = listed.find(({ id }) => id === mine) ?? listed[0];
            if (newest) {
                return await this.goOn(newest);
            }
        } catch (error) {
            this.goOnIfNewest();
            note = `${(error as Error).message.replace(/\.?$/, ".")} This tab has new sand${error instanceof Removed ? "" : ", and the other stays"}.`;
        }
        await this.dig({ name: scene }, note, fetched);
    }
    private async goOnWith(id: string): Promise<void> {
        const session = (await (await this.keeping).data?.list())?.find((listed) => listed.id === id);
        if (!session || (id === this.current && this.keeper)) {
            return;
        }
        await this.goOn(session);
    }
    /** Removes a kept session, whatever begins meanwhile. */
    async forget(id: string): Promise<void> {
        if (await (await this.keeping).data?.remove(id)) {
            await this.tellSessions();
        } else {
            this.stage.tell({ kind: "note", text: "A tab digs in this sand, so it stays." });
        }
    }
}
