// SPDX-License-Identifier: Apache-2.0
// Tests that Chromium without WebGL computes and compares a session, and says that it has no picture.
// usage: node tests/web/no_picture_test.mjs JOURNAL
import assert from "node:assert/strict";
import { complaintsOf, launch, passed, serve } from "./browser.mjs";

const browser = await launch("chromium", { webgl: false }), { address, end } = await serve(process.argv[2]);
try {
    const page = await browser.newPage(), complaints = complaintsOf(page, address);
    await page.goto(address);
    const found = await passed(page);
    assert.deepEqual([found.problem, found.mismatches, found.matches], [undefined, "0", found.hashes]);
    assert.match(await page.$eval("#say", (say) => say.textContent), /the same sand as the wall, ([0-9]+) of \1 times.* no WebGL 2/);
    assert.ok(await page.$eval("#picture", (button) => button.disabled));
    assert.deepEqual(complaints.filter((line) => !/WebGL/.test(line)), []);
    console.log("without WebGL: all hashes equal, and the page says that it has no picture");
} finally {
    await browser.close();
    end();
}
process.exit(0);
