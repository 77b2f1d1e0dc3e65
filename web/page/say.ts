// SPDX-License-Identifier: Apache-2.0
// The one line of the page that says what happens. It lies over the sand, so it goes after a while unless it must stay.

const say = document.getElementById("say")!;
const kShownMs = 10_000;
let timer: ReturnType<typeof setTimeout> | undefined;

const hide = () => document.body.classList.add("quiet");
say.onclick = hide;

/** Says a sentence. One that `stays` is shown until the next one, or until a person presses it. */
export function sayThis(text: string, stays = false): void {
    if (say.textContent !== text) {
        say.textContent = text;
    }
    clearTimeout(timer);
    document.body.classList.remove("quiet");
    timer = stays ? undefined : setTimeout(hide, kShownMs);
}
/** Hides the line unless it must stay. */
export function hush(): void {
    if (timer !== undefined) {
        hide();
    }
}
