"""The viewer for browsers, without a browser: serve_test.py RELIEF.

Pictures refine, two viewers see the same, a drag turns the camera of both, wrong tokens and wrong messages are refused, a
viewer that goes away without a word leaves the others well, foreign pages and crowds do no harm, and a signal ends it.
"""
import base64
import http.client
import json
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse

from small_scene import write_small_scene

PATIENCE = 120


def await_true(is_true, what):
    """Asks until the answer is one that counts as true, and returns it."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        answer = is_true()
        if answer:
            return answer
        time.sleep(0.02)
    raise AssertionError(f"not within {PATIENCE} s: {what}")


class Page:
    """What the page of a browser does."""
    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        self.port, self.token = parts.port, urllib.parse.parse_qs(parts.query)["token"][0]
        self.version = 0
        self.socket = None

    def get(self, path, method="GET", body=None, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        connection.request(method, path, body, headers)
        answer = connection.getresponse()
        return answer.status, dict(answer.getheaders()), answer.read()

    def current_picture(self):
        """(text, JPEG) of the picture that there is; nothing where there is none yet."""
        status, headers, jpeg = self.get(f"/picture?token={self.token}&after=0")
        assert status in (200, 204), status
        return (urllib.parse.unquote(headers["X-Relief-Text"]), jpeg) if status == 200 else None

    def next_picture(self):
        """(text, JPEG) of the next picture."""
        def ask():
            status, headers, jpeg = self.get(f"/picture?token={self.token}&after={self.version}")
            if status == 204:
                return None
            assert status == 200, status
            self.version = int(headers["X-Relief-Version"])
            return urllib.parse.unquote(headers["X-Relief-Text"]), jpeg
        return await_true(ask, "another picture")

    def last_picture(self, text):
        """Pictures until one whose text begins so."""
        def ask():
            told, jpeg = self.next_picture()
            return jpeg if told.startswith(text) else None
        return await_true(ask, f"a picture with the text {text}")

    def open_events(self, token=None):
        self.socket = socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET /events?token={token or self.token} HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\n"
                             f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        return self.socket.recv(4096).split(b"\r\n")[0]

    def send(self, text):
        data = text.encode()
        mask = os.urandom(4)
        size = struct.pack("!B", 0x80 | len(data)) if len(data) < 126 else struct.pack("!BH", 0x80 | 126, len(data))
        self.socket.sendall(b"\x81" + size + mask + bytes(b ^ mask[k % 4] for k, b in enumerate(data)))

    def send_event(self, kind, x, y, **more):
        self.send(json.dumps({"kind": kind, "x": x, "y": y, "button": 0, "shift": False, "control": False, "alt": False, **more}))

    def drag(self, x0, y0, x1, y1, steps=8):
        self.send_event("press", x0, y0)
        for k in range(1, steps + 1):
            self.send_event("move", x0 + (x1 - x0) * k / steps, y0 + (y1 - y0) * k / steps)
            time.sleep(0.01)
        self.send_event("release", x1, y1)

    def click(self, x, y):
        self.send_event("press", x, y)
        self.send_event("release", x, y)


def await_same(pages, text, old=None):
    """The picture with that text that all pages see, another one than an old one."""
    def ask():
        seen = {page.current_picture() for page in pages}
        if len(seen) > 1 or None in seen:
            return None
        told, jpeg = seen.pop()
        return jpeg if told.startswith(text) and jpeg != old else None
    return await_true(ask, f"one picture with the text {text} for all")


def check_refusals(url):
    """Other methods, pages of other places, and names that were made to lead here."""
    page = Page(url)
    path, host = f"/?token={page.token}", f"127.0.0.1:{page.port}"
    status, headers, body = page.get(path, "HEAD")
    assert status == 200 and int(headers["Content-Length"]) > 1000 and body == b""
    for method in ("POST", "PUT", "DELETE", "OPTIONS", "TRACE", "get"):
        status, headers, _ = page.get(path, method, b"x" * 100_000 if method == "POST" else None)
        assert status == 405 and headers["Allow"] == "GET, HEAD", (method, status)
    for name in (host, "localhost", "localhost:9999", "LOCALHOST:1", "[::1]:80"):
        assert page.get(path, Host=name)[0] == 200, name
    for name in ("evil.example", f"127.0.0.1.evil.example:{page.port}", "localhost:", "127.0.0.1:80@evil.example", ""):
        assert page.get(path, Host=name)[0] == 403, name
    assert page.get(path, Host=host, Origin=f"http://{host}")[0] == 200
    for origin in ("http://evil.example", "null", f"https://{host}", "http://127.0.0.1", ""):
        assert page.get(path, Host=host, Origin=origin)[0] == 403, origin
    for text in (b"GET\r\n\r\n", b"\r\n\r\n", b"GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\n\r\n",
                 b"GET /" + b"x" * 20000, b"\x16\x03\x01" * 100 + b"\r\n\r\n"):
        with socket.create_connection(("127.0.0.1", page.port), timeout=PATIENCE) as connection:
            connection.sendall(text)
            assert b" 400 " in connection.recv(4096).split(b"\r\n")[0], text[:40]


def check_crowds(url):
    """The page is answered beside silent connections, requests that wait, and answers that nobody reads."""
    page = Page(url)
    page.last_picture("4 of 4")
    crowd = [socket.create_connection(("127.0.0.1", page.port), timeout=PATIENCE) for _ in range(500)]
    try:
        for k, connection in enumerate(crowd[:300]):
            what = f"/picture?token={page.token}&after={page.version if k % 2 else 0}"
            connection.sendall(f"GET {what} HTTP/1.1\r\nHost: localhost\r\n".encode() + (b"\r\n" if k % 3 else b""))
        for _ in range(5):
            assert page.get(f"/?token={page.token}")[0] == 200
            assert page.current_picture()[0].startswith("4 of 4")
        crowd[-1].setblocking(False)
        try:
            crowd[-1].recv(1)
            raise AssertionError("answered only when the silent ones were given up")
        except BlockingIOError:
            pass
    finally:
        for connection in crowd:
            connection.close()


def check_viewers(url):
    first, second = Page(url), Page(url)
    status, _, page = first.get(f"/?token={first.token}")
    assert status == 200 and b"<img" in page
    for path in ("/", "/?token=", "/?token=" + first.token[:-1], "/picture", f"/picture?token={'0' * 32}"):
        assert first.get(path)[0] == 403, path
    assert b"101" not in first.open_events("0" * 32)
    _, small = first.next_picture()
    assert small[:2] == b"\xff\xd8" and len(small) > 500
    whole = await_same((first, second), "4 of 4")
    assert b"101" in first.open_events()
    for nonsense in ("", "{", "[]", '{"kind": "quit"}', '{"kind": "press"}', '{"kind": "key", "key": "S"}', "x" * 5000):
        first.send(nonsense)
    first.drag(0.3, 0.5, 0.6, 0.55)
    turned = await_same((first, second), "4 of 4", whole)
    first.click(0.5, 0.5)
    first.last_picture("pixel")
    first.send_event("key", 0, 0, key="escape")
    assert await_same((first, second), "4 of 4") == turned
    # Gone without a word.
    first.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    first.socket.close()
    assert b"101" in second.open_events()
    second.drag(0.6, 0.5, 0.5, 0.5)
    await_same((second,), "4 of 4", turned)


def start_server(relief, folder, size, samples):
    """The viewer, and the address that it prints."""
    write_small_scene(folder)
    viewer = subprocess.Popen([relief, "view", "scene.json", "--size", size, "--spp", str(samples), "--serve", "0"],
                              cwd=folder, text=True, stdout=subprocess.PIPE)
    timer = threading.Timer(PATIENCE, viewer.kill)
    timer.start()
    url = viewer.stdout.readline().strip()
    timer.cancel()
    assert url, f"no address, exit code {viewer.wait(PATIENCE)}"
    return viewer, url


def main():
    relief = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        viewer, url = start_server(relief, folder, "160x90", 4)
        try:
            check_viewers(url)
            check_refusals(url)
            check_crowds(url)
            port = urllib.parse.urlsplit(url).port
            taken = subprocess.run([relief, "view", "scene.json", "--serve", str(port)], cwd=folder, text=True,
                                   capture_output=True, timeout=PATIENCE)
            assert taken.returncode == 1 and str(port) in taken.stderr, taken.stderr
            pathlib.Path(folder, "bad.obj").write_text("root:x:0:0:root:/root:/bin/bash\n")
            bad = subprocess.run([relief, "view", "bad.obj", "--serve", "0"], cwd=folder, text=True, capture_output=True,
                                 timeout=PATIENCE)
            assert bad.returncode == 3 and "bad.obj" in bad.stderr, bad.stderr
            viewer.send_signal(signal.SIGTERM)
            assert viewer.wait(PATIENCE) == 128 + signal.SIGTERM
            assert not pathlib.Path(folder, "scene-view.json").exists()  # pages change no files
        finally:
            viewer.kill()
            viewer.wait()


if __name__ == "__main__":
    main()
