// SPDX-License-Identifier: Apache-2.0
// Opens sessions in a browser, and compares what the page has counted and computed with what the native program wrote.
// usage: node tests/web/browser_test.mjs chromium|firefox FOLDER LIST
// LIST is what session_files has printed, with the sessions in FOLDER.
// tests/web/browser_test.sh calls this script.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { complaintsOf, launch, passed, press, serve } from "./browser.mjs";

const [name, folder, list] = process.argv.slice(2);
const sessions = fs.readFileSync(list, "utf8").trim().split("\n").map((line) => line.split(" "));
const browser = await launch(name);

/** Opens one session, and returns the page. */
async function open([file, , steps, hashes, hash]) {
    const { address, end } = await serve(path.join(folder, file));
    const page = await browser.newPage(), complaints = complaintsOf(page, address);
    await page.setViewport({ width: 900, height: 700 });
    await page.goto(address);
    const found = await passed(page);
    console.log(name, file, `${found.matches} of ${found.hashes} hashes, ${found.mismatches} differ, ${found.hash}`);
    assert.deepEqual([found.problem, found.mismatches, found.matches, found.hashes, found.steps, found.hash], [undefined, "0", hashes, hashes, steps, hash], file);
    assert.deepEqual(complaints, []);
    return { page, end };
}

/** Returns how many colours the picture has. A blank one has a single colour. */
const colours = (page) => page.evaluate(async () => {
    const image = new Image(), canvas = document.createElement("canvas"), context = canvas.getContext("2d");
    image.src = document.getElementById("sand").toDataURL();
    await image.decode();
    [canvas.width, canvas.height] = [image.width, image.height];
    context.drawImage(image, 0, 0);
    return new Set(new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer)).size;
});

/** The button colours what has changed since the start. A TIN has no such picture. */
async function cutAndFill(page) {
    const picture = () => page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(() => resolve(document.getElementById("sand").toDataURL())))));
    if (await page.$eval("#cut", (button) => button.disabled)) {
        return;
    }
    const plain = await picture();
    await press(page, "#cut");
    assert.notEqual(await picture(), plain, "cut and fill shows nothing");
    await press(page, "#cut");
    assert.equal(await picture(), plain, "cut and fill stays");
}

/** Bad files leave the session as it is, and the page says what to do. Then goes on with a good one. */
async function badFiles(page, good) {
    const input = await page.$("#files"), before = await page.evaluate(() => ({ ...document.body.dataset }));
    const bytes = fs.readFileSync(good), put = (label, content) => {
        const file = path.join(folder, label);
        fs.writeFileSync(file, content);
        return file;
    };
    const changed = (at, to) => Buffer.concat([bytes.subarray(0, at), Buffer.from([to]), bytes.subarray(at + 1)]);
    const bad = [[put("empty.journal", ""), /is empty/], [put("text.journal", "no journal at all"), /not a Sandwall journal/],
                 [put("other.journal", changed(4, 77)), /A page cannot run another release/], [put("header.journal", changed(60, bytes[60] ^ 1)), /its header is cut off or damaged/]];
    for (const [file, sentence] of bad) {
        await page.evaluate(() => { delete document.body.dataset.problem; });
        await input.uploadFile(file);
        await page.waitForFunction("document.body.dataset.problem", { timeout: 30_000 });
        const { problem, hash, matches } = await page.evaluate(() => ({ ...document.body.dataset }));
        assert.match(problem, sentence);
        assert.deepEqual([hash, matches], [before.hash, before.matches], "the session stays");
        assert.equal(await input.evaluate(({ value }) => value), "", "a browser sends no event if the input still has a file of this name");
    }
    const late = Math.floor(bytes.length * 0.98);  // behind the header, which is most of a short session
    for (const [file, sentence] of [[put("torn.journal", bytes.subarray(0, bytes.length - 3)), /incomplete write/], [put("damaged.journal", changed(late, bytes[late] ^ 1)), /damaged at byte/]]) {
        await page.evaluate(() => { document.body.dataset.passed = "no"; });
        await input.uploadFile(file);
        // On a loaded machine the session before may still say that it has passed, so the sentence is awaited first.
        await page.waitForFunction((pattern) => new RegExp(pattern).test(document.getElementById("say").textContent), { timeout: 120_000 }, sentence.source);
        assert.equal((await passed(page)).mismatches, "0");
    }
}

try {
    let last;
    for (const session of sessions) {
        if (last) {
            await last.page.close();
            last.end();
        }
        last = await open(session);
        assert.ok(await colours(last.page) > 100, "the picture shows sand");
        await cutAndFill(last.page);
    }
    await badFiles(last.page, path.join(folder, sessions.at(-1)[0]));
    last.end();
    console.log(`${name}: ${sessions.length} sessions equal the native program's, and bad files leave the page as it was`);
} finally {
    await browser.close();
}
process.exit(0);
