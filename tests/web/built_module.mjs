// SPDX-License-Identifier: Apache-2.0
// A source of the page as a module of node, for tests and measurements.
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const root = new URL("../../", import.meta.url);

/** Compiles a source of web/, such as "replica/keyframes.ts", and loads it. */
export async function builtModule(source) {
    const { buildSync } = createRequire(new URL("web/package.json", root))("esbuild");
    const built = buildSync({ entryPoints: [fileURLToPath(new URL(`web/${source}`, root))], bundle: true, format: "esm", write: false, loader: { ".glsl": "text" } });
    return import(`data:text/javascript;base64,${Buffer.from(built.outputFiles[0].contents).toString("base64")}`);
}
