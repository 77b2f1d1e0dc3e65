// SPDX-License-Identifier: Apache-2.0
// Opens an address of the page in a browser, waits until its first pass has ended, prints what it has counted, and takes a
// picture of the whole page. usage: node tests/web/browse.mjs chromium|firefox ADDRESS PICTURE.png [WIDTH HEIGHT [SCALE]]
import { complaintsOf, launch, passed } from "./browser.mjs";

const [name, address, picture, width = "1280", height = "720", scale = "1"] = process.argv.slice(2);
const browser = await launch(name);
let complaints = [];
try {
    const page = await browser.newPage();
    complaints = complaintsOf(page, address);
    await page.setViewport({ width: Number(width), height: Number(height), deviceScaleFactor: Number(scale), isMobile: name === "chromium" && Number(width) < 600, hasTouch: Number(width) < 600 });
    await page.goto(address);
    console.log(name, await browser.version(), JSON.stringify(await passed(page)));
    await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 1000)));
    await page.screenshot({ path: picture });
} finally {
    await browser.close();
}
for (const complaint of complaints) {
    console.error(complaint);
}
process.exit(complaints.length > 0 ? 1 : 0);
