// SPDX-License-Identifier: Apache-2.0
// Opens the page in a browser, waits until its first pass has ended, and compares what it has counted.
// usage: node tests/web/browse.mjs chromium|firefox ADDRESS HASHES LAST_HASH [PICTURE.png [WIDTH HEIGHT]]
// Firefox needs a display for its WebGL, such as that of xvfb-run.
import { createRequire } from "node:module";

const require = createRequire(new URL("../../web/package.json", import.meta.url));
const puppeteer = require("puppeteer-core").default ?? require("puppeteer-core");
const [name, address, hashes, hash, picture, width = "1280", height = "720"] = process.argv.slice(2);
const kPatienceMs = 240_000;

const browser = await puppeteer.launch(
    name === "firefox"
        ? { browser: "firefox", executablePath: "/usr/bin/firefox-esr", headless: !process.env.DISPLAY, extraPrefsFirefox: { "webgl.force-enabled": true } }
        : { executablePath: "/usr/bin/chromium", headless: true, args: ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader"] });
const complaints = [];
try {
    const page = await browser.newPage();
    page.on("console", (message) => { if (message.type() === "error" && !/\.journal\.\d+$/.test(message.location().url ?? "")) { complaints.push(message.text()); } });
    page.on("pageerror", (error) => complaints.push(String(error)));
    page.on("request", (request) => { if (!request.url().startsWith(new URL(address).origin) && !request.url().startsWith("data:")) { complaints.push(`a request to ${request.url()}`); } });
    await page.setViewport({ width: Number(width), height: Number(height) });
    await page.goto(address);
    await page.waitForFunction("document.body.dataset.problem || (document.body.dataset.passed === 'yes' && document.body.dataset.shown === document.body.dataset.steps)", { timeout: kPatienceMs });
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    const found = await page.evaluate(() => ({ ...document.body.dataset }));
    console.log(name, await browser.version(), JSON.stringify(found));
    if (picture) {
        await page.screenshot({ path: picture });
    }
    if (found.problem || found.mismatches !== "0" || found.matches !== hashes || found.hash !== hash) {
        complaints.push(`expected ${hashes} matches and the hash ${hash}`);
    }
} finally {
    await browser.close();
}
for (const complaint of complaints) {
    console.error(complaint);
}
process.exit(complaints.length > 0 ? 1 : 0);
