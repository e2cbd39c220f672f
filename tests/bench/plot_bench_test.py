"""tools/plot_bench.py draws the results that are kept in docs/results, and tells what it cannot draw.

plot_bench_test.py SOURCE_FOLDER
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

source = pathlib.Path(sys.argv[1])
script = source / "tools/plot_bench.py"


def plot(*arguments):
    return subprocess.run([script, *arguments], capture_output=True, text=True)


def read_texts(file):
    """All texts of a picture, which has to be well formed."""
    return [text.text for text in xml.parse(file).getroot().iter("{http://www.w3.org/2000/svg}text") if text.text]


def count_bars(file, color):
    return file.read_text().count(f"fill: {color}")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    for suite in ("paper1/cpu", "paper3/cpu"):
        shutil.copy(source / "docs/results" / suite / (suite.split("/")[0] + ".json"), folder)
    done = plot(folder)
    assert done.returncode == 0, done.stderr
    files = sorted(file.name for file in folder.glob("*.svg"))
    result = json.loads((folder / "paper3.json").read_text())
    scenes = [f"paper3_{scene['scene']}.svg" for scene in result["scenes"]]
    expected = [f"paper1_{part}.svg" for part in ("table1", "figure1_7", "figure1_9", "figure1_10")] + ["paper3_bytes.svg", *scenes]
    assert files == sorted(expected), files
    assert done.stdout.count("wrote ") == len(files), done.stdout

    # A bar for each measure with its value, what was refused with its reason, the words of the paper below.
    result = json.loads((folder / "paper1.json").read_text())
    texts = read_texts(folder / "paper1_figure1_7.svg")
    for scene in result["figure1_7"]:
        assert scene["scene"] in texts, texts
    measured = [v for scene in result["figure1_7"] for v in scene["variants"] if v["outcome"] == "measured"]
    refused = sum(len(scene["variants"]) for scene in result["figure1_7"]) - len(measured)
    assert refused > 0 and sum(text.startswith("not made: ") for text in texts) == refused, texts
    assert count_bars(folder / "paper1_figure1_7.svg", "#009e73") == len(measured) + 1, "bottom cast: bars and the legend"
    assert any(text.startswith("Paper: pre-tessellation is faster only for Pumpkin") for text in texts), texts
    assert "52 GB" in read_texts(folder / "paper1_table1.svg")

    # The same bits again.
    before = (folder / "paper1_table1.svg").read_bytes()
    assert plot(folder / "paper1.json").returncode == 0
    assert (folder / "paper1_table1.svg").read_bytes() == before

    # What came back from a machine with a GPU.
    (folder / "gpu").mkdir()
    (folder / "gpu/relief-gpu.json").write_text(json.dumps({"parts": {"bench": {"result": result}}}))
    assert plot(folder / "gpu").returncode == 0
    assert (folder / "gpu/paper1_table1.svg").read_bytes() == before

    # A baseline that does not tell its stages has its reason there, and one that lacks a stage is no fault.
    def make_program(speed, stages):
        return {"samples_per_s": {"median": speed, "lowest": 0.9 * speed, "highest": 1.1 * speed},
                "stages": {stage: {"seconds": {"median": 1}} for stage in stages}}

    settings = {"engine": "cpu", "width": 8, "height": 4, "samples": 2, "bounces": 4, "threads": 1, "runs": 1}
    (folder / "frame").mkdir()
    (folder / "frame/frame.json").write_text(json.dumps({
        "suite": "frame", "baseline": "old", "settings": settings, "machine": {"processor": ""}, "build": {"commit": ""},
        "cases": [{"scene": "bark", "isa": "avx2", "relief": make_program(3e6, ["shade", "film"]),
                   "baseline": make_program(1.5e6, [])},
                  {"scene": "party", "isa": None, "relief": make_program(7, ["shade"]), "baseline": make_program(8, ["bake"])}]}))
    assert plot(folder / "frame").returncode == 0
    texts = read_texts(folder / "frame/frame_speed.svg")
    assert {"1.5 M/s", "3 M/s", "7 /s", "avx2 baseline", "relief"} <= set(texts), texts
    texts = read_texts(folder / "frame/frame_stages.svg")
    assert texts.count("not told") == 1 and {"shading", "film", "bake"} <= set(texts), texts
    assert count_bars(folder / "frame/frame_stages.svg", "#0072b2") == 3 + 1, "shading: bars, of no height too, and the legend"

    # Suites without charts are no error; what is no result is one.
    (folder / "edits").mkdir()
    (folder / "edits/edits.json").write_text('{"suite": "edits"}')
    assert plot(folder / "edits").returncode == 0
    (folder / "edits/edits.json").write_text('{"suite": "none"}')
    done = plot(folder / "edits")
    assert done.returncode == 1 and "no result of `relief bench`" in done.stderr, done
    assert plot().returncode == 1
