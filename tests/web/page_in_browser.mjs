// SPDX-License-Identifier: Apache-2.0
// The first screen of the page, its layout on each size of screen, and the keys and touches of a window. Chromium alone.
// usage: node tests/web/page_in_browser.mjs [FOLDER]    pictures of each size go to FOLDER
import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { complaintsOf, launch, press, serve } from "./browser.mjs";
import { controlsOf } from "./page_controls.mjs";

const [pictures] = process.argv.slice(2);
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "page-")), grid = path.join(folder, "flat.asc");
fs.writeFileSync(grid, `ncols 60\nnrows 60\nxllcorner 4000\nyllcorner 5000\ncellsize 1\n${"0 ".repeat(3600)}\n`);
const { address, end } = await serve(), browser = await launch("chromium");
const page = await browser.newPage(), complaints = complaintsOf(page, address);
const { until, data, value, canUndo, canRedo, digs, steps, at, drag, heightAt, eye, cut } = controlsOf(page);

/** The page opens with dunes, an invitation and three pictures. The first touch ends the invitation. */
async function firstScreen() {
    const began = performance.now();
    await page.goto(address);
    await until("document.body.dataset.view && document.body.dataset.shown");
    console.log(`the first sand after ${Math.round(performance.now() - began)} ms`);
    await digs("dunes");
    const seen = (id) => page.$eval(id, (it) => getComputedStyle(it).display !== "none");
    assert.deepEqual([await seen("#ghost"), await seen("#scenes")], [true, true]);
    assert.equal((await data()).tool, "no", "nobody points, so no tool lies at the corner of the box");
    for (const width of [195, 800]) {  // a phone at 200 %
        await page.setViewport({ width, height: 600 });
        assert.deepEqual(await cut("#scenes button, #say, #row *, #full"), [], `${width} pixels`);
    }
    assert.equal((await page.$$("#scenes button")).length, 3);
    assert.deepEqual([(await data()).unkept, (await data()).keptSessions, await canUndo()], ["false", "0", false], "the invitation digs nothing");
    await page.click("#scenes button:nth-child(3)");
    await digs("writing");
    assert.equal(await page.$eval("#scene", (list) => list.value), "writing", "the list says what is dug");
    // The scene's tool has 0.04. The page begins with 1/40 of the side, and `0` gives that of the scene.
    await until("document.getElementById('size').textContent === 'Radius 0.0500'");
    assert.equal((await data()).unkept, "false", "a tool is no sand");
    await page.focus("#sand");
    await page.keyboard.press("0");
    await until("document.getElementById('size').textContent === 'Radius 0.0400'");
    await page.mouse.click(...await at(0.5, 0.5));
    await until("document.body.dataset.tool === 'yes'");
    assert.deepEqual([await seen("#ghost"), await seen("#scenes")], [false, false]);
    await (await page.$("#files")).uploadFile(grid);
    await digs("flat");
}

/** Sand has at least 60 % of each screen. Nothing is cut, in the row, in the drawer and in the help. */
async function sizes() {
    const kSizes = [[320, 480, 1], [390, 844, 1], [640, 360, 1], [1280, 720, 1], [1920, 1080, 1], [640, 360, 2], [195, 422, 2], [320, 240, 2]];  // the last three: at 200 %
    for (const [width, height, deviceScaleFactor] of kSizes) {
        const size = `${width} x ${height} at ${deviceScaleFactor}`;
        await page.setViewport({ width, height, deviceScaleFactor });
        const { share, wide } = await page.evaluate(() => {
            const { width, height } = document.getElementById("sand").getBoundingClientRect();
            return { share: width * height / innerWidth / innerHeight, wide: document.documentElement.scrollWidth > innerWidth };
        });
        assert.ok(share >= 0.6, `${size}: ${share} of the screen is sand`);
        assert.equal(wide, false, size);
        const shot = async (what) => {
            if (pictures) {
                await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 800)));
                await page.screenshot({ path: path.join(pictures, `${what}_${width}x${height}@${deviceScaleFactor}.png`) });
            }
        };
        assert.deepEqual(await cut("#row *, #full, #say"), [], size);
        await shot("dig");
        await page.click("#more");
        assert.deepEqual(await cut("#drawer button, #drawer select, #drawer input, #drawer label, #drawer summary"), [], size);
        await shot("drawer");
        await page.keyboard.press("Escape");
        await page.keyboard.press("h");
        assert.deepEqual(await cut("#help td"), [], size);
        await shot("help");
        await page.keyboard.press("Escape");
        assert.deepEqual([await page.$eval("#help", (help) => help.hidden), await page.$eval("#drawer", (drawer) => drawer.hidden)], [true, true]);
    }
    await page.setViewport({ width: 800, height: 600 });
}

