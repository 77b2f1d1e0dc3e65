# SPDX-License-Identifier: Apache-2.0
"""sandwall web: serves the web page, and the journal of a session, on this machine alone (docs/web.md)."""

import http.server
import os
import pathlib
import re

import layout
from command_line import at_least
from rank_hosts import BadInput

HOST = "127.0.0.1"
TYPES = {".html": "text/html; charset=utf-8", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css",
         ".wasm": "application/wasm", ".txt": "text/plain; charset=utf-8",
         ".scene": "application/octet-stream"}
# The policy of index.html. A worker obeys only that of its own file, so every answer has it.
POLICY = ("default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; style-src 'self'; "
          "img-src data:")
JOURNAL = "/session/session.journal"
PART = re.compile(re.escape(JOURNAL) + r"(?:\.([1-9][0-9]{0,8}))?")
PIECE = 1 << 20  # [byte]


def files_of(page):
    """Returns {path of a request: file} of the page."""
    files = {"/" + path.name: path for path in page.iterdir() if path.is_file() and path.suffix in TYPES}
    files["/"] = page / "index.html"
    return files


def names_of(port):
    """Returns what a browser of this machine sends as Host."""
    names = {f"{name}:{port}" for name in (HOST, "localhost")}
    return names | {HOST, "localhost"} if port == 80 else names


class Handler(http.server.BaseHTTPRequestHandler):
    """Answers GET and HEAD for the files of the page and the parts of the journal. All else does not exist."""

    server_version, sys_version = "sandwall", ""
    protocol_version = "HTTP/1.1"
    timeout = 30  # [s]

    def found(self):
        path = self.path.partition("?")[0]
        if path in self.server.files:
            return self.server.files[path]
        part = PART.fullmatch(path)
        if part is None or self.server.journal is None:
            return None
        number = part.group(1)
        if number is None:
            return self.server.journal if self.server.journal.is_file() else None
        file = pathlib.Path(f"{self.server.journal}.{number}")
        # The user has named the first part alone. A link beside it could lead to any file.
        return file if number != "1" and file.is_file() and not file.is_symlink() else None

    def answer(self, with_bytes):
        # A page of another site could reach this server under a name of its own that leads to this machine.
        if self.headers.get("Host") not in self.server.names:
            return self.refuse(403)
        file = self.found()
        if file is None:
            return self.refuse(404)
        try:
            with open(file, "rb") as stream:
                # A running session appends. The length is that of now, so that the answer is whole.
                length = os.fstat(stream.fileno()).st_size
                self.send_response(200)
                self.send_header("Content-Type", TYPES.get(file.suffix, "application/octet-stream"))
                self.send_header("Content-Length", str(length))
                self.send_header("Cache-Control", "no-store")
                self.send_header("Content-Security-Policy", POLICY)
                self.send_header("X-Content-Type-Options", "nosniff")
                self.end_headers()
                while with_bytes and length > 0:
                    piece = stream.read(min(PIECE, length))
                    if not piece:
                        self.close_connection = True
                        return None
                    self.wfile.write(piece)
                    length -= len(piece)
        except OSError:
            self.close_connection = True
        return None

    def refuse(self, status):
        self.send_response(status)
        self.send_header("Content-Length", "0")
        self.end_headers()

    def do_GET(self):  # the name that http.server calls
        self.answer(True)

    def do_HEAD(self):
        self.answer(False)

    def log_message(self, *_):
        pass


class Server(http.server.ThreadingHTTPServer):
    daemon_threads = True

    def __init__(self, port, page, journal):
        super().__init__((HOST, port), Handler)
        self.journal = journal
        self.files = files_of(page)
        self.names = names_of(self.server_port)


def page_folder():
    """Returns the folder of the built page. Throws BadInput if it is not there."""
    folder = layout.SHARED / "web" if layout.INSTALLED else layout.ROOT / "build" / "web" / "page"
    if not (folder / "index.html").is_file() or not (folder / "replica.wasm").is_file():
        raise BadInput(f"{folder}: the page is not there; " + ("install a package that has it" if layout.INSTALLED else "run scripts/web.sh"))
    return folder


def serve(args):
    journal = None
    if args.session is not None:
        journal = pathlib.Path(layout.journal_at(args.session))
        if not journal.is_file():
            raise BadInput(f"{journal}: no journal; name a session's folder or its session.journal")
    page = page_folder()
    try:
        server = Server(args.port, page, journal)
    except (OSError, OverflowError) as error:
        raise BadInput(f"port {args.port}: cannot be used ({getattr(error, 'strerror', None) or error}); choose another --port") from error
    with server:
        query = f"?journal={JOURNAL}" if journal else ""
        print(f"http://{HOST}:{server.server_port}/{query}", flush=True)
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            pass
    return 0


def add_parser(commands):
    command = commands.add_parser("web", help="show a session in a web page that computes it again",
                                  description="Serves the web page on this machine alone, and prints its address; docs/web.md.")
    command.set_defaults(run=serve)
    command.add_argument("session", metavar="SESSION", nargs="?", help="session's folder, or its session.journal")
    command.add_argument("--port", type=at_least(int, 0), default=0, help="port of the page (default: a free one)")
