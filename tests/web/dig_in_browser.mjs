// SPDX-License-Identifier: Apache-2.0
// Digs in a scene of the page with the mouse of a browser, uses tools, edits and material, and saves the session.
// usage: node tests/web/dig_in_browser.mjs chromium|firefox SCENE FOLDER [PICTURE.png]
// SCENE is the name of a sample scene, or a file NAME.asc. Writes FOLDER/session.journal, and prints what the page says.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { complaintsOf, launch, press, serve } from "./browser.mjs";

const [name, scene, given, picture] = process.argv.slice(2);
const folder = path.resolve(given), journal = path.join(folder, "session.journal");
const kPatienceMs = 120_000;

const { address, end } = await serve();
const browser = await launch(name, {
    prefs: { "browser.download.folderList": 2, "browser.download.dir": folder, "browser.helperApps.neverAsk.saveToDisk": "application/octet-stream" },
});
const page = await browser.newPage();
const complaints = complaintsOf(page, address);
if (name !== "firefox") {
    const control = await page.createCDPSession();
    await control.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: folder });
}
const data = () => page.evaluate(() => ({ ...document.body.dataset }));
const until = (condition) => page.waitForFunction(condition, { timeout: kPatienceMs, polling: 50 });
/** Waits until the worker has computed so many further steps. */
async function steps(count) {
    const step = Number((await data()).step ?? 0) + count;
    await until(`Number(document.body.dataset.step) >= ${step}`);
}
/** Draws a stroke through places in shares of the canvas. */
async function stroke(places) {
    const { x, y, width, height } = await (await page.$("#sand")).boundingBox();
    const at = ([u, v]) => [x + u * width, y + v * height];
    await page.mouse.move(...at(places[0]));
    await page.mouse.down();
    for (const place of places.slice(1)) {
        await page.mouse.move(...at(place), { steps: 8 });
    }
    await page.mouse.up();
    await steps(10);
}
async function setNumber(id, value) {
    await page.$eval(id, (field, number) => {
        field.value = number;
        field.dispatchEvent(new Event("change"));
    }, String(value));
}

try {
    await page.setViewport({ width: 800, height: 560 });
    await page.goto(address);
    await until("document.body.dataset.hand === 'yes' && document.body.dataset.shown");
    if (scene.endsWith(".asc")) {
        await (await page.$("#files")).uploadFile(path.resolve(scene));
    } else {
        await page.select("#scene", scene);
        await press(page, "#dig");
    }
    const sand = path.basename(scene, ".asc");
    await until(`document.body.dataset.problem || (document.body.dataset.digging === "${sand}" && document.body.dataset.hand === "yes" && document.body.dataset.shown)`);
    assert.equal((await data()).problem, undefined);
    assert.equal(await page.$eval("#undo", (button) => button.disabled), true, "there is no stroke yet");
    const tools = await page.$$eval("#tool option", (options) => options.map(({ value }) => value));
    assert.ok(tools.length >= 6 && tools.includes("footprint"), tools.join());
    for (const [i, tool] of tools.entries()) {
        await page.select("#tool", tool);
        await page.click("#larger");
        await steps(1);  // the worker has answered
        if (await page.$eval("#width", (field) => !field.disabled)) {
            await setNumber("#width", 0.3);
        }
        const v = 0.3 + 0.08 * i;
        await stroke([[0.3, v], [0.5, v + 0.04], [0.7, v]]);
    }
    assert.equal(await page.$eval("#width", (field) => field.value), "0.3");
    await page.click("#undo");
    await steps(5);
    await page.select("#word", "humidity");
    await setNumber("#number", 0.5);
    await page.select("#tool", "sphere");
    await stroke([[0.35, 0.25], [0.5, 0.75], [0.65, 0.25]]);
    await press(page, "#settle");
    await steps(5);
    // Nothing can be undone in new sand. The right button turns the view, and digs nothing: there is no stroke to undo.
    const canUndo = () => page.$eval("#undo", (button) => !button.disabled);
    assert.ok(await canUndo(), "a stroke can be undone");
    await press(page, "#reset");
    await steps(20);
    await until("document.body.dataset.hand === 'yes' && document.body.dataset.shown");
    assert.equal(await canUndo(), false, "new sand has no stroke");
    const before = await data();
    await page.mouse.move(300, 150);
    await page.mouse.down({ button: "right" });
    await page.mouse.move(330, 160, { steps: 4 });
    await page.mouse.up({ button: "right" });
    await steps(20);
    assert.equal(await canUndo(), false, "the right button has dug");
    assert.notEqual((await data()).view, before.view, "the right button has not turned the view");
    await stroke([[0.45, 0.4], [0.55, 0.6]]);
    if (picture) {
        await page.screenshot({ path: picture });
    }
    await press(page, "#save");
    for (let waited = 0; !(fs.existsSync(journal) && fs.statSync(journal).size > 0); waited += 100) {
        assert.ok(waited < kPatienceMs, "the journal is not saved");
        await new Promise((resolve) => setTimeout(resolve, 100));
    }
    const after = await data();
    assert.ok(Number(after.step) > Number(before.step) && after.problem === undefined, JSON.stringify(after));
    console.log(name, await browser.version(), JSON.stringify(after));
} finally {
    await browser.close();
    end();
}
for (const complaint of complaints) {
    console.error(complaint);
}
process.exit(complaints.length > 0 ? 1 : 0);
