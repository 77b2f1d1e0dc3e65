// SPDX-License-Identifier: Apache-2.0
// The controls for digging: the scene, the tool, the material, edits, and saving.
import type { DigBegunMessage, DugMessage, Material, MaterialMessage, Notched, ToHand, Tool, Words } from "../replica/messages";
import { showOthers } from "./others";

declare const SCENES: string[];  // names of the encoded scenes, which web/build.mjs lists

// What the numbers of a material mean, beside the technical word.
const kPlain: Record<string, string> = {
    talus: "steepness, in degrees", "wet-talus": "steepness when wet, in degrees", humidity: "wetness, 0 to 1", cohesion: "height of an upright wet bank",
    band: "how much steeper sand at rest can be", "settling-time": "time to rest, in s",
};

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const input = (id: string) => element<HTMLInputElement>(id), choice = (id: string) => element<HTMLSelectElement>(id);

export class DigPanel {
    private words?: Words;
    private material?: MaterialMessage;
    private ofScene?: Material;

    /**
     * `tell` passes a message on to the hand. `open` opens new sand of the scene of that name, and `again` that of the present
     * scene. The sand before is kept, as an edit would not keep it.
     */
    constructor(private readonly tell: (message: ToHand) => void, open: (scene: string) => void, private readonly again: () => void) {
        choice("scene").append(...SCENES.map((name) => new Option(name)));
        element("dig").onclick = () => open(choice("scene").value);
        choice("tool").onchange = () => this.change("kind", choice("tool").value);
        element("larger").onclick = () => this.changeBy("size", 1);
        element("smaller").onclick = () => this.changeBy("size", -1);
        input("depth").oninput = () => this.setDepth(input("depth").valueAsNumber);
        input("width").onchange = () => this.whenNumber("width", (width) => this.change("width", width));
        input("heading").onchange = () => this.whenNumber("heading", (heading) => this.change("heading", heading));
        choice("foot").onchange = () => this.change("foot", choice("foot").value);
        choice("word").onchange = () => this.showNumber();
        input("number").onchange = () => this.whenNumber("number", (value) => tell({ material: choice("word").value, value }));
        element("save").onclick = () => tell({ save: true });
    }

    /** The scene that the list says. */
    set scene(name: string) {
        if (SCENES.includes(name)) {
            choice("scene").value = name;
        }
    }

    private change(part: keyof Tool, value: string | number): void { this.tell({ tool: part, value: String(value) }); }
    private showDepth(depth: number): void {
        input("depth").value = String(+depth.toFixed(6));
        element("depth").setAttribute("aria-valuetext", `${Math.round(100 * depth)} % of the radius`);
    }
    private setDepth(depth: number): void {
        this.showDepth(depth);
        this.tell({ depth });
    }

    // What keys and the wheel change

    chooseTool(index: number): void {
        if (this.words && index < this.words.tools.length) {
            this.change("kind", this.words.tools[index]);
        }
    }
    /** Makes the tool larger or the sand wetter, or turns the tool to the left, by notches. Negative ones do the opposite. */
    changeBy(of: Notched, notches: number): void { this.tell({ of, notches }); }
    /** Gives new sand a tool with which a person sees what they dig, by an edit. */
    beginLargeEnough(): void { this.tell({ enlarge: true }); }
    deepen(notches: number): void {
        const { lowest, highest, notch } = this.words!.depth;
        this.setDepth(Math.min(Math.max(input("depth").valueAsNumber + notch * notches, lowest), highest));
    }
    /** Gives tool and humidity of the scene back, and the usual depth. */
    restoreTool(): void {
        for (const [part, value] of Object.entries(this.ofScene!.tool)) {
            this.change(part as keyof Tool, value);
        }
        this.tell({ material: "humidity", value: this.ofScene!.material.humidity });
        this.setDepth(this.words!.depth.usual);
    }

    private whenNumber(id: string, use: (number: number) => void): void {
        if (Number.isFinite(input(id).valueAsNumber)) {
            use(input(id).valueAsNumber);
        }
    }
    private showNumber(): void {
        const { word, lowest, highest } = this.words!.material[choice("word").selectedIndex];
        Object.assign(input("number"), { min: lowest, max: highest, value: +this.material!.material[word].toPrecision(6) });
    }

    /** Fills the controls with what a hand can choose. An edit without a button gets one. */
    private offer(words: Words): void {
        this.words = words;
        choice("tool").replaceChildren(...words.tools.map((name) => new Option(name)));
        choice("word").replaceChildren(...words.material.map(({ word }) => new Option(kPlain[word] ? `${kPlain[word]} (${word})` : word, word)));
        for (const edit of words.edits) {
            (document.getElementById(edit) ?? this.added(edit)).onclick = edit === "reset" ? () => this.again() : () => this.tell({ edit });
        }
        const { lowest, highest, notch } = words.depth;
        Object.assign(input("depth"), { min: lowest, max: highest, step: notch });
        showOthers("words", words, ["tools", "material", "edits", "depth"]);
    }
    private added(edit: string): HTMLElement {
        const button = Object.assign(document.createElement("button"), { id: edit, textContent: edit });
        element("save").before(button);
        return button;
    }

    /** Shows or hides the controls of a hand. */
    begin(sand: DigBegunMessage | undefined): void {
        document.body.classList.toggle("digging", sand !== undefined);
        if (sand) {
            if (!this.words) {
                this.offer(sand.words);
            }
            this.scene = sand.name;
            this.ofScene = sand.sceneMaterial;
            this.showDepth(sand.words.depth.usual);
            this.offerReturns(false, false);
        }
    }
    showMaterial(message: MaterialMessage): void {
        this.material = message;
        const { kind, radius, width = 1, heading = 0, foot = "right" } = message.tool;
        choice("tool").value = kind;
        element("size").textContent = `Radius ${radius.toPrecision(3)}`;
        input("heading").value = String(+heading.toFixed(1));
        input("width").value = String(+width.toPrecision(3));
        choice("foot").value = foot;
        for (const part of ["width", "heading", "foot"]) {
            input(part).disabled = !(part in message.tool);
        }
        this.showNumber();
        showOthers("hand", message, ["kind", "material", "tool"]);
        showOthers("tool", message.tool, ["kind", "radius", "width", "heading", "foot"]);
    }
    showStep({ undo, redo }: DugMessage): void { this.offerReturns(undo, redo); }
    private offerReturns(undo: boolean, redo: boolean): void {
        element<HTMLButtonElement>("undo").disabled = !undo;
        element<HTMLButtonElement>("redo").disabled = !redo;
    }
}
