// SPDX-License-Identifier: Apache-2.0
// What a person takes away from the page: a picture, heights, a link to a moment, and the journal of what was dug.
import type { View } from "../drawing/view";
import { type FrameMessage, kUnitsPerCell, type SandMessage } from "../replica/messages";
import { sayThis } from "./say";

const button = (id: string) => document.getElementById(id) as HTMLButtonElement;

/** Offers a file to the person. */
export function save(blob: Blob, name: string): void {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Returns the heights as an ESRI ASCII grid in scene units, with its rows from the north. */
function asciiGrid(of: SandMessage, heights: Int32Array): string {
    const lines = [`ncols ${of.columns}`, `nrows ${of.rows}`, "xllcorner 0", "yllcorner 0", `cellsize ${of.cell}`];
    for (let y = of.rows - 1; y >= 0; --y) {
        lines.push(Array.from(heights.subarray(y * of.columns, (y + 1) * of.columns), (height) => height * of.cell / kUnitsPerCell).join(" "));
    }
    return lines.join("\n") + "\n";
}

/** Returns the eye's places as the address of a page has them. */
export const textOfEye = (view: View) => view.eye.places.map((n) => n.toFixed(4)).join(",");

/** The buttons for results. */
export class Results {
    private sand?: SandMessage;
    private frame?: FrameMessage;
    private address = "";     // of the journal

    constructor(canvas: HTMLCanvasElement, private readonly view: View | undefined) {
        button("picture").onclick = () => canvas.toBlob((blob) => {
            if (blob) {
                save(blob, `${this.sand!.name}_${this.frame!.step}.png`);
            }
        });
        button("heights").onclick = () => {
            if (this.frame?.heights) {
                save(new Blob([asciiGrid(this.sand!, this.frame.heights)], { type: "text/plain" }), `${this.sand!.name}_${this.frame.step}.asc`);
            }
        };
        button("link").onclick = () => void this.link();
    }

    /** `address` is that of a journal that was fetched; empty if there is none. */
    begin(sand: SandMessage, address: string): void {
        this.sand = sand;
        this.frame = undefined;
        this.address = address;
        button("heights").disabled = !sand.hasHeights;
        button("picture").disabled = this.view === undefined;
        button("link").disabled = address === "";
    }
    show(frame: FrameMessage): void { this.frame = frame; }

    private async link(): Promise<void> {
        const eye = this.view ? `&view=${textOfEye(this.view)}` : "";
        const link = `${location.origin}${location.pathname}?journal=${encodeURIComponent(this.address)}&step=${this.frame?.step ?? 0}${eye}`;
        history.replaceState(null, "", link);
        try {
            await navigator.clipboard.writeText(link);
            sayThis("The link to this moment is copied.");
        } catch {
            sayThis("The address of this page is now the link to this moment.");
        }
    }
}
