// SPDX-License-Identifier: Apache-2.0
// Compares the page's picture with the wall's, from the same eye, at the last step of sessions (docs/web.md).
// usage: node scripts/figures/web_pictures.mjs OUT JOURNAL...
// Leaves OUT/NAME_wall.png, NAME_page.png and NAME_difference.png, and prints a line for each session. Needs the built
// programs, the page and Chromium. Fails if the mean difference of a session is more than 0.4 levels. The page draws every cell,
// so the sessions should have look.detail = 0.
import { execFile } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { promisify } from "node:util";
import { launch, passed, root, serve } from "../../tests/web/browser.mjs";

const [out, ...journals] = process.argv.slice(2);
const kWidth = 1280, kHeight = 720, kMost = 0.4;  // [level]
fs.mkdirSync(out, { recursive: true });

// The desktop's stage, before an eye in the middle of the glass whose picture has the page's angle of 35 degrees.
const desktop = fs.readFileSync(path.join(root, "walls/configs/desktop.toml"), "utf8");
const centre = desktop.match(/^centre = \[(.*)\]$/m)[1].split(",").map(Number), tilt = Number(desktop.match(/^tilt_deg = (.*)$/m)[1]) * Math.PI / 180;
const eye = [0, 0.9995, 0.299 / 2 / Math.tan(17.5 * Math.PI / 180)];
const wide = 0.299 * kWidth / kHeight;
const wall = path.join(out, "wall.toml");
fs.writeFileSync(wall, desktop.replace(/^eye = .*$/m, `eye = [${eye}]`)
    .replace(/^tile_size = .*$/m, `tile_size = [${wide}, 0.299]`).replace(/^lower_left = .*$/m, `lower_left = [${-wide / 2}, 0.85, 0.0]`));
// The page's room is not tilted: turn the eye instead. It looks along -z of the wall's room.
const turned = ([x, y, z]) => [x, y * Math.cos(tilt) + z * Math.sin(tilt), z * Math.cos(tilt) - y * Math.sin(tilt)];
const eyeOfPage = turned(eye.map((n, i) => n - centre[i])), ahead = turned([0, 0, -0.6]);
const view = [...eyeOfPage, ...eyeOfPage.map((n, i) => n + ahead[i])].join(",");

async function wallPicture(journal, name) {
    const film = path.join(out, "film");
    fs.rmSync(film, { recursive: true, force: true });
    await promisify(execFile)("python3", [path.join(root, "scripts/sandwall"), "film", journal, "--wall", wall, "--out", film, "--gl-threads", "2"]);
    const last = fs.readdirSync(film).filter((file) => /^frame_.*\.png$/.test(file)).sort().at(-1);
    fs.copyFileSync(path.join(film, last), path.join(out, `${name}_wall.png`));
    fs.rmSync(film, { recursive: true });
}

/** Draws the page's picture. */
async function pagePicture(browser, journal, name) {
    const { address, end } = await serve(journal);
    const page = await browser.newPage();
    try {
        // The wall takes one sample of each pixel, and a page smooths its edges.
        await page.evaluateOnNewDocument(() => {
            const contextOf = HTMLCanvasElement.prototype.getContext;
            HTMLCanvasElement.prototype.getContext = function (kind, options) { return contextOf.call(this, kind, { ...options, antialias: false }); };
        });
        await page.setViewport({ width: kWidth, height: kHeight + 200 });
        await page.goto(`${address}&view=${view}`);
        const found = await passed(page);
        if (found.problem || found.mismatches !== "0") {
            throw new Error(`${name}: ${JSON.stringify(found)}`);
        }
        // Gives the sand the wall's pixels.
        await page.evaluate(([width, height]) => { Object.assign(document.getElementById("sand").style, { position: "fixed", width: `${width}px`, height: `${height}px` }); }, [kWidth, kHeight]);
        await page.waitForFunction((width, height) => {
            const canvas = document.getElementById("sand");
            return canvas.width === width && canvas.height === height;
        }, {}, kWidth, kHeight);
        await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
        const data = await page.evaluate(() => document.getElementById("sand").toDataURL("image/png"));
        fs.writeFileSync(path.join(out, `${name}_page.png`), Buffer.from(data.split(",")[1], "base64"));
    } finally {
        await page.close();
        end();
    }
}

/** Compares two pictures in the browser, which reads PNG. A pixel that both leave empty does not count. */
async function compare(browser, name) {
    const read = (which) => "data:image/png;base64," + fs.readFileSync(path.join(out, `${name}_${which}.png`)).toString("base64");
    const page = await browser.newPage();
    const result = await page.evaluate(async (addresses) => {
        const pixels = [];
        for (const address of addresses) {
            const image = new Image();
            image.src = address;
            await image.decode();
            const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext("2d");
            context.drawImage(image, 0, 0);
            pixels.push(context.getImageData(0, 0, image.width, image.height));
        }
        const [wall, page] = pixels;
        if (wall.width !== page.width || wall.height !== page.height) {
            throw new Error(`${wall.width} x ${wall.height} and ${page.width} x ${page.height}`);
        }
        const difference = document.createElement("canvas"), counts = new Array(256).fill(0);
        [difference.width, difference.height] = [wall.width, wall.height];
        const shown = new ImageData(wall.width, wall.height);
        let sum = 0, number = 0;
        for (let i = 0; i < wall.data.length; i += 4) {
            const background = [wall, page].every(({ data }) => [0, 1, 2].every((c) => data[i + c] === data[c]));
            shown.data[i + 3] = 255;
            for (let c = 0; c < 3; ++c) {
                const off = Math.abs(wall.data[i + c] - page.data[i + c]);
                shown.data[i + c] = Math.min(255, 6 * off);
                if (!background) {
                    sum += off;
                    ++number;
                    ++counts[off];
                }
            }
        }
        difference.getContext("2d").putImageData(shown, 0, 0);
        const quantile = (share) => {
            let rest = share * number, level = 0;
            while (rest > counts[level]) {
                rest -= counts[level++];
            }
            return level;
        };
        return { mean: sum / number, p99: quantile(0.99), share: number / wall.data.length * 4 / 3, picture: difference.toDataURL("image/png") };
    }, [read("wall"), read("page")]);
    await page.close();
    fs.writeFileSync(path.join(out, `${name}_difference.png`), Buffer.from(result.picture.split(",")[1], "base64"));
    return result;
}

const browser = await launch("chromium");
let failed = false;
try {
    for (const journal of journals) {
        const name = path.basename(path.resolve(journal)) === "session.journal" ? path.basename(path.dirname(path.resolve(journal))) : path.basename(journal, ".journal");
        await Promise.all([pagePicture(browser, journal, name), wallPicture(journal, name)]);
        const { mean, p99, share } = await compare(browser, name);
        failed ||= !(mean <= kMost);
        console.log(`${name}: mean ${mean.toFixed(2)} levels, 99 % within ${p99}, ${(100 * share).toFixed(0)} % of the picture is no background`);
    }
} finally {
    await browser.close();
}
process.exit(failed ? 1 : 0);
