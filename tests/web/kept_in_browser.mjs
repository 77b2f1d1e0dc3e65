// SPDX-License-Identifier: Apache-2.0
// Digs in the page, and leaves it in every way: the sand is still there. Chromium alone.
// usage: node tests/web/kept_in_browser.mjs
import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { complaintsOf, launch, press, serve } from "./browser.mjs";
import { testKeptSand } from "./kept_sand_in_browser.mjs";

const folder = fs.mkdtempSync(path.join(os.tmpdir(), "kept-")), grid = path.join(folder, "flat.asc");
fs.writeFileSync(grid, `ncols 60\nnrows 60\nxllcorner 4000\nyllcorner 5000\ncellsize 1\n${"0 ".repeat(3600)}\n`);
const { address, end } = await serve();
const browser = await launch("chromium");
const dialogs = [];  // what the pages have asked
let agree = true, complaints = [];

async function newPage(from = browser) {
    const page = await from.newPage();
    await page.setViewport({ width: 400, height: 300 });
    page.on("dialog", (dialog) => { dialogs.push(`${dialog.type()}: ${dialog.message()}`); void (agree ? dialog.accept() : dialog.dismiss()); });
    complaints.push(complaintsOf(page, address));
    return page;
}
const until = (page, condition) => page.waitForFunction(condition, { timeout: 120_000, polling: 50 });
const data = (page) => page.evaluate(() => ({ ...document.body.dataset }));
const said = (page) => page.$eval("#say", (say) => say.textContent);
/** Waits until the page digs in sand whose picture is shown. */
const digs = (page, name) => until(page, `document.body.dataset.digging === "${name}" && document.body.dataset.hand === "yes" && document.body.dataset.shown && document.body.dataset.step > 2`);
async function openGrid(page) {
    await page.goto(`${address}?dig=none`);  // no scene, which a browser without a graphics card draws slowly
    await page.waitForSelector("#files");
    await (await page.$("#files")).uploadFile(grid);
    await digs(page, "flat");
}
async function stroke(page, y) {
    const { x, y: top, width, height } = await (await page.$("#sand")).boundingBox(), at = (u) => [x + u * width, top + y * height];
    await page.mouse.move(...at(0.42));
    await page.mouse.down();
    await page.mouse.move(...at(0.58), { steps: 6 });
    await page.mouse.up();
}
/** Waits until the newest sand is kept. Returns its step and its hash. */
async function kept(page) {
    await until(page, "document.body.dataset.unkept === 'true' || Number(document.body.dataset.keptStep) > 0");
    await until(page, "document.body.dataset.unkept === 'false' && Number(document.body.dataset.keptStep) > 0");
    const { keptStep, keptHash } = await data(page);
    return [keptStep, keptHash];
}

