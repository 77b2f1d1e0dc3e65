// SPDX-License-Identifier: Apache-2.0
// Turns, moves and digs sand of the page with fingers and a pen in Chromium, at the size of a phone. Firefox ESR refuses
// fingers and pens of a script.
// usage: node tests/web/touch_in_browser.mjs JOURNAL [PICTURE.png]
import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { complaintsOf, launch, passed, serve } from "./browser.mjs";

const [journal, picture] = process.argv.slice(2);
const browser = await launch("chromium"), { address, end } = await serve(journal);
const page = await browser.newPage(), complaints = complaintsOf(page, address);
const control = await page.createCDPSession();
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const drawn = () => page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
const until = (condition) => page.waitForFunction(condition, { timeout: 60_000, polling: 50 });

/** Returns the window's place of a place in shares of the canvas. */
async function placing() {
    const { x, y, width, height } = await (await page.$("#sand")).boundingBox();
    return ([u, v]) => [Math.round(x + u * width), Math.round(y + v * height)];
}
/** Draws with fingers, each of which has a list of places. The second one touches the screen a little after the first. */
async function fingers(...tracks) {
    const at = await placing(), hands = await Promise.all(tracks.map((track) => page.touchscreen.touchStart(...at(track[0]))));
    for (let i = 1; i < tracks[0].length; ++i) {
        for (const [k, hand] of hands.entries()) {
            await hand.move(...at(tracks[k][i]));
        }
        await pause(16);
    }
    for (const hand of hands) {
        await hand.end();
    }
}
const send = (type, [x, y], buttons) => control.send("Input.dispatchMouseEvent", { type, x, y, button: type === "mouseMoved" ? "none" : "left", buttons, clickCount: 1, pointerType: "pen" });
async function pen(track) {
    const at = await placing(), [first, ...rest] = track.map((place) => at(place)), last = rest.at(-1);
    await send("mouseMoved", first, 0);
    await send("mousePressed", first, 1);
    for (const place of rest) {
        await send("mouseMoved", place, 1);
        await pause(16);
    }
    await send("mouseReleased", last, 0);
}
/** Returns a straight way in some steps. */
const way = (from, to, parts = 5) => Array.from({ length: parts + 1 }, (_, i) => from.map((n, k) => n + (to[k] - n) * i / parts));

/** The eye: the place that it looks at, and direction and distance from there. */
async function eye() {
    await drawn();
    const numbers = (await page.evaluate(() => document.body.dataset.view)).split(",").map(Number);
    const target = numbers.slice(3), arm = numbers.slice(0, 3).map((n, i) => n - target[i]), far = Math.hypot(...arm);
    return { target, far, direction: arm.map((n) => n / far) };
}
const apart = (a, b) => Math.hypot(...a.map((n, i) => n - b[i]));
/** Does a gesture, and returns by how much it has moved the target, the direction and the distance of the eye. */
async function moved(gesture) {
    const before = await eye();
    await gesture();
    const after = await eye();
    return { target: apart(before.target, after.target), direction: apart(before.direction, after.direction), far: after.far / before.far - 1 };
}
const kNothing = 0.005;  // more than the last decimals of data-view
function assertMoved(found, wanted) {
    for (const part of ["target", "direction", "far"]) {
        assert.equal(Math.abs(found[part]) > kNothing, wanted.includes(part), `${part} of ${JSON.stringify(found)}, wanted: ${wanted}`);
    }
}
const pinch = (from, to) => [way([0.5 - from, 0.5], [0.5 - to, 0.5]), way([0.5 + from, 0.5], [0.5 + to, 0.5])];

async function inJournal() {
    await page.goto(address);
    assert.equal((await passed(page)).mismatches, "0");
    assertMoved(await moved(() => fingers(way([0.4, 0.4], [0.6, 0.45]))), ["direction"]);
    assertMoved(await moved(() => fingers(way([0.4, 0.5], [0.5, 0.5]), way([0.6, 0.5], [0.7, 0.5]))), ["target"]);
    const nearer = await moved(() => fingers(...pinch(0.1, 0.3)));
    assert.ok(nearer.far < -0.1, JSON.stringify(nearer));
    assertMoved(await moved(() => pen(way([0.4, 0.4], [0.6, 0.45]))), ["direction"]);
}

