// SPDX-License-Identifier: Apache-2.0
// Tests which files of a server the page takes for parts of a journal. The servers answer paths that do not exist in
// every way that web servers do.
import assert from "node:assert/strict";
import http from "node:http";
import { builtModule } from "./built_module.mjs";

const { fetchJournal } = await builtModule("page/session_files.ts");
const kPage = "\ufeff<!DOCTYPE html>\n<title>Sandwall</title>";

/** Fetches /s.journal from a server with these files. Returns how many parts the page got or what it says, and the paths that it asked for. */
async function fetched(files, missing) {
    const asked = [];
    const server = http.createServer(({ url }, answer) => {
        asked.push(url);
        const [status, body] = url in files ? [200, files[url]] : missing;
        answer.writeHead(status).end(body);
    });
    await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
    globalThis.location = new URL(`http://127.0.0.1:${server.address().port}/`);
    let told;
    await fetchJournal("/s.journal", { tell: ({ open }) => { told = open.parts.map((part) => Buffer.from(part).toString()); }, problem: (text) => { told = text; } });
    server.closeAllConnections();
    server.close();
    return [told, asked];
}

const first = "SWJL, part one", second = "SWJL, part two";
const servers = [[404, "not here"], [200, kPage], [200, "<html>"], [200, ""], [200, "SWJ"], [200, "Not found"], [200, '{"error": 404}']];
for (const missing of servers) {
    assert.deepEqual(await fetched({ "/s.journal": first }, missing), [[first], ["/s.journal", "/s.journal.2"]], missing[1]);
    assert.deepEqual(await fetched({ "/s.journal": first, "/s.journal.2": second, "/s.journal.4": second }, missing),
                     [[first, second], ["/s.journal", "/s.journal.2", "/s.journal.3"]], missing[1]);
}
for (const [missing, why] of [[[404, "not here"], "does not have it"], [[200, kPage], "sends a web page in its place"], [[200, ""], "sends an empty file"],
                              [[200, "Not found"], "sends a file of another kind"]]) {
    assert.deepEqual(await fetched({}, missing), [`/s.journal: the server ${why}; check the address`, ["/s.journal"]]);
}
console.log(`the page asks ${servers.length} kinds of servers for one part more than they have`);
