#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests what `sandwall web` serves, and what it refuses."""

import contextlib
import http.client
import io
import os
import pathlib
import re
import socket
import sys
import tempfile
import threading
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[4]
sys.path.insert(0, str(ROOT / "scripts" / "launcher"))
from job.rank_hosts import BadInput  # noqa: E402
from page import web_files, web_page  # noqa: E402

FIRST, SECOND = b"SWJL first", b"SWJL second"  # parts of a journal begin with this word


class WebPage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.page, self.session = self.root / "page", self.root / "session"
        self.page.mkdir()
        self.session.mkdir()
        for name, text in (("index.html", "page"), ("replica.wasm", "wasm"), ("page.js", "script"), ("secret.key", "secret")):
            (self.page / name).write_text(text)
        self.journal = self.session / "session.journal"
        self.journal.write_bytes(FIRST)
        (self.session / "session.journal.2").write_bytes(SECOND)
        (self.session / "summary.json").write_text("{}")
        self.secret = self.root / "secret"  # a journal of somebody else, so that its first bytes are right
        self.secret.write_bytes(b"SWJL secret")
        self.server = web_page.Server(0, web_files.Page(self.page), web_files.Journal(str(self.session)))
        self.addCleanup(self.server.server_close)
        thread = threading.Thread(target=self.server.serve_forever, args=(0.01,))
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
        self.assertEqual(self.answer("/session/session.journal"), (200, "application/octet-stream", FIRST))
        self.assertEqual(self.answer("/session/session.journal.2"), (200, "application/octet-stream", SECOND))
        for missing in ("/session/session.journal.1", "/session/session.journal.3", "/session/session.journal.02"):
            self.assertEqual(self.answer(missing)[0], 404, missing)

    def test_a_running_session_is_served_as_long_as_it_is_now(self):
        with open(self.journal, "ab") as stream:
            stream.write(b" and more")
        self.assertEqual(self.answer("/session/session.journal")[2], FIRST + b" and more")
        self.journal.unlink()
        self.journal.write_bytes(b"SWJL of the next session")
        self.assertEqual(self.answer("/session/session.journal")[2], b"SWJL of the next session")

    def test_a_link_in_the_session_is_never_followed(self):
        for name in ("session.journal", "session.journal.2", "session.journal.3"):
            (self.session / name).unlink(missing_ok=True)
            (self.session / name).symlink_to(self.secret)  # swapped in while the server runs
            self.assertEqual(self.answer(f"/session/{name}"), (404, None, b""), name)

    def test_a_link_in_the_page_is_never_followed(self):
        for name in ("index.html", "page.js"):
            (self.page / name).unlink()
            (self.page / name).symlink_to(self.page / "secret.key")
            self.assertEqual(self.answer(f"/{name}")[0], 404, name)
        self.assertEqual(self.answer("/")[0], 404)

    def test_the_folder_of_a_session_may_be_a_link_and_is_opened_once(self):
        link, other = self.root / "link", self.root / "other"
        link.symlink_to(self.session)
        other.mkdir()
        (other / "session.journal").write_bytes(b"SWJL other")
        journal = web_files.Journal(str(link))
        link.unlink()
        link.symlink_to(other)
        with open(journal.opened("/session/session.journal")[0], "rb") as stream:
            self.assertEqual(stream.read(), FIRST)

    def test_a_journal_that_is_named_may_be_a_link(self):
        link = self.root / "named"
        link.symlink_to(self.journal)
        journal = web_files.Journal(str(link))
        for path, content in (("/session/session.journal", FIRST), ("/session/session.journal.2", SECOND)):
            with open(journal.opened(path)[0], "rb") as stream:
                self.assertEqual(stream.read(), content)

    def test_no_byte_of_a_file_that_is_no_journal_is_served(self):
        for content in (b"", b"SWJ", b"root:x:0:0", b"\nSWJL"):
            self.journal.write_bytes(content)
            self.assertEqual(self.answer("/session/session.journal"), (404, None, b""), content)

    def test_pipes_sockets_and_folders_are_refused_without_waiting(self):
        def bind(path):
            listener = socket.socket(socket.AF_UNIX)
            self.addCleanup(listener.close)
            listener.bind(str(path))
        for make in (os.mkfifo, os.mkdir, bind):
            part = self.session / "session.journal.2"
            part.unlink() if part.is_file() else None
            make(part)
            self.assertEqual(self.answer("/session/session.journal.2")[0], 404, make)
            part.rmdir() if part.is_dir() else part.unlink()

    def test_a_second_name_of_another_users_file_is_refused(self):
        os.link(self.secret, self.session / "session.journal.3")
        self.assertEqual(self.answer("/session/session.journal.3")[0], 200, "a copy that this user has made with links")
        kept = os.fstat
        self.addCleanup(setattr, os, "fstat", kept)

        def of_another_user(descriptor):  # who owns the folder alone
            about = kept(descriptor)
            return about if descriptor != self.server.sources[1].folder else os.stat_result([*about[:4], about.st_uid + 1, *about[5:10]])
        os.fstat = of_another_user
        self.assertEqual(self.answer("/session/session.journal.3")[0], 404)
        self.assertEqual(self.answer("/session/session.journal.2")[0], 200)

    def test_nothing_else_is_served(self):
        for path in ("/secret.key", "/session/", "/session/summary.json", "/session", "/../session/summary.json", "/%2e%2e/session/summary.json",
                     "//etc/passwd", "/session/session.journal/..", "/session/session.journal.2/../summary.json", "/page/index.html"):
            self.assertEqual(self.answer(path)[0], 404, path)
        self.assertEqual(self.answer("/", "POST")[0], 501)

    def test_a_malformed_address_is_missing(self):
        for path in ("http://[::1/x", "http://[::1/session/session.journal", "?", "*"):
            self.assertEqual(self.answer(path)[0], 404, path)

    def test_every_file_has_the_policy_of_the_page(self):
        html = (ROOT / "web" / "page" / "index.html").read_text(encoding="utf-8")
        policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]+)"', html).group(1)
        for path in ("/", "/replica.wasm", "/session/session.journal.2", "/nothing"):
            self.assertEqual(self.header(path, "Content-Security-Policy"), policy + "; frame-ancestors 'none'", path)

    def connect(self):
        connection = socket.create_connection(("127.0.0.1", self.server.server_port), timeout=20)
        self.addCleanup(connection.close)
        return connection

    def test_connections_have_a_limit(self):
        before = threading.active_count()
        held = [self.connect() for _ in range(web_page.MOST_CONNECTIONS)]
        # A connection waits in a queue until the server takes it, in order.
        for _ in range(3):
            self.assertEqual(self.connect().recv(1000)[:13], b"HTTP/1.1 503 ")
        self.assertLessEqual(threading.active_count(), before + web_page.MOST_CONNECTIONS)
        held[0].close()
        status = None
        while status != 200:  # until the server has seen the end
            with contextlib.suppress(OSError, http.client.HTTPException):
                status = self.answer("/")[0]
        self.assertEqual(status, 200)

    def test_a_fault_of_the_server_is_printed_and_one_of_a_client_is_not(self):
        for error, lines in ((ConnectionResetError("gone"), 0), (TimeoutError("slow"), 0), (KeyError("a fault of ours"), 1)):
            with self.subTest(error=error), contextlib.redirect_stderr(io.StringIO()) as said:
                try:
                    raise error
                except type(error):
                    self.server.handle_error(None, ("127.0.0.1", 1))
            self.assertEqual(said.getvalue().count("a fault of ours"), lines, said.getvalue())
            self.assertEqual(said.getvalue() == "", lines == 0, said.getvalue())

    def test_a_request_has_its_time_in_all_however_slowly_it_comes(self):
        self.addCleanup(setattr, web_page, "REQUEST_SECONDS", web_page.REQUEST_SECONDS)
        web_page.REQUEST_SECONDS = 0.1
        for begin in (b"", b"GET / HTTP/1.1\r\n"):
            connection = self.connect()
            connection.sendall(begin)
            connection.settimeout(0.02)
            ended = False
            for _ in range(1000):
                try:
                    connection.sendall(b"X")
                    if ended := connection.recv(1) == b"":
                        break
                except TimeoutError:
                    continue
                except OSError:  # the server has closed it
                    ended = True
                    break
            self.assertTrue(ended, begin)

    def test_the_usual_port_is_used_unless_another_program_has_it(self):
        page = web_files.Page(self.page)
        self.addCleanup(setattr, web_page, "USUAL_PORT", web_page.USUAL_PORT)
        web_page.USUAL_PORT = self.server.server_port  # taken
        for port in (None, 0):
            with web_page.server_at(port, page, None) as other:
                self.assertNotIn(other.server_port, (0, web_page.USUAL_PORT))
                free = other.server_port
        web_page.USUAL_PORT = free
        with web_page.server_at(None, page, None) as usual:
            self.assertEqual(usual.server_port, free)
        with self.assertRaises(OSError):
            web_page.server_at(self.server.server_port, page, None)

    def test_at_port_80_a_browser_leaves_out_the_port(self):
        self.assertEqual(web_page.names_of(80), {"127.0.0.1", "127.0.0.1:80", "localhost", "localhost:80"})
        self.assertEqual(self.answer("/", host="localhost")[0], 403)

    def test_a_name_of_another_site_is_refused(self):
        for host in ("evil.example", f"evil.example:{self.server.server_port}", "127.0.0.1:1"):
            self.assertEqual(self.answer("/", host=host)[0], 403, host)
        self.assertEqual(self.answer("/", host=f"localhost:{self.server.server_port}")[0], 200)

    def test_it_listens_on_this_machine_alone(self):
        self.assertEqual(self.server.server_address[0], "127.0.0.1")

    def refused(self, named):
        with self.assertRaises(BadInput) as refusal:
            web_files.Journal(str(named))
        return str(refusal.exception).replace(str(self.root) + "/", "")

    def test_what_is_no_journal_at_the_start_is_one_line(self):
        advice = "; name a session's folder or its session.journal"
        self.assertEqual(self.refused(self.root / "nothing"), f"nothing: no journal{advice}")
        self.assertEqual(self.refused(self.page), f"page/session.journal: no journal{advice}")
        self.assertEqual(self.refused(self.page / "secret.key"), f"page/secret.key: is not a journal{advice}")
        self.journal.unlink()
        self.journal.symlink_to(self.secret)
        self.assertEqual(self.refused(self.session), f"session/session.journal: is a link, which is not followed{advice}")
        self.journal.unlink()
        os.mkfifo(self.journal)
        self.assertEqual(self.refused(self.session), f"session/session.journal: is not a regular file{advice}")
        self.assertEqual(self.refused(self.journal), f"session/session.journal: is not a regular file{advice}")
        (self.page / "index.html").unlink()
        (self.page / "index.html").symlink_to(self.secret)
        with self.assertRaisesRegex(BadInput, "index.html: cannot be served .is a link, which is not followed.; run scripts/web.sh$"):
            web_files.Page(self.page)

    def test_a_busy_port_and_a_missing_session_are_one_line(self):
        class Args:
            session, port = None, self.server.server_port
        page_folder, web_page.page_folder = web_page.page_folder, lambda: self.page
        self.addCleanup(setattr, web_page, "page_folder", page_folder)
        with self.assertRaisesRegex(BadInput, f"^port {Args.port}: cannot be used .*; choose another --port$"):
            web_page.serve(Args)
        Args.session = str(self.root / "nothing")
        with self.assertRaisesRegex(BadInput, "nothing: no journal; name a session's folder or its session.journal$"):
            web_page.serve(Args)


if __name__ == "__main__":
    unittest.main()
