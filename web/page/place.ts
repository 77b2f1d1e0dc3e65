// SPDX-License-Identifier: Apache-2.0
// The place of the sand under the pointer: its height, and a double click or tap that goes near to it.
import type { View } from "../drawing/view";
import type { PlaceMessage, ToWorker } from "../replica/messages";

const shown = document.getElementById("height")!;

export class PlaceUnderPointer {
    private waits = false;  // for the worker's answer
    private next?: [number, number];  // place in the window that the pointer has reached meanwhile
    private cell = 1;       // scene unit

    constructor(canvas: HTMLCanvasElement, private readonly view: View, private readonly tell: (message: ToWorker) => void) {
        canvas.addEventListener("pointermove", ({ clientX, clientY }) => this.look(clientX, clientY, false));
        canvas.addEventListener("pointerleave", () => {
            this.next = undefined;
            shown.textContent = "";
        });
    }

    begin(cell: number): void {
        this.cell = cell;
        this.waits = false;
        this.next = undefined;
        shown.textContent = "";
    }
    /** Asks for the place at a place in the window, and goes near to it if `near`. */
    look(clientX: number, clientY: number, near: boolean): void {
        if (this.waits && !near) {
            this.next = [clientX, clientY];
        } else if (this.view.ready) {
            this.waits = true;
            this.next = undefined;
            this.tell({ look: this.view.sightThrough(clientX, clientY), near });
        }
    }
    take({ place, near }: PlaceMessage): void {
        this.waits = false;
        const digits = Math.max(0, Math.ceil(1 - Math.log10(this.cell)));  // a tenth of a cell
        shown.textContent = place ? `height ${place[2].toFixed(Math.min(digits, 6))}` : "";
        document.body.dataset.height = shown.textContent;
        if (near && place) {
            this.view.goNear(place[0], place[1], place[3]);
        }
        if (this.next) {
            this.look(...this.next, false);
        }
    }
}