/** Each control that is enabled can be reached by Tab. The colours are those of the person's system. */
async function reach() {
    await page.click("#more");
    const wanted = await page.$$eval("button, select, input, summary, canvas", (all) => all.filter((it) => !it.disabled && it.getClientRects().length > 0 && !(it.id === "sand"))
        .map((it) => it.id || it.tagName));
    await page.focus("#sand");
    const reached = new Set();
    for (let i = 0; i < wanted.length + 4; ++i) {
        await page.keyboard.press("Tab");
        reached.add(await page.evaluate(() => document.activeElement.id || document.activeElement.tagName));
    }
    assert.deepEqual(wanted.filter((id) => !reached.has(id)), []);
    assert.ok(wanted.length >= 18, wanted.join());
    await page.keyboard.press("Escape");
    const grounds = new Set();
    for (const scheme of ["light", "dark"]) {
        await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
        grounds.add(await page.evaluate(() => getComputedStyle(document.body).backgroundColor));
    }
    assert.equal(grounds.size, 2);
}

/** The keys of a window. */
async function keys() {
    await page.focus("#sand");
    const tool = async (key, name) => {
        await page.keyboard.press(key);
        await until(`document.getElementById("tool").value === "${name}"`);
    };
    const size = () => value("#size");
    await tool("4", "ellipse");
    const heading = await value("#heading");
    await page.keyboard.press(",");
    await until(`Number(document.getElementById("heading").value) === ${(Number(heading) + 5) % 360}`);
    const small = await size();
    await page.keyboard.press("+");
    await until(`document.getElementById("size").textContent !== "${small}"`);
    await page.keyboard.press("w");
    await page.select("#word", "humidity");
    await until(`document.getElementById("number").value === "0.1"`);
    // A pause makes no step, and the pointer digs nothing. Each answer to a key comes from the worker, which would make steps before it.
    let turned = Number(await value("#heading"));
    const turn = async () => {
        turned = (turned + 5) % 360;
        await page.keyboard.press(",");
        await until(`Number(document.getElementById("heading").value) === ${turned}`);
    };
    await page.keyboard.press("Space");
    await until("/^Paused/.test(document.getElementById('say').textContent)");
    for (let i = 0; i < 3; ++i) {
        await turn();  // the worker has told the last step then
    }
    const { step } = await data();
    await drag([0.3, 0.7], [0.7, 0.7]);
    for (let i = 0; i < 6; ++i) {
        await turn();
    }
    assert.equal((await data()).step, step, "no step is made during a pause");
    await page.keyboard.press("Space");
    await steps(30);
    assert.equal(await heightAt(0.5, 0.7), "height 0.0", "the pointer of a pause digs nothing");

    await page.keyboard.press("0");
    await tool("1", "sphere");
    await until(`document.getElementById("size").textContent === "Radius 2.00" && document.getElementById("number").value === "0"`);
    // Escape lifts the tool of a stroke, whose sand stays. Then it has nothing to close, and nothing ends.
    await page.mouse.move(...await at(0.4, 0.4));
    await page.mouse.down();
    await page.mouse.move(...await at(0.6, 0.4), { steps: 5 });
    await until("!document.getElementById('undo').disabled");
    await page.keyboard.press("Escape");
    await steps(10);
    await page.mouse.move(...await at(0.4, 0.7), { steps: 5 });
    await page.mouse.move(...await at(0.6, 0.7), { steps: 5 });
    await steps(20);
    await page.mouse.up();
    assert.notEqual(await heightAt(0.5, 0.4), "height 0.0", "the stroke before Escape stays");
    assert.equal(await heightAt(0.5, 0.7), "height 0.0", "a tool that Escape has lifted digs nothing");
    assert.ok(await canUndo());
    await page.keyboard.press("Escape");
    await page.keyboard.press("q");
    await steps(5);
    assert.deepEqual([(await data()).digging, await canUndo(), await canRedo()], ["flat", true, false], "Escape and Q leave the sand");
    const withControl = async (key) => {
        await page.keyboard.down("Control");
        await page.keyboard.press(key);
        await page.keyboard.up("Control");
        await steps(10);
    };
    for (let tries = 0; tries < 20 && await canUndo(); ++tries) {  // the stroke, and the changes of the humidity before it
        await withControl("z");
    }
    assert.deepEqual([await canUndo(), await canRedo()], [false, true], "all is undone");
    await until(`document.getElementById("number").value === "0"`);
    await withControl("y");
    assert.ok(await canUndo(), "an entry is back");
    await withControl("z");
    assert.equal(await canUndo(), false);
    await page.keyboard.press("g");
    await until("/only in a window of a wall/.test(document.getElementById('say').textContent)");
    // A key that is typed into a field is its own.
    await press(page, "#details summary");
    await page.click("#more");
    await page.focus("#scene");
    await page.keyboard.press("2");
    await page.keyboard.press("Escape");
    assert.equal(await value("#tool"), "sphere");
}

