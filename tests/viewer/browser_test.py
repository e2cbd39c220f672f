"""The page of `relief view --serve` in headless Chromium: browser_test.py RELIEF [FOLDER keeps a picture of the page].

The page loads, its picture refines and turns by the mouse, a second page sees the same, a wrong token is refused, and a
browser that is killed while it holds a button leaves the viewer well. Skipped where there is no Chromium. It is driven
through the pipe of its DevTools protocol: JSON that ends with a zero byte, read from file 3 and written to file 4.
"""
import base64
import json
import os
import pathlib
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from serve_test import Page, await_true, start_server

SKIPPED = 77
PATIENCE = 120
SAMPLES = 24
WIDTH, HEIGHT = 320, 180
PIXELS = """(() => {
  const picture = document.getElementById("picture"), canvas = document.createElement("canvas");
  canvas.width = picture.naturalWidth, canvas.height = picture.naturalHeight;
  canvas.getContext("2d").drawImage(picture, 0, 0);
  return canvas.toDataURL();
})()"""


class Browser:
    def __init__(self, program, folder):
        commands, self.output = os.pipe()
        self.input, answers = os.pipe()
        # Not 3 and 4 themselves: one could be closed by moving the other there.
        high = [os.dup2(file, number) for file, number in ((commands, 93), (answers, 94))]
        move = f"exec 3<&{high[0]} 4>&{high[1]}; exec \"$@\""
        self.process = subprocess.Popen(
            ["bash", "-c", move, "bash", program, "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run",
             "--disable-dev-shm-usage", f"--user-data-dir={folder}", "--window-size=700,500", "--remote-debugging-pipe"],
            pass_fds=high, stderr=subprocess.DEVNULL, start_new_session=True)
        for file in (commands, answers, *high):
            os.close(file)
        self.bytes, self.count = b"", 0

    def call(self, method, session=None, **parameters):
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters, **({"sessionId": session} if session else {})}
        os.write(self.output, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self.bytes:
                assert select.select([self.input], [], [], PATIENCE)[0], f"no answer to {method}"
                more = os.read(self.input, 1 << 20)
                assert more, "the browser has ended"
                self.bytes += more
            text, _, self.bytes = self.bytes.partition(b"\0")
            answer = json.loads(text)
            if answer.get("id") == self.count:
                assert "error" not in answer, answer
                return answer["result"]

    def open(self, url):
        target = self.call("Target.createTarget", url=url)["targetId"]
        return Tab(self, self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"])

    def kill(self):
        """All of its processes, at once."""
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()


class Tab:
    def __init__(self, browser, session):
        self.browser, self.session = browser, session

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def get(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)["result"]
        return result.get("value")

    def text(self):
        return self.get('document.getElementById("text")?.textContent') or ""

    def note_samples(self):
        """From now on the page notes what it tells of samples: a slow browser misses none."""
        self.get("""(() => {
            const line = document.getElementById("text");
            window.told = [];
            new MutationObserver(() => told.push(line.textContent))
                .observe(line, {childList: true, characterData: true, subtree: true});
        })()""")

    def noted_samples(self):
        return {text.split()[0] for text in self.get("told") if " of " in text}

    def is_whole(self):
        """All samples are told and a picture of the whole size is shown; and events can be sent."""
        return (self.text().startswith(f"{SAMPLES} of {SAMPLES}") and self.get("events.readyState") == 1 and
                self.get('document.getElementById("picture").naturalWidth') == WIDTH)

    def send_mouse(self, kind, x, y, button, buttons):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, buttons=buttons, clickCount=1)

    def hold(self, x0, y0, x1, y1, button="left", buttons=1, steps=6):
        self.call("Page.bringToFront")  # hidden pages get events late
        self.send_mouse("mousePressed", x0, y0, button, buttons)
        for k in range(1, steps + 1):
            self.send_mouse("mouseMoved", x0 + (x1 - x0) * k / steps, y0 + (y1 - y0) * k / steps, button, buttons)

    def drag(self, x0, y0, x1, y1):
        self.hold(x0, y0, x1, y1)
        self.send_mouse("mouseReleased", x1, y1, "left", 0)


def await_same(pages, old=None):
    """The whole picture that all pages show, another one than an old one."""
    def ask():
        seen = {page.get(PIXELS) if page.is_whole() else None for page in pages}
        return seen.pop() if len(seen) == 1 and seen.isdisjoint({None, old}) else None
    return await_true(ask, "one whole picture on all pages")


def check_pages(browser, url, folder):
    page = browser.open(url)
    second = browser.open(url)
    whole = await_same((page, second))
    page.note_samples()
    page.drag(100, 80, 220, 100)
    await_same((page, second), whole)
    samples = page.noted_samples()
    assert len(samples) > 1, f"the picture came at once: {samples}"
    (folder / "page.png").write_bytes(base64.b64decode(page.call("Page.captureScreenshot")["data"]))
    token = url.rpartition("=")[2]
    for wrong in (url.replace(token, "0" * len(token)), url.partition("?")[0]):
        stranger = browser.open(wrong)
        time.sleep(0.5)
        assert stranger.get('performance.getEntriesByType("navigation")[0].responseStatus') == 403
        assert stranger.get('document.getElementById("picture")') is None
    assert page.get('fetch("/picture?token=0&after=0").then(answer => answer.status)') == 403
    assert page.get(f'fetch("/picture?token={token}&after=0").then(answer => answer.status)') == 200
    return page


def check_kill(browser, page, url):
    """The button that the page held is free for other pages."""
    client = Page(url)
    old = client.current_picture()
    page.hold(100, 80, 160, 90, "right", 2)
    await_true(lambda: client.current_picture() != old, "a picture from another place")
    browser.kill()
    assert b"101" in client.open_events()
    def is_explained():
        client.click(0.5, 0.5)
        return client.current_picture()[0].startswith("pixel")
    await_true(is_explained, "an explanation")
    client.send_event("key", 0, 0, key="escape")
    client.last_picture(f"{SAMPLES} of {SAMPLES}")


def main():
    program = shutil.which("chromium")
    if not program:
        print("no Chromium: not run")
        raise SystemExit(SKIPPED)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as temporary:
        folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else temporary)
        folder.mkdir(parents=True, exist_ok=True)
        viewer, url = start_server(os.path.abspath(sys.argv[1]), temporary, f"{WIDTH}x{HEIGHT}", SAMPLES)
        browser = Browser(program, pathlib.Path(temporary, "profile"))
        try:
            page = check_pages(browser, url, folder)
            check_kill(browser, page, url)
            viewer.send_signal(signal.SIGTERM)
            assert viewer.wait(PATIENCE) == 128 + signal.SIGTERM
        finally:
            if browser.process.poll() is None:
                browser.kill()
            viewer.kill()
            viewer.wait()


if __name__ == "__main__":
    main()
