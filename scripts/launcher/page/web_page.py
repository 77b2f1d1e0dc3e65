# SPDX-License-Identifier: Apache-2.0
"""sandwall web: serves the web page, and the journal of a session, on this machine alone (docs/web.md)."""

import contextlib
import http.server
import io
import os
import sys
import threading
import time

from base import layout
from base.bad_input import BadInput
from base.command_line import at_least
from page import web_files

HOST = "127.0.0.1"
USUAL_PORT = 7263  # a browser keeps the sand of each address, so this is the same each time; the letters S A N D of a telephone
# The policy of index.html. A worker obeys only that of its own file, so every answer has it.
POLICY = ("default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; style-src 'self'; "
          "img-src data:")
NO_FRAME = "; frame-ancestors 'none'"  # a browser obeys it in a header alone
PIECE = 1 << 20  # [byte]
MOST_CONNECTIONS = 32  # each has a thread; a browser opens about six
REQUEST_SECONDS = 15  # for the whole of a request, with the wait before it
PIECE_SECONDS = 30  # for a client to take a piece of a file
BUSY = f"HTTP/1.1 503 Service Unavailable\r\nContent-Security-Policy: {POLICY}{NO_FRAME}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n"


def names_of(port):
    """Returns what a browser of this machine sends as Host."""
    names = {f"{name}:{port}" for name in (HOST, "localhost")}
    return names | {HOST, "localhost"} if port == 80 else names


class Request(io.RawIOBase):
    """The bytes that a client sends. A request may take REQUEST_SECONDS, however slowly its bytes come."""

    def __init__(self, connection):
        super().__init__()
        self.connection = connection
        self.begin()

    def begin(self):
        self.deadline = time.monotonic() + REQUEST_SECONDS

    def readable(self):
        return True

    def readinto(self, buffer):
        left = self.deadline - time.monotonic()
        if left <= 0:
            raise TimeoutError
        self.connection.settimeout(left)
        return self.connection.recv_into(buffer)


class Handler(http.server.BaseHTTPRequestHandler):
    """Answers GET and HEAD for the files of the page and the parts of the journal. All else does not exist."""

    server_version, sys_version = "sandwall", ""
    protocol_version = "HTTP/1.1"

    def setup(self):
        super().setup()
        self.rfile.close()
        self.request_bytes = Request(self.connection)
        self.rfile = io.BufferedReader(self.request_bytes)

    def handle_one_request(self):
        self.request_bytes.begin()
        super().handle_one_request()

    def opened(self):
        path = self.path.partition("?")[0]
        for source in self.server.sources:
            try:
                if found := source.opened(path):
                    return found
            except OSError:  # it is missing, or another kind of file
                return None
        return None

    def answer(self, with_bytes):
        # A page of another site could reach this server under a name of its own that leads to this machine.
        if self.headers.get("Host") not in self.server.names:
            return self.refuse(403)
        found = self.opened()
        if found is None:
            return self.refuse(404)
        self.connection.settimeout(PIECE_SECONDS)  # of each sendall()
        with open(found[0], "rb", buffering=0) as stream, self.ending():
            # A running session appends. The length is that of now, so that the answer is whole.
            length = os.fstat(stream.fileno()).st_size
            self.begin(200, length, found[1])
            while with_bytes and length > 0:
                piece = stream.read(min(PIECE, length))
                if not piece:
                    self.close_connection = True
                    return None
                self.wfile.write(piece)
                length -= len(piece)
        return None

    @contextlib.contextmanager
    def ending(self):
        """Ends the connection if the file cannot be read, or the client does not take the bytes."""
        try:
            yield
        except OSError:
            self.close_connection = True

    def begin(self, status, length, kind=None):
        self.send_response(status)
        if kind is not None:
            self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(length))
        self.send_header("Cache-Control", "no-store")
        self.send_header("Content-Security-Policy", POLICY + NO_FRAME)
        self.send_header("X-Content-Type-Options", "nosniff")
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()

    def refuse(self, status):
        with self.ending():
            self.begin(status, 0)

    def send_error(self, code, *_):  # the name that http.server calls, for a request that it cannot read
        self.close_connection = True
        self.refuse(code)

    def do_GET(self):  # the name that http.server calls
        self.answer(True)

    def do_HEAD(self):
        self.answer(False)

    def log_message(self, *_):
        pass


class Server(http.server.ThreadingHTTPServer):
    """Serves a web_files.Page, and a web_files.Journal unless that is None, to at most MOST_CONNECTIONS clients at once."""

    daemon_threads = True
    request_queue_size = MOST_CONNECTIONS

    def __init__(self, port, page, journal):
        super().__init__((HOST, port), Handler)
        self.sources = [page, *([journal] if journal else [])]
        self.names = names_of(self.server_port)
        self.places = threading.BoundedSemaphore(MOST_CONNECTIONS)

    def process_request(self, request, client_address):
        if not self.places.acquire(blocking=False):
            with contextlib.suppress(OSError):  # the client has gone
                request.settimeout(0)
                request.send(BUSY.encode())
            return self.shutdown_request(request)
        try:
            return super().process_request(request, client_address)
        except RuntimeError:  # no thread can be started
            self.places.release()
            return self.shutdown_request(request)

    def process_request_thread(self, request, client_address):
        try:
            super().process_request_thread(request, client_address)
        finally:
            self.places.release()

    def handle_error(self, request, client_address):
        # An OSError means that the client has gone, or was too slow. Everything else is a fault of ours.
        if not isinstance(sys.exc_info()[1], OSError):
            super().handle_error(request, client_address)


def page_folder():
    """Returns the folder of the built page. Throws BadInput if it is not there."""
    folder = layout.SHARED / "web" if layout.INSTALLED else layout.ROOT / "build" / "web" / "page"
    if not folder.is_dir():
        raise BadInput(f"{folder}: the page is not there; {web_files.MEND}")
    return folder


def server_at(port, page, journal):
    """Returns a server at `port`; if that is None, at USUAL_PORT, or at a free port if another program has it."""
    if port is None:
        with contextlib.suppress(OSError):
            return Server(USUAL_PORT, page, journal)
    return Server(port or 0, page, journal)


def serve(args):
    journal = None if args.session is None else web_files.Journal(args.session)
    page = web_files.Page(page_folder())
    try:
        server = server_at(args.port, page, journal)
    except (OSError, OverflowError) as error:
        raise BadInput(f"port {USUAL_PORT if args.port is None else args.port}: cannot be used ({getattr(error, 'strerror', None) or error}); choose another --port") from error
    with server:
        query = f"?journal={web_files.JOURNAL}" if journal else ""
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
    command.add_argument("--port", type=at_least(int, 0), default=None,
                         help=f"port of the page (default: {USUAL_PORT}, at which a browser finds the sand that it keeps; 0: a free one)")
