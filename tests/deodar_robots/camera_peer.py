"""A camera on this machine for tests: a server of JPEG pictures over HTTP, and peers that fail."""

from __future__ import annotations

import base64
import http.server
import socket
import threading
import time

import cv2
import numpy as np


class PeerServer(http.server.ThreadingHTTPServer):
    """A server whose pictures are grey; each is brighter than the one before.

    Attributes:
        sent: pictures sent to all clients.
        stalled: while set, the connection stays and no picture is sent.
        ended: once set, the connections are closed.
        login: USER:PASSWORD that a client has to state; empty: none.
        size: width and height in pixels.
        asked: paths that clients asked for.
        clients: connections that are open now.
    """

    daemon_threads = True

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), _Peer)
        self.sent, self.clients, self.login, self.size = 0, 0, "", (64, 48)
        self.asked: list[str] = []
        self.stalled, self.ended = threading.Event(), threading.Event()
        threading.Thread(target=self.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True).start()

    @property
    def place(self) -> str:
        """Host and port."""
        return f"127.0.0.1:{self.server_port}"

    def picture(self) -> bytes:
        """Return the next picture."""
        self.sent += 1
        grey = np.full((self.size[1], self.size[0], 3), self.sent % 250, np.uint8)
        return cv2.imencode(".jpg", grey)[1].tobytes()

    def handle_error(self, request: object, client_address: object) -> None:
        """A client that leaves is no error."""


class _Peer(http.server.BaseHTTPRequestHandler):
    server: PeerServer  # pyright: ignore[reportIncompatibleVariableOverride]

    def log_message(self, format: str, *args: object) -> None:
        """Write nothing."""

    def do_GET(self) -> None:
        peer = self.server
        peer.asked.append(self.path)
        expected = "Basic " + base64.b64encode(peer.login.encode()).decode()
        if peer.login and self.headers.get("Authorization") != expected:
            self.send_response(401)
            self.send_header("WWW-Authenticate", 'Basic realm="camera"')
            self.send_header("Content-Length", "0")
            self.end_headers()
            return
        if self.path.startswith("/text"):
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(b"<html>no pictures</html>")
            return
        if self.path.startswith("/none"):
            self.send_error(404)
            return
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=picture")
        self.end_headers()
        peer.clients += 1
        try:
            while not peer.ended.is_set():
                if not peer.stalled.is_set():
                    jpeg = peer.picture()
                    head = f"--picture\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n"
                    self.wfile.write(head.encode() + jpeg + b"\r\n")
                time.sleep(0.03)
        finally:
            peer.clients -= 1


def silent() -> socket.socket:
    """Return a socket that accepts connections and sends nothing."""
    waiting = socket.socket()
    waiting.bind(("127.0.0.1", 0))
    waiting.listen()
    return waiting


def free_port() -> int:
    """Return a port at which nothing listens."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
