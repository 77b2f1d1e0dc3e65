// SPDX-License-Identifier: Apache-2.0
// Obeys the keys of a wall's window, and the wheel with Shift and Ctrl.
import { findKey, type KeyAction } from "./key_list";

/** Does what a key asks for. `index` is the place of the key among those with this action. */
export type Act = (action: KeyAction, index: number) => void;
/** What a notch of the wheel changes: 1 towards the person, -1 away. */
export interface Wheel {
    depth(by: number): unknown;
    size(by: number): unknown;
}

/** Whether an element takes a key itself: a letter that is typed, or Space on a button. */
function takesKey({ target, key, ctrlKey, metaKey }: KeyboardEvent): boolean {
    if (!(target instanceof HTMLElement)) {
        return false;
    }
    if (ctrlKey || metaKey) {
        return target.matches("input[type=number]") && /^[yz]$/i.test(key);  // undoes what was typed
    }
    const moves = ["Home", "End", "PageUp", "PageDown"].includes(key);
    return (target.matches("input[type=number], select") && (key.length === 1 || moves))
        || (target.matches("input[type=range]") && (moves || key === "+" || key === "-"))
        || (key === " " && target.matches("button, summary, input"));
}

export class Keys {
    private controlIsDown = false;

    constructor(canvas: HTMLCanvasElement, act: Act, wheel: Wheel, private readonly digs: () => boolean) {
        document.addEventListener("keydown", (event) => {
            this.controlIsDown = event.ctrlKey;
            const found = findKey(event);
            if (found && !takesKey(event)) {
                event.preventDefault();  // also of a held key, which the browser would take otherwise
                if (found.acts) {
                    act(found.entry.action, found.index);
                }
            }
        });
        document.addEventListener("keyup", (event) => { this.controlIsDown = event.ctrlKey; });
        // A pinch on a touchpad is a wheel with Ctrl that nobody presses, and comes nearer.
        canvas.addEventListener("wheel", (event) => {
            const changesSize = event.ctrlKey && this.controlIsDown, notch = Math.sign(event.deltaY || event.deltaX);
            if (!this.digs() || !(changesSize || event.shiftKey)) {
                return;
            }
            event.preventDefault();
            event.stopImmediatePropagation();
            if (changesSize) {
                wheel.size(notch);
            } else {
                wheel.depth(notch);
            }
        }, { capture: true, passive: false });
    }
}
