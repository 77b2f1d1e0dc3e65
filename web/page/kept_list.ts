// SPDX-License-Identifier: Apache-2.0
// The sessions that this browser keeps, as a list, and the question before sand is left that it does not keep.
import { timeOf } from "../kept/keeper";
import type { KeepingMessage, SessionsMessage, ToWorker } from "../replica/messages";
import { sayThis } from "./say";

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const list = element<HTMLSelectElement>("kept"), goOn = element<HTMLButtonElement>("goOn"), forget = element<HTMLButtonElement>("forget");
const kMine = "sandwall session";  // key of the session that this tab had last

/** Returns when a session was dug last, as short as a list on a phone needs it. */
function shortTimeOf(ms: number): string {
    const then = new Date(ms), day = then.getFullYear() === new Date().getFullYear() ? { month: "short", day: "numeric" } as const : { dateStyle: "medium" } as const;
    return `${then.toLocaleDateString(undefined, day)}, ${then.toLocaleTimeString(undefined, { timeStyle: "short" })}`;
}

export class KeptList {
    private unkept = false;
    private why = "";       // why sand is not kept; empty if it is

    constructor(tell: (message: ToWorker) => void) {
        goOn.onclick = () => this.mayLeave() && tell({ goOn: list.value });
        forget.onclick = () => {
            if (confirm(`Remove the kept sand ${list.selectedOptions[0].text}? It cannot be brought back.`)) {
                tell({ forget: list.value });
            }
        };
        addEventListener("beforeunload", (event) => {
            if (this.unkept) {
                event.preventDefault();
            }
        });
        document.addEventListener("visibilitychange", () => tell({ keep: true }));
    }

    /** Other sand has begun. */
    begin(): void {
        this.unkept = false;
        this.why = "";
        Object.assign(document.body.dataset, { unkept: false, keptStep: 0 });
        delete document.body.dataset.keptHash;
    }
    showKeeping({ id, unkept, why, kept, gone }: KeepingMessage): void {
        this.unkept = unkept;
        Object.assign(document.body.dataset, { unkept, keptStep: kept.step, keptHash: kept.hash });
        const sentences = [...gone];
        if (unkept && why !== "" && why !== this.why) {
            sentences.push(`This browser does not keep this sand: ${why.replace(/\.$/, "")}. Save the session before you leave.`);
        }
        this.why = unkept ? why : "";
        if (sentences.length > 0) {
            sayThis(sentences.join(" "), this.why !== "");
        }
        try {
            sessionStorage.setItem(kMine, id);
        } catch {
            // Without it a reload continues with the newest session.
        }
    }
    /** The session of this tab before a reload; empty if there was none. */
    get mine(): string {
        try {
            return sessionStorage.getItem(kMine) ?? "";
        } catch {
            return "";
        }
    }
    show({ sessions, current }: SessionsMessage): void {
        const chosen = list.value;
        list.replaceChildren(...sessions.map(({ id, name, changed, seconds }) => {
            return new Option(`${name}, ${id === current ? "this sand" : shortTimeOf(changed)}, ${seconds} s`, id);
        }));
        if (sessions.length === 0) {
            list.append(new Option("none yet", ""));
        }
        if (sessions.some(({ id }) => id === chosen)) {
            list.value = chosen;
        }
        list.disabled = goOn.disabled = forget.disabled = sessions.length === 0;
        document.body.dataset.keptSessions = String(sessions.length);
    }

    /** Asks before sand is left that is not kept. Returns whether it may be. */
    mayLeave(): boolean {
        return !this.unkept || confirm("This sand is not kept, and would be lost. Leave it?");
    }
}
