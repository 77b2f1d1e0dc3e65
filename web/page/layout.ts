// SPDX-License-Identifier: Apache-2.0
// What is shown over the sand: the drawer, the help, and the first invitation. And full screen.
import { helpTable } from "./key_list";

const element = (id: string) => document.getElementById(id)!;
const canvas = element("sand"), drawer = element("drawer"), help = element("help"), more = element("more"), full = element("full");

export class Layout {
    /** `open` begins new sand of a scene. */
    constructor(open: (scene: string) => void) {
        more.onclick = () => this.showDrawer(drawer.hidden);
        element("keys").onclick = () => this.showHelp(true);
        full.onclick = () => void (document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen());
        full.hidden = !document.fullscreenEnabled;
        document.addEventListener("fullscreenchange", () => full.setAttribute("aria-label", document.fullscreenElement ? "Leave full screen" : "Full screen"));
        help.onclick = () => this.showHelp(false);
        for (const button of element("scenes").querySelectorAll("button")) {
            button.onclick = () => open(button.dataset.scene!);
        }
        // The drawer is closed by a touch of the sand, which then digs.
        canvas.addEventListener("pointerdown", () => this.showDrawer(false));
        for (const touch of ["pointerdown", "keydown"]) {
            document.addEventListener(touch, (event) => {
                if (!element("scenes").contains(event.target as Node)) {
                    this.invite(false);
                }
            }, { capture: true });
        }
    }

    /** Shows a stroke that nobody draws, and pictures of scenes, until the first touch. */
    invite(on: boolean): void { document.body.classList.toggle("inviting", on); }
    showDrawer(on: boolean): void {
        drawer.hidden = !on;
        more.setAttribute("aria-expanded", String(on));
    }
    showHelp(on: boolean): void {
        if (on) {
            help.replaceChildren(helpTable());
            help.hidden = false;
            help.focus();
        } else if (!help.hidden) {
            help.hidden = true;
            canvas.focus();
        }
    }
    get helps(): boolean { return !help.hidden; }
    showDetails(): void {
        const details = element("details") as HTMLDetailsElement, shown = details.open && !drawer.hidden;
        details.open = !shown;
        this.showDrawer(!shown);
        details.scrollIntoView();
    }
    /** Closes what is open: the help, or else the drawer. Returns false if nothing was. */
    close(): boolean {
        const open = this.helps || !drawer.hidden;
        if (this.helps) {
            this.showHelp(false);
        } else if (!drawer.hidden) {
            this.showDrawer(false);
            canvas.focus();
        }
        return open;
    }
}
