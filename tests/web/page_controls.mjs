// SPDX-License-Identifier: Apache-2.0
// What a test does with the page and asks of it.

/** Returns functions for a page of a browser. */
export function controlsOf(page) {
    const until = (condition) => page.waitForFunction(condition, { timeout: 120_000, polling: 50 });
    const data = () => page.evaluate(() => ({ ...document.body.dataset }));
    const value = (id) => page.$eval(id, (control) => control.value || control.textContent);
    const canUndo = () => page.$eval("#undo", (button) => !button.disabled);
    const canRedo = () => page.$eval("#redo", (button) => !button.disabled);
    const digs = (name) => until(`document.body.dataset.digging === "${name}" && document.body.dataset.hand === "yes" && document.body.dataset.shown && document.body.dataset.step > 2`);
    async function steps(count) {
        const step = Number((await data()).step ?? 0) + count;
        await until(`Number(document.body.dataset.step) >= ${step}`);
    }
    /** Returns the window's place of a place in shares of the canvas. */
    async function at(u, v) {
        const { x, y, width, height } = await (await page.$("#sand")).boundingBox();
        return [x + u * width, y + v * height];
    }
    async function drag(from, to) {
        await page.mouse.move(...await at(...from));
        await page.mouse.down();
        await page.mouse.move(...await at(...to), { steps: 5 });
        await page.mouse.up();
    }
    /** Returns what the page says of the height at a place in shares of the canvas. */
    async function heightAt(u, v) {
        await page.mouse.move(...await at(0.02, 0.5));  // beside the sand there is no height
        await until("document.body.dataset.height === ''");
        await page.mouse.move(...await at(u, v));
        await until("document.body.dataset.height !== ''");
        return (await data()).height;
    }
    async function eye() {
        await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
        const numbers = (await data()).view.split(",").map(Number), target = numbers.slice(3);
        return { target, far: Math.hypot(...numbers.slice(0, 3).map((n, i) => n - target[i])) };
    }

    /** Returns what of a section is cut off. */
    const cut = (within) => page.evaluate((section) => [...document.querySelectorAll(section)].filter((it) => it.getClientRects().length > 0).filter((it) => {
        it.scrollIntoView({ block: "nearest" });
        const { left, right, top, bottom } = it.getBoundingClientRect();
        return left < -1 || right > innerWidth + 1 || top < -1 || bottom > innerHeight + 1 || (it.matches("button") && it.scrollWidth > it.clientWidth + 1);
    }).map((it) => it.id || it.textContent), within);
    return { until, data, value, canUndo, canRedo, digs, steps, at, drag, heightAt, eye, cut };
}
