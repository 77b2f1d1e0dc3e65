// SPDX-License-Identifier: Apache-2.0
// Bundles the page. usage: node build.mjs OUT
import { build } from "esbuild";
import { copyFileSync } from "node:fs";
import { join } from "node:path";

const out = process.argv[2];
await build({
    entryPoints: ["page.ts", "worker.ts"], outdir: out, bundle: true, minify: true, format: "esm", target: "es2022",
    loader: { ".glsl": "text" }, external: ["./replica.mjs"], legalComments: "linked", logLevel: "warning",
});
for (const name of ["index.html", "page.css"]) {
    copyFileSync(name, join(out, name));
}
