#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests what `sandwall web` serves, and what it refuses."""

import http.client
import pathlib
import re
import sys
import tempfile
import threading
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "launcher"))
import web_page  # noqa: E402
from rank_hosts import BadInput  # noqa: E402


class WebPage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        page, session = self.root / "page", self.root / "session"
        page.mkdir()
        session.mkdir()
        for name, text in (("index.html", "page"), ("replica.wasm", "wasm"), ("secret.key", "secret")):
            (page / name).write_text(text)
        (session / "session.journal").write_bytes(b"first")
        (session / "session.journal.2").write_bytes(b"second")
        (session / "summary.json").write_text("{}")
        (session / "session.journal.3").symlink_to(page / "secret.key")
        self.server = web_page.Server(0, page, session / "session.journal")
        self.addCleanup(self.server.server_close)
        thread = threading.Thread(target=self.server.serve_forever)
        thread.start()
        self.addCleanup(thread.join)
        self.addCleanup(self.server.shutdown)

    def header(self, path, name):
        connection = http.client.HTTPConnection("127.0.0.1", self.server.server_port, timeout=20)
        self.addCleanup(connection.close)
        connection.request("GET", path)
        return connection.getresponse().getheader(name)

    def answer(self, path, method="GET", host=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.server.server_port, timeout=20)
        connection.putrequest(method, path, skip_host=True)
        connection.putheader("Host", host or f"127.0.0.1:{self.server.server_port}")
        connection.endheaders()
        answer = connection.getresponse()
        found = answer.status, answer.getheader("Content-Type"), answer.read()
        connection.close()
        return found

    def test_the_page_has_its_types(self):
        self.assertEqual(self.answer("/"), (200, "text/html; charset=utf-8", b"page"))
        self.assertEqual(self.answer("/?journal=/session/session.journal"), (200, "text/html; charset=utf-8", b"page"))
        self.assertEqual(self.answer("/replica.wasm"), (200, "application/wasm", b"wasm"))
        self.assertEqual(self.answer("/replica.wasm", "HEAD"), (200, "application/wasm", b""))

    def test_the_journal_has_its_parts(self):
        self.assertEqual(self.answer("/session/session.journal")[::2], (200, b"first"))
        self.assertEqual(self.answer("/session/session.journal.2")[::2], (200, b"second"))
        for missing in ("/session/session.journal.1", "/session/session.journal.3", "/session/session.journal.02"):
            self.assertEqual(self.answer(missing)[0], 404, missing)

    def test_a_running_session_is_served_as_long_as_it_is_now(self):
        with open(self.root / "session" / "session.journal", "ab") as stream:
            stream.write(b" and more")
        self.assertEqual(self.answer("/session/session.journal")[2], b"first and more")

    def test_nothing_else_is_served(self):
        for path in ("/secret.key", "/session/", "/session/summary.json", "/session", "/../session/summary.json", "/%2e%2e/session/summary.json",
                     "//etc/passwd", "/session/session.journal/..", "/session/session.journal.2/../summary.json", "/page/index.html"):
            self.assertEqual(self.answer(path)[0], 404, path)
        self.assertEqual(self.answer("/", "POST")[0], 501)

    def test_a_malformed_address_is_missing(self):
        for path in ("http://[::1/x", "http://[::1/session/session.journal", "?", "*"):
            self.assertEqual(self.answer(path)[0], 404, path)

    def test_every_file_has_the_policy_of_the_page(self):
        html = (ROOT / "web" / "index.html").read_text(encoding="utf-8")
        policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]+)"', html).group(1)
        for path in ("/", "/replica.wasm", "/session/session.journal.2"):
            self.assertEqual(self.header(path, "Content-Security-Policy"), policy, path)

    def test_at_port_80_a_browser_leaves_out_the_port(self):
        self.assertEqual(web_page.names_of(80), {"127.0.0.1", "127.0.0.1:80", "localhost", "localhost:80"})
        self.assertEqual(self.answer("/", host="localhost")[0], 403)

    def test_a_name_of_another_site_is_refused(self):
        for host in ("evil.example", f"evil.example:{self.server.server_port}", "127.0.0.1:1"):
            self.assertEqual(self.answer("/", host=host)[0], 403, host)
        self.assertEqual(self.answer("/", host=f"localhost:{self.server.server_port}")[0], 200)

    def test_it_listens_on_this_machine_alone(self):
        self.assertEqual(self.server.server_address[0], "127.0.0.1")

    def test_a_busy_port_and_a_missing_session_are_one_line(self):
        class Args:
            session, port = None, self.server.server_port
        page_folder, web_page.page_folder = web_page.page_folder, lambda: self.root / "page"
        self.addCleanup(setattr, web_page, "page_folder", page_folder)
        with self.assertRaisesRegex(BadInput, f"^port {Args.port}: cannot be used .*; choose another --port$"):
            web_page.serve(Args)
        Args.session = str(self.root / "nothing")
        with self.assertRaisesRegex(BadInput, "nothing: no journal; name a session's folder or its session.journal$"):
            web_page.serve(Args)


if __name__ == "__main__":
    unittest.main()
