// SPDX-License-Identifier: Apache-2.0
// Bundles the page. usage: node build.mjs OUT
import { build } from "esbuild";
import { copyFileSync, readdirSync } from "node:fs";
import { basename, join } from "node:path";

const out = process.argv[2];
await build({
    entryPoints: ["page/page.ts", "page/worker.ts", "page/page.css"], outdir: out, bundle: true, minify: true, format: "esm", target: "es2022",
    define: { SCENES: JSON.stringify(readdirSync("../scenes").filter((name) => name.endsWith(".toml")).map((name) => basename(name, ".toml")).sort()) },
    loader: { ".glsl": "text", ".webp": "dataurl" }, external: ["./replica.mjs"], legalComments: "linked", logLevel: "warning",
});
copyFileSync("page/index.html", join(out, "index.html"));