const canUndo = () => page.$eval("#undo", (button) => !button.disabled);
/** Takes back the last stroke. */
async function undo() {
    await until("!document.getElementById('undo').disabled");
    await page.click("#undo");
    await until("document.getElementById('undo').disabled");
}
/** Waits until the worker has computed further steps, and said so. */
async function rest() {
    const step = Number(await page.evaluate(() => document.body.dataset.step)) + 30;
    await until(`Number(document.body.dataset.step) >= ${step}`);
}

/** Begins to dig with a pen, loses it by `lose`, and moves it on, with the buttons that it reports. Then nothing may dig. */
async function lostPen(lose, buttons) {
    const at = await placing(), track = way([0.4, 0.5], [0.6, 0.55]).map((place) => at(place));
    await send("mouseMoved", track[0], 0);
    await send("mousePressed", track[0], 1);
    await send("mouseMoved", track[1], 1);
    await lose();
    await send("mouseMoved", track[2], buttons);
    await undo();
    for (const place of track.slice(3)) {
        await send("mouseMoved", place, buttons);
        await pause(16);
    }
    await rest();
    assert.equal(await canUndo(), false, "a lost pen digs nothing");
    await send("mouseReleased", track.at(-1), 0);
}

/** Takes the pen's capture away, as a browser does when the pen is gone. */
const loseCapture = () => page.evaluate(() => {
    const sand = document.getElementById("sand");
    for (let id = 0; id < 20; ++id) {  // a script cannot know the pen's number
        if (sand.hasPointerCapture(id)) {
            sand.releasePointerCapture(id);
        }
    }
});

async function whileDigging() {
    // A small field, which is drawn quickly also in software.
    const folder = fs.mkdtempSync(path.join(os.tmpdir(), "touch-")), grid = path.join(folder, "flat.asc");
    fs.writeFileSync(grid, `ncols 60\nnrows 60\nxllcorner 4000\nyllcorner 5000\ncellsize 1\n${"0 ".repeat(3600)}\n`);
    await page.goto(`${new URL(address).origin}/?dig=none`);
    await page.waitForSelector("#files");
    await (await page.$("#files")).uploadFile(grid);
    await until("document.body.dataset.digging && document.body.dataset.view && document.body.dataset.step");
    fs.rmSync(folder, { recursive: true });
    for (const dig of [() => fingers(way([0.4, 0.5], [0.6, 0.55])), () => fingers([[0.5, 0.5]]), () => pen(way([0.4, 0.5], [0.6, 0.55]))]) {
        assertMoved(await moved(dig), []);
        await undo();  // there was a stroke
    }
    await lostPen(() => page.evaluate(() => dispatchEvent(new Event("blur"))), 1);  // another window has the focus
    await lostPen(() => {}, 0);  // its release has gone elsewhere
    await lostPen(loseCapture, 1);
    assertMoved(await moved(() => fingers(way([0.4, 0.5], [0.5, 0.5]), way([0.6, 0.5], [0.7, 0.5]))), ["direction"]);
    const nearer = await moved(() => fingers(...pinch(0.1, 0.3)));
    assert.ok(nearer.far < -0.1, JSON.stringify(nearer));
    await rest();
    assert.equal(await canUndo(), false, "two fingers dig nothing");
    if (picture) {
        await fingers(way([0.35, 0.45], [0.65, 0.55]));
        await fingers(way([0.35, 0.6], [0.6, 0.4]));
        await rest();
        await page.screenshot({ path: picture });
    }
}

try {
    await page.setViewport({ width: 390, height: 844, isMobile: true, hasTouch: true });
    await inJournal();
    await whileDigging();
    assert.deepEqual(complaints, []);
    console.log("fingers and a pen turn, move and dig the sand");
} finally {
    await browser.close();
    end();
}
process.exit(0);
