// SPDX-License-Identifier: Apache-2.0
// The eye of the person at the page: where it is, and how mouse, pen, fingers and keys move it.
import { MOUSE, PerspectiveCamera, TOUCH } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

export class Eye {
    readonly camera = new PerspectiveCamera(35, 1, 0.02, 20);
    private readonly controls: OrbitControls;
    private given = false;

    /** `moved` is called whenever the eye has moved. */
    constructor(private readonly canvas: HTMLCanvasElement, moved: () => void) {
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.listenToKeyEvents(canvas as unknown as HTMLElement);
        this.controls.addEventListener("change", moved);
        this.controls.maxDistance = 3;
        this.controls.minDistance = 0.1;
        this.controls.maxPolarAngle = Math.PI * 85 / 180;
        canvas.addEventListener("keydown", (event) => this.key(event));
    }

    private key(event: KeyboardEvent): void {
        const nearer = { "+": 0.87, "=": 0.87, "-": 1.15 }[event.key];
        if (event.ctrlKey || event.metaKey || event.altKey || (nearer === undefined && event.key !== "Home")) {
            return;
        }
        event.preventDefault();
        if (nearer === undefined) {
            this.lookAtAll();
        } else {
            this.camera.position.sub(this.controls.target).multiplyScalar(nearer).add(this.controls.target);
            this.controls.update();
        }
    }
    private lookAtAll(): void {
        const far = Math.max(1, 1.3 * this.canvas.clientHeight / this.canvas.clientWidth);  // a narrow screen needs a greater distance
        this.controls.target.set(0, 0, 0);
        this.camera.position.set(0, 0.55 * far, 0.62 * far);
        this.controls.update();
    }
    /** Looks at all of another sand, unless the places of the eye were given for it. */
    begin(): void {
        if (!this.given) {
            this.lookAtAll();
        }
        this.given = false;  // they are for the first sand alone
    }

    /** The eye and the place that it looks at [m], from the middle of the sand: x right, y up, z towards the viewer. */
    get places(): number[] { return [...this.camera.position.toArray(), ...this.controls.target.toArray()]; }
    set places(places: number[]) {
        this.given = true;
        this.camera.position.fromArray(places);
        this.controls.target.fromArray(places, 3);
        this.controls.update();
    }

    /** The left button and one finger dig; the other buttons and two fingers move the eye. */
    set digging(on: boolean) {
        const { mouseButtons, touches } = this.controls;
        Object.assign(mouseButtons, on ? { LEFT: null, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.ROTATE } : { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN });
        touches.ONE = on ? null : TOUCH.ROTATE;
        touches.TWO = on ? TOUCH.DOLLY_ROTATE : TOUCH.DOLLY_PAN;
    }

    resize(width: number, height: number): void {
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
    }
}