try {
    await testKeptSand(browser, address);

    // A reload continues with the same sand, and asks nothing.
    const first = await newPage();
    await openGrid(first);
    assert.equal((await data(first)).keptSessions, "0", "sand that nobody has dug is not kept");
    await stroke(first, 0.5);
    await kept(first);
    await stroke(first, 0.6);
    await kept(first);
    // A page that is left keeps the steps since the stroke, too. In a pause no others follow.
    // The worker answers a key for another tool behind all that it has got before, so the step is the last one then.
    const answered = async (key, tool) => {
        await first.keyboard.press(key);
        await until(first, `document.getElementById("tool").value === "${tool}"`);
    };
    await first.keyboard.press("Space");
    await answered("2", "circle");
    await first.evaluate(() => document.dispatchEvent(new Event("visibilitychange")));
    await answered("1", "sphere");
    await until(first, "document.body.dataset.keptStep === document.body.dataset.step");
    const { keptStep: step, keptHash: hash } = await data(first);
    await first.goto(`${address}?dig=flat`);
    await digs(first, "flat");
    const { goesOnStep, goesOnHash } = await data(first);
    assert.deepEqual([goesOnStep, goesOnHash], [step, hash]);
    assert.match(await said(first), /^This is your sand of /);
    assert.equal(await first.$eval("#undo", (button) => button.disabled), false, "the stroke can be undone after a reload");
    assert.deepEqual(dialogs, []);

    // New sand is a session of its own. The eleventh is one too many, and the page names the oldest.
    await first.evaluate(() => new Promise((resolve) => {
        const request = indexedDB.open("sandwall", 1);
        request.onsuccess = () => {
            const to = request.result.transaction(["sessions", "pieces"], "readwrite"), pieces = to.objectStore("pieces").getAll();
            pieces.onsuccess = () => [...Array(9).keys()].forEach((i) => {  // the same journal, in older sessions
                to.objectStore("sessions").put({ id: `old ${i}`, name: "flat", began: 0, changed: 1e12 + i * 1e9, seconds: i,
                    bytes: pieces.result.reduce((sum, { bytes }) => sum + bytes.byteLength, 0) });
                pieces.result.forEach((piece) => to.objectStore("pieces").put({ ...piece, id: `old ${i}` }));
            });
            to.oncomplete = () => { request.result.close(); resolve(); };
        };
    }));
    await press(first, "#reset");
    await until(first, "document.body.dataset.keptStep === '0'");
    await digs(first, "flat");
    await stroke(first, 0.5);
    await kept(first);
    await until(first, "document.body.dataset.keptSessions === '10'");
    assert.match(await said(first), /keeps 10 sessions, so the oldest was removed: flat of .*2001/);
    assert.deepEqual(dialogs, [], "sand that is kept is left without a question");

    // Another session of the list continues.
    const other = await first.$$eval("#kept option", (options) => options.at(-1).value);
    await first.select("#kept", other);
    await press(first, "#goOn");
    await until(first, "document.body.dataset.keptStep !== '0' && document.body.dataset.hand === 'yes' && document.body.dataset.step > 2");
    await until(first, "/^This is your sand of /.test(document.getElementById('say').textContent)");

    // A kept session that is damaged stays, and one sentence says so.
    const damaged = await first.evaluate(() => new Promise((resolve) => {
        const request = indexedDB.open("sandwall", 1);
        request.onsuccess = () => {
            const to = request.result.transaction("pieces", "readwrite"), id = sessionStorage.getItem("sandwall session");
            to.objectStore("pieces").put({ id, offset: 0, bytes: new TextEncoder().encode("no journal").buffer });
            to.oncomplete = () => { request.result.close(); resolve(id); };
        };
    }));
    await first.goto(`${address}?dig=stroke`);  // another scene, so that the damaged sand is chosen in the list alone
    await digs(first, "stroke");
    await first.select("#kept", damaged);
    await press(first, "#goOn");
    await until(first, "document.body.dataset.problem");
    assert.match((await data(first)).problem, /not a Sandwall journal file/);
    assert.equal((await data(first)).keptSessions, "10", "the damaged session stays");
    assert.equal((await data(first)).digging, "stroke", "so does the sand of this tab");

    // A second tab has sand of its own, and says so.
    await stroke(first, 0.5);
    await kept(first);
    const second = await newPage();
    await second.goto(`${address}?dig=stroke`);
    await digs(second, "stroke");
    assert.match(await said(second), /^Another tab digs in the kept sand of stroke\. This tab has new sand, and the other stays\./);
    assert.equal((await data(second)).goesOnStep, "0");
    // Nor can it remove the sand of the other tab, which goes on.
    const taken = await first.evaluate(() => sessionStorage.getItem("sandwall session"));
    await second.select("#kept", taken);
    await press(second, "#forget");
    await until(second, "/A tab digs in this sand, so it stays/.test(document.getElementById('say').textContent)");
    assert.match(dialogs.pop(), /^confirm: Remove the kept sand stroke/);
    assert.ok(await second.$$eval("#kept option", (options, id) => options.some(({ value }) => value === id), taken));
    await second.close();

    // The list says what is dug, and new sand of the same scene throws nothing away.
    assert.equal(await first.$eval("#scene", (list) => list.value), "stroke");
    const { keptStep } = await data(first);
    await press(first, "#dig");
    await until(first, "document.body.dataset.keptStep === '0' && document.body.dataset.hand === 'yes'");
    assert.ok(Number(keptStep) > 0 && await first.$$eval("#kept option", (options) => options.some(({ text }) => /^stroke,/.test(text))));
    assert.deepEqual(dialogs, [], "kept sand is left without a question");
    await first.close();

    // A full disk in a private window: the sand stays, the page says so, and asks before it is left. Chromium looks at
    // the quota anew when it was too small, so the quota is small from the start.
    const private_ = await newPage(await browser.createBrowserContext()), control = await private_.createCDPSession();
    const quota = (quotaSize) => control.send("Storage.overrideQuotaForOrigin", { origin: new URL(address).origin, quotaSize });
    await quota(1);
    await openGrid(private_);
    assert.equal((await data(private_)).keptSessions, "0", "a private window has no sand of others");
    await stroke(private_, 0.4);
    await until(private_, "/does not keep this sand: its storage is full/.test(document.getElementById('say').textContent)");
    agree = false;
    await press(private_, "#reset");
    assert.match(dialogs.at(-1), /^confirm: This sand is not kept/);
    assert.equal((await data(private_)).unkept, "true", "the sand stays");
    void private_.reload().catch(() => {});
    for (let waited = 0; !/^beforeunload/.test(dialogs.at(-1)) && waited < 600; ++waited) {
        await new Promise((resolve) => setTimeout(resolve, 50));
    }
    assert.match(dialogs.at(-1), /^beforeunload/);
    await quota(undefined);
    await private_.evaluate(() => document.dispatchEvent(new Event("visibilitychange")));  // otherwise the page tries again after 5 s
    await until(private_, "/The sand is kept again/.test(document.getElementById('say').textContent)");
    await kept(private_);
    await private_.close();

    await browser.close();

    // A browser that refuses IndexedDB, because its user forbids cookies.
    const profile = path.join(folder, "profile", "Default");
    fs.mkdirSync(profile, { recursive: true });
    fs.writeFileSync(path.join(profile, "Preferences"), JSON.stringify({ profile: { default_content_setting_values: { cookies: 2 } } }));
    const refusing = await launch("chromium", { userDataDir: path.dirname(profile) });
    try {
        const page = await newPage(refusing);
        await openGrid(page);
        await stroke(page, 0.5);
        await until(page, "/^This browser does not keep this sand: [^.]+\\. Save the session before you leave\\.$/.test(document.getElementById('say').textContent)");
        assert.deepEqual([(await data(page)).unkept, (await data(page)).digging], ["true", "flat"]);
    } finally {
        await refusing.close();
    }
    assert.deepEqual(complaints.flat(), []);
    console.log("kept sand continues after a reload, in another tab, on a full disk, and beside damaged sand");
} finally {
    await browser.close();
    end();
    fs.rmSync(folder, { recursive: true });
}
process.exit(0);
