// SPDX-License-Identifier: Apache-2.0
// The sessions that this browser keeps: their journals in pieces, in IndexedDB. docs/security.md says who can read them.
// One tab at a time has a session: it holds a lock of the session's name.

export const kMostKept = 10;     // sessions
const kHandOverMs = 1500;        // in which a page that was left gives its lock back
const kStores = ["sessions", "pieces", "states"];

/** A session in the list. */
export interface KeptSession {
    id: string;
    name: string;        // of its scene
    began: number;       // ms since 1970
    changed: number;     // ms since 1970
    seconds: number;     // of sand
    bytes?: number;      // of its journal
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

/** Says that the browser has no longer what a session has written before. All of its journal must be written again. */
export class LostSand extends Error {
    override readonly name = "LostSand";
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

/** Opens the database of the page's address. */
async function opened(): Promise<IDBDatabase> {
    const request = indexedDB.open("sandwall", 1);
    request.onupgradeneeded = () => {
        request.result.createObjectStore("sessions", { keyPath: "id" });
        request.result.createObjectStore("pieces", { keyPath: ["id", "offset"] });
        request.result.createObjectStore("states", { keyPath: "id" });
    };
    return resultOf(request);
}

export class KeptSand {
    private constructor(private data?: IDBDatabase) {}

    /** Throws with a reason if this browser keeps nothing. */
    static async open(): Promise<KeptSand> {
        if (!navigator.locks) {
            throw new Error("it keeps sand only of pages from https and from this computer");
        }
        if (!globalThis.indexedDB) {
            throw new Error("it has no IndexedDB");
        }
        const kept = new KeptSand();
        await kept.connect();
        return kept;
    }
    /** Opens the database, also after the browser or another page has closed it. */
    private async connect(): Promise<IDBDatabase> {
        if (!this.data) {
            const data = this.data = await opened();
            data.onversionchange = () => {
                data.close();
                this.forget(data);
            };
            data.onclose = () => this.forget(data);
        }
        return this.data;
    }
    private forget(data: IDBDatabase): void {
        if (this.data === data) {
            this.data = undefined;
        }
    }
    private async transaction(stores: string[], mode: IDBTransactionMode = "readonly"): Promise<IDBTransaction> {
        const data = await this.connect();
        try {
            return data.transaction(stores, mode);
        } catch (error) {
            if ((error as Error).name !== "InvalidStateError") {
                throw error;
            }
            this.forget(data);  // it was closed without an event
            return (await this.connect()).transaction(stores, mode);
        }
    }

    /** Returns all sessions, the newest first. */
    async list(): Promise<KeptSession[]> {
        const all: KeptSession[] = await resultOf((await this.transaction(["sessions"])).objectStore("sessions").getAll());
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

    /** Returns a session, its journal, and the state if there is one; undefined if the session was removed. */
    async read(id: string): Promise<{ session: KeptSession; bytes: ArrayBuffer; state?: KeptState } | undefined> {
        const from = await this.transaction(kStores), of = (store: string) => from.objectStore(store);
        const [session, pieces, state] = await Promise.all([resultOf(of("sessions").get(id)), resultOf(of("pieces").getAll(piecesOf(id))), resultOf(of("states").get(id))]);
        return session && { session, bytes: await new Blob(pieces.map((piece) => piece.bytes)).arrayBuffer(), state };
    }

    /**
     * Writes a piece of a session, and drops what the session had from there on. A new session may be one too many: returns
     * the oldest ones that had to go. Throws if the browser refuses, and then nothing is changed.
     */
    async write(session: KeptSession, { offset, bytes, state }: Piece): Promise<KeptSession[]> {
        const to = await this.transaction(kStores, "readwrite"), done = ended(to);
        if (offset > 0) {
            const before: KeptSession | undefined = await resultOf(to.objectStore("sessions").get(session.id));
            if (before?.bytes !== offset) {
                await done;
                throw new LostSand("the sand that was kept before is gone");
            }
        }
        to.objectStore("pieces").delete(piecesOf(session.id, offset));
        to.objectStore("pieces").put({ id: session.id, offset, bytes });
        if (state) {
            to.objectStore("states").put({ id: session.id, ...state });
        }
        to.objectStore("sessions").put({ ...session, bytes: offset + bytes.byteLength });
        await done;
        return this.removeOldest(session.id).catch(() => []);  // the piece is written; the next one tries again
    }
    /** Removes the oldest sessions beyond the limit. One that a tab has stays. Returns those that went. */
    private async removeOldest(mine: string): Promise<KeptSession[]> {
        const all = await this.list(), gone: KeptSession[] = [];
        for (const session of all.reverse()) {
            if (all.length - gone.length > kMostKept && session.id !== mine && await this.remove(session.id)) {
                gone.push(session);
            }
        }
        return gone;
    }

    /**
     * Removes a session, which is not that of this tab or of another one. Returns whether it did. A tab that takes the
     * session waits for the lock meanwhile, and finds it gone then.
     */
    async remove(id: string): Promise<boolean> {
        return navigator.locks.request(lockOf(id), { ifAvailable: true }, async (lock) => {
            if (!lock) {
                return false;
            }
            const to = await this.transaction(kStores, "readwrite"), done = ended(to);
            to.objectStore("sessions").delete(id);
            to.objectStore("states").delete(id);
            to.objectStore("pieces").delete(piecesOf(id));
            await done;
            return true;
        });
    }
}
