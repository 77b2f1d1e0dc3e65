// SPDX-License-Identifier: Apache-2.0
// A browser with the page, and the page's server, for scripts.
import { spawn } from "node:child_process";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

export const root = fileURLToPath(new URL("../../", import.meta.url));
const require = createRequire(new URL("../../web/package.json", import.meta.url));
const puppeteer = require("puppeteer-core").default ?? require("puppeteer-core");

/**
 * Starts `chromium` or `firefox`, with further preferences of Firefox, or with a profile folder of Chromium. It needs a display
 * for its WebGL, such as that of xvfb-run.
 */
export function launch(name, { webgl = true, prefs = {}, userDataDir } = {}) {
    if (name === "firefox") {
        return puppeteer.launch({
            browser: "firefox", executablePath: "/usr/bin/firefox-esr", headless: !process.env.DISPLAY,
            extraPrefsFirefox: { ...prefs, ...(webgl ? { "webgl.force-enabled": true } : { "webgl.disabled": true }) },
        });
    }
    const drawing = webgl ? ["--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader"] : ["--disable-gpu", "--disable-3d-apis"];
    return puppeteer.launch({ executablePath: "/usr/bin/chromium", headless: true, userDataDir, protocolTimeout: 600_000, args: ["--no-sandbox", ...drawing] });
}

/** Serves the page with a session, or without one. Returns its address and a function that ends the server. */
export async function serve(session) {
    const server = spawn("python3", [`${root}scripts/sandwall`, "web", "--port", "0", ...(session ? [session] : [])], { stdio: ["ignore", "pipe", "inherit"] });
    const address = await new Promise((resolve, reject) => {
        server.stdout.once("data", (line) => resolve(String(line).trim()));
        server.once("exit", () => reject(new Error("sandwall web has ended")));
    });
    const kill = () => server.kill();
    process.once("exit", kill);  // of a test that fails, too
    return { address, end: () => { process.off("exit", kill); kill(); } };
}

/** Collects what a page complains about: errors, and requests to other servers. */
export function complaintsOf(page, address) {
    const complaints = [], origin = new URL(address).origin;
    // A part of a journal that does not exist is how the page finds the last one. Tests open `?dig=none` to begin without a scene.
    page.on("console", (message) => {
        const { url = "" } = message.location(), text = `${message.text()} (${url})`;
        if (message.type() === "error" && !/404 .*(\.journal\.\d+|\/none\.scene)\)$/.test(text)) {
            complaints.push(text);
        }
    });
    page.on("pageerror", (error) => complaints.push(String(error)));
    page.on("request", (request) => { if (!request.url().startsWith(origin) && !/^(data|blob):/.test(request.url())) { complaints.push(`a request to ${request.url()}`); } });
    return complaints;
}

/** Waits until the first pass has ended and its last step is shown, or there is a problem. Returns the page's dataset. */
export async function passed(page, patience = 240_000) {
    await page.waitForFunction("document.body.dataset.problem || (document.body.dataset.passed === 'yes' && document.body.dataset.shown === document.body.dataset.steps)",
                               { timeout: patience });
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    return page.evaluate(() => ({ ...document.body.dataset }));
}

/** Presses a control of the drawer as a person does, and closes the drawer again. */
export async function press(page, id) {
    await page.click("#more");
    await page.click(id);
    if (await page.$eval("#more", (more) => more.getAttribute("aria-expanded") === "true")) {
        await page.click("#more");
    }
}
