// SPDX-License-Identifier: Apache-2.0
// Shows values for which the page has no place, so that it leaves out nothing that C++ describes.
const shown = new Map<string, string[]>();

/** Shows the members of `values` that are not `known`, by their names. They replace the ones of `whose` before. */
export function showOthers(whose: string, values: object, known: string[]): void {
    const others = Object.entries(values).filter(([name]) => !known.includes(name));
    shown.set(whose, others.map(([name, value]) => `${whose}: ${name} ${JSON.stringify(value)}`));
    document.getElementById("others")!.textContent = [...shown.values()].flat().join(", ");
}
