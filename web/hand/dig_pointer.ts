// SPDX-License-Identifier: Apache-2.0
// Reads the pointer over the sand: mouse, pen or first finger. The worker finds the place of the sand under it.
import type { View } from "../drawing/view";
import { kReadingNumbers } from "../replica/messages";

const kMostPlaces = 6;      // between two readings of a stroke, as in the report of a wall's pointer
const kNear = 4;            // CSS pixels
// Between two motions of a usual mouse. A pointer that rested began to move just before its first motion was read. The
// time at which it came to rest would put the places far apart in time, and the hand would lift the tool.
const kMotionMs = 8;
// The fingers of two do not touch the screen at once. So a finger digs when no second one has come in this time, or when
// it has moved so far. A mouse and a pen dig at once when they move; a click waits for a second one.
const kSecondFingerMs = 100;
const kFarPixels = 10, kFarPixelsOfMouse = 3;
const kHeldMs = 200;        // a mouse that is pressed so long without a motion digs
const kDoubleMs = 280, kDoublePixels = 24;  // between two taps or clicks that go near

/** The distance of two events in the window. */
const far = (a: PointerEvent, b: PointerEvent) => Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);

interface Reading {
    ms: number;
    x: number;
    y: number;
    pressed: boolean;
}

export class DigPointer {
    private before?: Reading;
    private pressedBy?: number;  // pointerId
    private waiting?: { event: PointerEvent; timer: number };  // for a second finger or a motion
    private tapped?: { event: PointerEvent; timer: number };   // a tap that waits for a second one

    /** `send` gets the readings of an event, in the order of time. `near` gets the place of a double tap or click. */
    constructor(private readonly canvas: HTMLCanvasElement, private readonly view: View, private readonly send: (readings: Float64Array) => void,
                private readonly digs: () => boolean, private readonly near: (clientX: number, clientY: number) => void) {
        canvas.addEventListener("pointerdown", (event) => this.down(event));
        canvas.addEventListener("pointermove", (event) => this.move(event));
        canvas.addEventListener("pointerup", (event) => this.up(event));
        canvas.addEventListener("pointercancel", (event) => this.up(event));
        // A pointer that is unplugged, or a button that is released while another window or a menu has the pointer, may
        // send none of these.
        canvas.addEventListener("lostpointercapture", (event) => event.pointerId === this.pressedBy && this.letGo());
        addEventListener("blur", () => this.letGo());
        document.addEventListener("visibilitychange", () => this.letGo());
    }

    private down(event: PointerEvent): void {
        if (!this.digs()) {
            return;
        }
        if (event.isPrimary && event.button === 0) {
            this.canvas.setPointerCapture(event.pointerId);
            const first = this.tapped;
            this.cancelTap();
            if (first && far(first.event, event) < kDoublePixels) {
                this.near(event.clientX, event.clientY);
                return;
            }
            if (first) {
                this.dig(first.event);  // another place
            }
            const ms = event.pointerType === "touch" ? kSecondFingerMs : kHeldMs;
            this.waiting = { event, timer: window.setTimeout(() => this.press(performance.now()), ms) };
        } else if (event.pointerType === "touch") {
            this.cancelWaiting();  // two fingers move the view
            if (this.pressedBy !== undefined) {
                this.pressedBy = undefined;
                this.take([event], false);
            }
        }
    }
    /** Presses the finger that waits, at the place that it touched. */
    private press(ms: number): void {
        const { event } = this.waiting!;
        this.cancelWaiting();
        this.pressedBy = event.pointerId;
        this.takeReadings([{ ms: ms - kMotionMs, x: event.clientX, y: event.clientY, pressed: true }]);
    }
    /** Digs with a tap that stayed alone. */
    private dig(event: PointerEvent): void {
        this.cancelTap();
        const { clientX: x, clientY: y } = event, ms = performance.now();
        this.takeReadings([{ ms: ms - 2 * kMotionMs, x, y, pressed: true }, { ms, x, y, pressed: false }]);
    }
    private cancelTap(): void {
        clearTimeout(this.tapped?.timer);
        this.tapped = undefined;
    }
    private cancelWaiting(): void {
        clearTimeout(this.waiting?.timer);
        this.waiting = undefined;
    }

    /** Lifts the tool where it is. Returns false if it is not pressed. */
    lift(): boolean {
        const pressed = this.pressedBy !== undefined || this.waiting !== undefined;
        this.letGo();
        return pressed;
    }
    private letGo(): void {
        this.cancelWaiting();
        if (this.pressedBy !== undefined) {
            this.pressedBy = undefined;
            this.takeReadings([{ ...this.before!, ms: performance.now(), pressed: false }]);
        }
    }

    private move(event: PointerEvent): void {
        if (event.pointerId === this.pressedBy && (event.buttons & 1) === 0) {
            this.letGo();  // its release was lost
        }
        const first = this.waiting?.event;
        if (first && event.pointerId === first.pointerId) {
            if ((event.buttons & 1) === 0) {
                this.cancelWaiting();  // its release was lost
                return;
            }
            if (far(first, event) < (event.pointerType === "touch" ? kFarPixels : kFarPixelsOfMouse)) {
                return;
            }
            this.press(event.timeStamp);
        }
        if (!this.digs() || !event.isPrimary || (event.buttons !== 0 && this.pressedBy === undefined)) {
            return;  // a drag of the view
        }
        const all = event.getCoalescedEvents?.() ?? [];
        this.take(all.length > 0 ? all : [event], this.pressedBy === event.pointerId);
    }
    private up(event: PointerEvent): void {
        if (event.pointerId === this.waiting?.event.pointerId) {
            const { event: first } = this.waiting!;
            this.cancelWaiting();
            if (event.type !== "pointercancel") {
                this.tapped = { event: first, timer: window.setTimeout(() => this.dig(first), kDoubleMs) };
            }
        }
        if (event.pointerId === this.pressedBy && (event.type === "pointercancel" || (event.buttons & 1) === 0)) {
            this.pressedBy = undefined;
            this.take([event], false);
        }
    }

    private take(events: PointerEvent[], pressed: boolean): void {
        this.takeReadings(events.map(({ timeStamp, clientX, clientY }) => ({ ms: timeStamp, x: clientX, y: clientY, pressed })));
    }
    private takeReadings(readings: Reading[]): void {
        const numbers: number[] = [];
        for (const reading of readings) {
            this.between(reading, numbers);
            this.add(reading, numbers);
            this.before = reading;
        }
        this.send(new Float64Array(numbers));
    }

    /** Adds places between two far readings of a stroke, so that the tool follows dunes also under a fast pointer. */
    private between(now: Reading, numbers: number[]): void {
        const before = this.before;
        if (!before?.pressed || !now.pressed) {
            return;
        }
        const from = Math.max(before.ms, now.ms - kMotionMs);
        const parts = Math.min(kMostPlaces, Math.ceil(Math.hypot(now.x - before.x, now.y - before.y) / kNear));
        for (let i = 1; i < parts; ++i) {
            const at = (a: number, b: number) => a + (b - a) * i / parts;
            this.add({ ms: at(from, now.ms), x: at(before.x, now.x), y: at(before.y, now.y), pressed: true }, numbers);
        }
    }

    private add({ ms, x, y, pressed }: Reading, numbers: number[]): void {
        numbers.push(ms, ...this.view.sightThrough(x, y), pressed ? 1 : 0);
        console.assert(numbers.length % kReadingNumbers === 0);
    }
}
