// SPDX-License-Identifier: Apache-2.0
// The controls for digging: the scene, the tool, the material, edits, and saving.
import type { DugMessage, EditName, MaterialMessage, SandMessage, ToHand } from "./messages";

declare const SCENES: string[];  // names of the encoded scenes, which web/build.mjs lists

const kWider = 1.25;         // ratio of the tool's sizes, as for a wall's keys
const kShortest = 2, kLongest = 0.25;  // length of the tool: cells, and share of the field's shorter side
const kRoundKinds = 2;       // sphere and circle have neither width nor heading
const kFootprint = 5;

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const input = (id: string) => element<HTMLInputElement>(id), choice = (id: string) => element<HTMLSelectElement>(id);

export class DigPanel {
    private material?: MaterialMessage;
    private limits = { least: 0, most: Infinity };  // radius, scene unit

    /** `tell` passes a message on to the hand, and `open` opens the scene of that name. */
    constructor(private readonly tell: (message: ToHand) => void, open: (scene: string) => void) {
        choice("scene").append(...SCENES.map((name) => new Option(name)));
        choice("scene").value = "writing";
        element("dig").onclick = () => open(choice("scene").value);
        choice("tool").onchange = () => tell({ tool: { kind: choice("tool").selectedIndex } });
        element("larger").onclick = () => this.resize(kWider);
        element("smaller").onclick = () => this.resize(1 / kWider);
        input("depth").oninput = () => {
            element("depth").setAttribute("aria-valuetext", `${Math.round(100 * input("depth").valueAsNumber)} % of the radius`);
            tell({ depth: input("depth").valueAsNumber });
        };
        input("width").onchange = () => this.whenNumber("width", (width) => tell({ tool: { width } }));
        input("heading").onchange = () => this.whenNumber("heading", (heading) => tell({ tool: { heading } }));
        choice("foot").onchange = () => tell({ tool: { leftFoot: choice("foot").value === "left" } });
        for (const edit of ["undo", "settle", "reset"] as EditName[]) {
            element(edit).onclick = () => tell({ edit });
        }
        choice("word").onchange = () => this.showNumber();
        input("number").onchange = () => this.whenNumber("number", (value) => tell({ material: choice("word").value, value }));
        element("save").onclick = () => tell({ save: true });
    }

    private resize(factor: number): void {
        const radius = this.material!.tool.radius, { least, most } = this.limits;
        this.tell({ tool: { radius: Math.min(Math.max(radius * factor, Math.min(least, radius)), Math.max(most, radius)) } });
    }
    private whenNumber(id: string, use: (number: number) => void): void {
        if (Number.isFinite(input(id).valueAsNumber)) {
            use(input(id).valueAsNumber);
        }
    }
    private showNumber(): void {
        input("number").value = String(+this.material!.numbers[choice("word").value].toPrecision(6));
    }

    /** Shows or hides the controls of a hand. */
    begin(sand: SandMessage | undefined): void {
        document.body.classList.toggle("digging", sand !== undefined);
        if (sand) {
            this.limits = { least: kShortest * sand.cell / 2, most: kLongest * Math.min(sand.columns, sand.rows) * sand.cell / 2 };
            input("depth").value = "0.5";
            element<HTMLButtonElement>("undo").disabled = true;
        }
    }
    showMaterial(message: MaterialMessage): void {
        this.material = message;
        const { kind, radius, width, heading, leftFoot } = message.tool;
        choice("tool").selectedIndex = kind;
        element("size").textContent = `radius ${radius.toPrecision(3)}`;
        input("heading").value = String(+heading.toFixed(1));
        input("width").value = String(+width.toPrecision(3));
        input("width").disabled = input("heading").disabled = kind < kRoundKinds;
        choice("foot").value = leftFoot ? "left" : "right";
        choice("foot").disabled = kind !== kFootprint;
        this.showNumber();
    }
    showStep({ undo }: DugMessage): void { element<HTMLButtonElement>("undo").disabled = !undo; }
}
