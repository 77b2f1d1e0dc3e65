// SPDX-License-Identifier: Apache-2.0
// The eye of the person at the page: where it is, and how mouse, pen, fingers and keys move it.
import { MOUSE, PerspectiveCamera, TOUCH, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const kNearest = 0.12, kNearer = 0.45;  // [m], and share of the distance, for goNear()

const kUpright = 0.9;        // width over height of a picture that shows more of the sand from above
const kFromTheSide = new Vector3(0, 0.55, 0.62), kFromAbove = new Vector3(0, 0.9, 0.42);
const kBoard = 0.02, kHigh = 0.05, kShare = 0.97;  // [m], around and above the sand, and the share of the picture for all of it

export class Eye {
    readonly camera = new PerspectiveCamera(35, 1, 0.02, 20);
    private readonly controls: OrbitControls;
    private given = false;
    private moved = false;      // whether a person has moved the eye since all was in view
    private width = 0.46;
    private depth = 0.46;

    /** `moved` is called whenever the eye has moved. */
    constructor(private readonly canvas: HTMLCanvasElement, moved: () => void) {
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.listenToKeyEvents(canvas as unknown as HTMLElement);
        this.controls.addEventListener("change", moved);
        this.controls.addEventListener("start", () => { this.moved = true; });
        this.controls.zoomToCursor = true;  // as in a window of the wall
        this.controls.maxDistance = 3;
        this.controls.minDistance = 0.1;
        this.controls.maxPolarAngle = Math.PI * 85 / 180;
    }

    /** Changes the distance by a factor. */
    approach(factor: number): void {
        this.moved = true;
        this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
        this.controls.update();
    }
    /** Looks at a place from the same side, at less than half of the distance. */
    goNear(place: Vector3): void {
        this.moved = true;
        const arm = this.camera.position.clone().sub(this.controls.target);
        arm.setLength(Math.max(kNearest, kNearer * arm.length()));
        this.controls.target.copy(place);
        this.camera.position.copy(place).add(arm);
        this.controls.update();
    }
    /** Looks at all of the sand. */
    lookAtAll(): void {
        const { camera } = this, side = camera.aspect < kUpright ? kFromAbove : kFromTheSide;
        const across = Math.tan(camera.fov * Math.PI / 360) * kShare, x = this.width / 2 + kBoard;
        const corners = [-kHigh, kHigh].flatMap((y) => [-1, 1].map((z) => new Vector3(0, y, z * (this.depth / 2 + kBoard))));
        const along = side.clone().normalize(), upwards = new Vector3(0, along.z, -along.y), target = new Vector3();
        let far = 0;
        // The nearer boards are larger, so all of the box is in the middle of the picture if the eye looks at a nearer place.
        for (let step = 0.1; step > 0.0005; step /= 2) {
            const from = corners.map((corner) => corner.clone().sub(target));
            far = Math.max(...from.map((corner) => corner.dot(along) + Math.max(x / (across * camera.aspect), Math.abs(corner.dot(upwards)) / across)));
            const heights = from.map((corner) => corner.dot(upwards) / (far - corner.dot(along)));
            target.z += Math.max(...heights) + Math.min(...heights) < 0 ? step : -step;
        }
        this.controls.target.copy(target);
        camera.position.copy(target).addScaledVector(along, far);
        this.moved = false;
        this.controls.update();
    }
    /** Looks at all of another sand [m], unless the places of the eye were given for it. */
    begin(width: number, depth: number): void {
        Object.assign(this, { width, depth });
        if (!this.given) {
            this.lookAtAll();
        }
        this.given = false;  // they are for the first sand alone
    }

    /** The eye and the place that it looks at [m], from the middle of the sand: x right, y up, z towards the viewer. */
    get places(): number[] { return [...this.camera.position.toArray(), ...this.controls.target.toArray()]; }
    set places(places: number[]) {
        this.given = this.moved = true;
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
        if (!this.moved) {
            this.lookAtAll();  // a phone that is turned, or a window of another size
        }
    }
}
