// SPDX-License-Identifier: Apache-2.0
// The sessions that this browser keeps: their journals in pieces, in IndexedDB. docs/security.md says who can read them.
// One tab at a time has a session: it holds a lock of the session's name.

export const kMostKept = 10;     // sessions
const kHandOverMs = 1500;        // in which a page that was left gives its lock back

/** A session in the list. */
export interface KeptSession {
    id: string;
    name: string;        // of its scene
    began: number;       // ms since 1970
    changed: number;     // ms since 1970
    seconds: number;     // of sand
}

/** A whole state of the sand, with which a session continues sooner. */
export interface KeptState {
    step: number;
    hash: string;
    bytes: ArrayBuffer;
}

/** What is written at once: all bytes of the journal from `offset` on, and a state if there is a new one. */
export interface Piece {
    offset: number;
    bytes: ArrayBuffer;
    state?: KeptState;
}

/** Returns the result of a request. */
function resultOf<Result>(request: IDBRequest<Result>): Promise<Result> {
    return new Promise((resolve, reject) => {
        request.onsuccess = () => resolve(request.result);
        request.onerror = () => reject(request.error);
    });
}
/** Waits until a transaction is on disk. */
function ended(transaction: IDBTransaction): Promise<void> {
    return new Promise((resolve, reject) => {
        transaction.oncomplete = () => resolve();
        transaction.onabort = () => reject(transaction.error ?? new Error("the browser has ended the write"));
    });
}
const lockOf = (id: string) => `sandwall sand ${id}`;
/** All pieces of a session from `offset` on. */
const piecesOf = (id: string, offset = 0) => IDBKeyRange.bound([id, offset], [id, Infinity]);

export class KeptSand {
    private constructor(private readonly data: IDBDatabase) {
        data.onversionchange = () => data.close();
    }

    /** Throws with a reason if this browser keeps nothing. */
    static async open(): Promise<KeptSand> {
        if (!navigator.locks) {
            throw new Error("it keeps sand only of pages from https and from this computer");
        }
        if (!globalThis.indexedDB) {
            throw new Error("it has no IndexedDB");
        }
        const request = indexedDB.open("sandwall", 1);
        request.onupgradeneeded = () => {
            request.result.createObjectStore("sessions", { keyPath: "id" });
            request.result.createObjectStore("pieces", { keyPath: ["id", "offset"] });
            request.result.createObjectStore("states", { keyPath: "id" });
        };
        return new KeptSand(await resultOf(request));
    }

    /** Returns all sessions, the newest first. */
    async list(): Promise<KeptSession[]> {
        const all: KeptSession[] = await resultOf(this.data.transaction("sessions").objectStore("sessions").getAll());
        return all.sort((a, b) => b.changed - a.changed);
    }

    /** Takes the lock of a session. Returns how to give it back, or undefined if another tab has it. */
    async hold(id: string): Promise<(() => void) | undefined> {
        return new Promise((resolve, reject) => {
            const patience = AbortSignal.timeout(kHandOverMs);
            navigator.locks.request(lockOf(id), { signal: patience }, () => new Promise<void>((release) => resolve(release)))
                .catch((error) => (patience.aborted ? resolve(undefined) : reject(error)));
        });
    }

    /** Returns a journal in its pieces, and the state if there is one. */
    async read(id: string): Promise<{ bytes: ArrayBuffer; state?: KeptState }> {
        const from = this.data.transaction(["pieces", "states"]);
        const [pieces, state] = await Promise.all([resultOf(from.objectStore("pieces").getAll(piecesOf(id))), resultOf(from.objectStore("states").get(id))]);
        return { bytes: await new Blob(pieces.map((piece) => piece.bytes)).arrayBuffer(), state };
    }

    /**
     * Writes a piece of a session, and drops what the session had from there on. A new session may be one too many: returns
     * the oldest ones that had to go. Throws if the browser refuses, and then nothing is changed.
     */
    async write(session: KeptSession, { offset, bytes, state }: Piece): Promise<KeptSession[]> {
        const held = new Set((await navigator.locks.query()).held?.map((lock) => lock.name));
        const to = this.data.transaction(["sessions", "pieces", "states"], "readwrite");
        const done = ended(to), gone: KeptSession[] = [];
        to.objectStore("pieces").delete(piecesOf(session.id, offset));
        to.objectStore("pieces").put({ id: session.id, offset, bytes });
        if (state) {
            to.objectStore("states").put({ id: session.id, ...state });
        }
        to.objectStore("sessions").put(session);
        const listed = to.objectStore("sessions").getAll();
        listed.onsuccess = () => {
            const old = (listed.result as KeptSession[]).filter(({ id }) => id !== session.id && !held.has(lockOf(id))).sort((a, b) => a.changed - b.changed);
            gone.push(...old.slice(0, Math.max(0, listed.result.length - kMostKept)));
            gone.forEach(({ id }) => this.removeIn(to, id));
        };
        await done;
        return gone;
    }

    /** Removes a session, which is not that of this tab or of another one. Returns whether it did. */
    async remove(id: string): Promise<boolean> {
        const found = await navigator.locks.request(lockOf(id), { ifAvailable: true }, async (lock) => {
            if (!lock) {
                return false;
            }
            const to = this.data.transaction(["sessions", "pieces", "states"], "readwrite"), done = ended(to);
            this.removeIn(to, id);
            await done;
            return true;
        });
        return found;
    }
    private removeIn(to: IDBTransaction, id: string): void {
        to.objectStore("sessions").delete(id);
        to.objectStore("states").delete(id);
        to.objectStore("pieces").delete(piecesOf(id));
    }
}
