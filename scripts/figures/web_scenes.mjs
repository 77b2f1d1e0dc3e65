// SPDX-License-Identifier: Apache-2.0
// Makes the small pictures of scenes with which the page begins. usage: node scripts/figures/web_scenes.mjs web/page/pictures
// Needs the page (scripts/web.sh) and Chromium.
import fs from "node:fs";
import path from "node:path";
import { launch, serve } from "../../tests/web/browser.mjs";

const kWidth = 176, kHeight = 110;  // twice what the page shows
const kEye = { dunes: "0,0.22,0.36,0,-0.03,0.04", ripples: "0,0.2,0.33,0,-0.03,0.03", writing: "0,0.24,0.3,0,-0.02,0.02" };

const [folder] = process.argv.slice(2), browser = await launch("chromium"), { address, end } = await serve();
fs.mkdirSync(folder, { recursive: true });
try {
    for (const [scene, eye] of Object.entries(kEye)) {
        const context = await browser.createBrowserContext(), page = await context.newPage();
        await page.setViewport({ width: 4 * kWidth, height: 4 * kHeight + 100 });
        await page.goto(`${new URL(address).origin}/?dig=${scene}&view=${eye}`);
        await page.waitForFunction("document.body.dataset.hand && document.body.dataset.view && document.body.dataset.step > 2");
        if (scene === "writing") {
            const { x, y, width, height } = await (await page.$("#sand")).boundingBox(), at = (u, v) => [x + u * width, y + v * height];
            await page.mouse.move(...at(0.28, 0.45));
            await page.mouse.down();
            for (let i = 1; i <= 20; ++i) {
                await page.mouse.move(...at(0.28 + 0.022 * i, 0.45 - 0.14 * Math.sin(i / 2.5)));
                await new Promise((resolve) => setTimeout(resolve, 30));
            }
            await page.mouse.up();
            await page.mouse.move(...at(0.99, 0.02));
            await new Promise((resolve) => setTimeout(resolve, 2000));
        }
        await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
        const bytes = await page.evaluate(async (width, height) => {
            const sand = document.getElementById("sand"), small = Object.assign(document.createElement("canvas"), { width, height });
            const part = Math.min(sand.width, sand.height * width / height);
            small.getContext("2d").drawImage(sand, (sand.width - part) / 2, (sand.height - part * height / width) / 2, part, part * height / width, 0, 0, width, height);
            return small.toDataURL("image/webp", 0.75).split(",")[1];
        }, kWidth, kHeight);
        const file = path.join(folder, `${scene}.webp`);
        fs.writeFileSync(file, Buffer.from(bytes, "base64"));
        console.log(file, fs.statSync(file).size, "bytes");
        await context.close();
    }
} finally {
    await browser.close();
    end();
}
process.exit(0);
