"""The viewer in a real window, on a display without a screen: window_test.py RELIEF [FOLDER keeps what was made].

Opens the pumpkin, turns it, changes its scale, paints a stroke, takes it back, makes it again and saves; what is saved
renders to the viewer's picture, bit for bit. Frames of a shot are shown, slid over and played: they are those that
`relief render` makes. Then mistakes: no display, a script with a wrong line.
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
SIZE = "320x180"
SCRIPT = [
    {"wait": "picture"},
    {"wait": "done"},
    {"screenshot": "opened.png"},
    {"picture": "opened.exr"},
    {"drag": "middle", "from": [140, 90], "to": [200, 100], "seconds": 1},
    {"wait": "done"},
    {"set": {"scale": 1.4}},
    {"wait": "picture"},
    {"wait": "done"},
    {"picture": "scaled.exr"},
    {"set": {"tool": "push", "radius": 30, "brush_strength": 1}},
    {"drag": "left", "from": [130, 80], "to": [190, 95], "seconds": 0.3},
    {"wait": "picture"},
    {"wait": "done"},
    {"screenshot": "painted.png"},
    {"picture": "painted.exr"},
    {"key": "Z", "modifiers": ["control"]},
    {"wait": "done"},
    {"picture": "undone.exr"},
    {"key": "Y", "modifiers": ["control"]},
    {"wait": "done"},
    {"key": "f1"},
    {"wait": 0.3},
    {"screenshot": "help.png"},
    {"picture": "seen.exr"},
    {"save": "saved.json"},
    {"set": {"midlevel": 0.01}},
    {"key": "Q", "modifiers": ["control"]},
    {"wait": 0.5},
    {"screenshot": "question.png"},  # it asks, and does not end
    {"wait": 0.2},
    {"quit": True},
]
FRAMES = [
    {"wait": "done"},
    {"screenshot": "timeline.png"},
    {"frame": 7},
    {"wait": "done"},
    {"picture": "seen.0007.exr"},
    {"frame": 20},
    {"frame": 12},
    {"wait": "done"},
    {"picture": "seen.0012.exr"},
    {"key": "right"},
    {"wait": "done"},
    {"picture": "seen.0013.exr"},
    {"release": "left", "at": [225, 163]},  # the slider, once panels have seen the mouse there
    {"wait": 0.2},
    {"drag": "left", "from": [225, 163], "to": [310, 163], "seconds": 1},
    {"wait": "done"},
    {"picture": "slid.exr"},
    {"release": "left", "at": [140, 90]},
    {"wait": 0.2},
    {"play": 1},
    {"key": "space"},
    {"wait": 0.3},
    {"screenshot": "playing.png"},
    {"key": "space"},
    {"wait": "done"},
    {"drag": "middle", "from": [140, 90], "to": [160, 95], "seconds": 0.3},
    {"key": "left", "modifiers": ["shift"]},
    {"wait": "done"},
    {"screenshot": "turned.png"},
    {"picture": "turned.exr"},
    {"save": "turned.json"},
    {"quit": True},
]


def start_display():
    """Xvfb and the name of its display."""
    reading, writing = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "1400x900x24", "-nolisten", "tcp"],
                              pass_fds=[writing], stderr=subprocess.DEVNULL)
    os.close(writing)
    with os.fdopen(reading) as stream:
        return server, ":" + stream.readline().strip()


class Viewer:
    def __init__(self, relief, folder, display):
        self.relief, self.folder = relief, folder
        self.environment = {**os.environ, "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1"}

    def run(self, *words, environment=None):
        return subprocess.run([self.relief, *map(str, words)], cwd=self.folder, text=True, capture_output=True, timeout=900,
                              env=environment or self.environment)

    def run_script(self, lines, *words):
        (self.folder / "script.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
        return self.run("view", *words, "--script", "script.jsonl", "--size", SIZE, "--spp", 4)

    def compare(self, a, b):
        """The number of pixels that differ in colour."""
        result = self.run("compare", a, b, "--threshold", 0, "--json")
        assert result.returncode in (0, 7), result.stderr
        return json.loads(result.stdout)["over_threshold"]


def check_session(viewer):
    made = viewer.run("scene", "pumpkin", "-o", "pumpkin")
    assert made.returncode == 0, made.stderr
    result = viewer.run_script(SCRIPT, "pumpkin/scene.json")
    print(result.stdout, result.stderr)
    assert result.returncode == 0, result.stderr
    lines = [json.loads(line) for line in result.stdout.splitlines()]
    assert "first_picture_s" in lines[0]
    drag = next(line for line in lines if line.get("step") == "drag")
    assert drag["pictures"] >= 3, drag
    for name in ("opened", "painted", "help", "question"):
        assert (viewer.folder / f"{name}.png").stat().st_size > 10000, name
    assert viewer.compare("scaled.exr", "painted.exr") > 300
    assert viewer.compare("scaled.exr", "undone.exr") == 0
    assert viewer.compare("opened.exr", "scaled.exr") > 300
    assert viewer.compare("painted.exr", "seen.exr") == 0
    rendered = viewer.run("render", "saved.json", "-o", "rendered.exr", "-q", "--layers", "depth,N,P,uv,id,cost")
    assert rendered.returncode == 0, rendered.stderr
    assert viewer.compare("seen.exr", "rendered.exr") == 0


def check_frames(viewer):
    """Frames of a shot are those of `relief render`; a camera that was moved stays."""
    made = viewer.run("scene", "shot", "-o", "shot")
    assert made.returncode == 0, made.stderr
    file = viewer.folder / "shot/scene.json"
    scene = json.loads(file.read_text())
    scene["camera"]["shutter"] = [0, 0]  # the viewer shows an instant
    file.write_text(json.dumps(scene))
    result = viewer.run_script(FRAMES, "shot/scene.json")
    print(result.stdout, result.stderr)
    assert result.returncode == 0, result.stderr
    lines = [json.loads(line) for line in result.stdout.splitlines()]
    played = next(line for line in lines if line.get("step") == "play")
    assert played["frames"] >= 2, played
    turned = [line for line in lines if line.get("step") == "drag"][-1]
    assert turned["pictures"] >= 1, turned
    options = ["-q", "--size", SIZE, "--spp", 4, "--layers", "depth,N,P,uv,id,cost"]
    rendered = viewer.run("render", "shot/scene.json", "--frames", "7,12,13,24", "-o", "rendered.####.exr", *options)
    assert rendered.returncode == 0, rendered.stderr
    for frame in (7, 12, 13):
        assert viewer.compare(f"seen.{frame:04}.exr", f"rendered.{frame:04}.exr") == 0, frame
    assert viewer.compare("slid.exr", "rendered.0024.exr") == 0
    assert viewer.compare("rendered.0007.exr", "rendered.0012.exr") > 300
    saved = viewer.run("render", "turned.json", "-o", "saved.exr", *options)
    assert saved.returncode == 0, saved.stderr
    assert viewer.compare("turned.exr", "saved.exr") == 0


def check_mistakes(viewer):
    blind = {name: value for name, value in viewer.environment.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    result = viewer.run("view", "pumpkin/scene.json", environment=blind)
    assert result.returncode == 4, (result.returncode, result.stderr)
    assert "relief render" in result.stderr, result.stderr
    result = viewer.run_script([{"wait": "done"}, {"set": {"scael": 1}}], "pumpkin/scene.json")
    assert result.returncode == 3, (result.returncode, result.stderr)
    assert "script.jsonl:2" in result.stderr and "scale" in result.stderr, result.stderr
    result = viewer.run_script([{"wait": "done"}, {"set": {"tool": "hammer"}}], "pumpkin/scene.json")
    assert result.returncode == 3 and "script.jsonl:2" in result.stderr, (result.returncode, result.stderr)
    result = viewer.run("view", "pumpkin/scene.json", "--script", "pumpkin")  # a folder
    assert result.returncode == 3 and "pumpkin" in result.stderr, (result.returncode, result.stderr)
    result = viewer.run("view", "nowhere.json")
    assert result.returncode == 3, (result.returncode, result.stderr)
    result = viewer.run("view", "--spq", "3")
    assert result.returncode == 2 and "--spp" in result.stderr, (result.returncode, result.stderr)


def check_signal(viewer):
    """A signal ends the viewer as a user does."""
    (viewer.folder / "waits.jsonl").write_text('{"wait": "picture"}\n{"screenshot": "waits.png"}\n{"wait": 60}\n')
    (viewer.folder / "waits.png").unlink(missing_ok=True)  # of an earlier run
    process = subprocess.Popen([viewer.relief, "view", "pumpkin/scene.json", "--size", "64x36", "--script", "waits.jsonl"],
                               cwd=viewer.folder, env=viewer.environment)
    until = time.monotonic() + 60
    while not (viewer.folder / "waits.png").exists() and time.monotonic() < until:
        time.sleep(0.1)
    assert (viewer.folder / "waits.png").exists()
    process.send_signal(signal.SIGTERM)
    assert process.wait(30) == 128 + signal.SIGTERM
    result = viewer.run("view", "pumpkin/meshes/pumpkin.obj", "--vdm", "nowhere.exr")
    assert result.returncode == 3 and "nowhere.exr" in result.stderr, (result.returncode, result.stderr)


def main():
    if not shutil.which("Xvfb"):
        print("no Xvfb: not run")
        raise SystemExit(SKIPPED)
    server, display = start_display()
    try:
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else temporary)
            folder.mkdir(parents=True, exist_ok=True)
            viewer = Viewer(os.path.abspath(sys.argv[1]), folder, display)
            start = time.monotonic()
            check_session(viewer)
            check_frames(viewer)
            check_mistakes(viewer)
            check_signal(viewer)
            print(f"{time.monotonic() - start:.1f} s")
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main()