/** Wheel, double click, and the height under the pointer. */
async function touches() {
    await page.keyboard.press("Home");
    const before = await eye(), depth = await value("#depth"), size = await value("#size");
    const [x, y] = await at(0.6, 0.45);
    await page.mouse.move(x, y);
    await until("document.body.dataset.height === 'height 0.0' && document.getElementById('height').textContent === 'height 0.0'");
    await page.mouse.wheel({ deltaY: -100 });
    const nearer = await eye();
    assert.ok(nearer.far < 0.99 * before.far && nearer.target[0] > before.target[0] + 0.002, `the wheel goes to the pointer: ${JSON.stringify([before, nearer])}`);
    await page.keyboard.down("Shift");
    await page.mouse.wheel({ deltaY: 100 });
    await page.keyboard.up("Shift");
    await until(`document.getElementById("depth").value !== "${depth}"`);
    await page.keyboard.down("Control");
    await page.mouse.wheel({ deltaY: -100 });
    await page.keyboard.up("Control");
    await until(`document.getElementById("size").textContent !== "${size}"`);
    assert.ok(Math.abs((await eye()).far - nearer.far) < 0.001, "neither has moved the eye");
    await page.mouse.click(x, y, { count: 2 });
    await page.waitForFunction((far) => {
        const numbers = document.body.dataset.view.split(",").map(Number);
        return Math.hypot(...[0, 1, 2].map((i) => numbers[i] - numbers[i + 3])) < 0.7 * far;
    }, { timeout: 120_000, polling: 50 }, nearer.far);
    await steps(30);
    assert.equal(await canUndo(), false, "a double click digs nothing");
    await page.keyboard.press("v");
    assert.ok(Math.abs((await eye()).far - before.far) < 0.001, "V frames the terrain");
    await page.mouse.click(x, y);
    await until("!document.getElementById('undo').disabled");  // a single click digs
}

try {
    await page.setViewport({ width: 800, height: 600 });
    await firstScreen();
    await sizes();
    await reach();
    await keys();
    await touches();
    assert.deepEqual(complaints, []);
    console.log("the page invites, fits each screen, and obeys the keys and touches of a window");
} finally {
    await browser.close();
    end();
    fs.rmSync(folder, { recursive: true });
}
process.exit(0);
