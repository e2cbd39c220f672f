#!/usr/bin/python3
"""Draws the results of `relief bench` as SVG, beside the file that they are in.

plot_bench.py PATH...    PATH: SUITE.json, the result of relief-gpu-bundle/run.sh, or a folder that holds such files
"""
import json
import pathlib
import sys

try:
    import matplotlib
    matplotlib.use("svg")
    from matplotlib import pyplot
    from matplotlib.ticker import FuncFormatter
except ImportError:
    sys.exit("matplotlib is not installed; on Debian: apt-get install --no-install-recommends python3-matplotlib")

# Told apart by those who see few colours (Okabe and Ito 2008).
COLORS = ["#0072b2", "#e69f00", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#f0e442", "#999999"]
FRAME_STAGES = {"top_traversal": "top and middle cast", "sort": "sort", "bottom_build": "bottom build",
                "bottom_traversal": "bottom cast", "shade": "shading", "film": "film"}
CAST_STAGES = dict(list(FRAME_STAGES.items())[:4])
SECONDS = [(1, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns")]
RATES = [(1e9, "G/s"), (1e6, "M/s"), (1e3, "k/s"), (1, "/s")]
BYTES = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "KB"), (1, "B")]  # decimal, as the papers count


def format_value(value, units):
    """1.234 seconds as "1.23 s", 52e9 bytes as "52 GB"."""
    if value == 0:
        return "0"
    size, name = next(((s, n) for s, n in units if value >= 0.9995 * s), units[-1])
    number = value / size
    return f"{number:.0f} {name}" if number >= 100 else f"{number:.3g} {name}"


def make_bar(label, values, summary=None, note=""):
    """One stack; `summary` has the spread of its sum."""
    spread = (summary["lowest"], summary["highest"]) if summary else None
    return {"label": label, "values": values, "spread": spread, "note": note}


def make_panel(title, bars, subtitle=""):
    return {"title": title, "subtitle": subtitle, "bars": bars}


def draw_bars(axes, panel, chart):
    units = chart.get("units", SECONDS)
    for place, bar in enumerate(panel["bars"]):
        height = 0
        for value, color in zip(bar["values"], COLORS):
            axes.bar(place, value, 0.66, bottom=height, color=color)
            height += value
        if bar["spread"]:
            axes.vlines(place, *bar["spread"], color="#222", linewidth=1)
        text, top = (bar["note"], 0) if bar["note"] else (format_value(height, units), height)
        if height > 0 or bar["note"]:
            axes.annotate(text, (place, max(top, bar["spread"][1] if bar["spread"] else 0)), (0, 3),
                          textcoords="offset points", ha="center", va="bottom", fontsize=7,
                          rotation=90 if bar["note"] else 0)
    axes.set_xticks(range(len(panel["bars"])), [bar["label"] for bar in panel["bars"]], rotation=40, ha="right", fontsize=8)
    axes.set_xlim(-0.6, max(len(panel["bars"]), 1) - 0.4)
    axes.set_title(panel["title"] + ("\n" + panel["subtitle"] if panel["subtitle"] else ""), fontsize=9)
    axes.margins(y=0.12)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: format_value(value, units)))
    axes.tick_params(axis="y", labelsize=8)
    axes.grid(axis="y", color="#ddd")
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def draw(chart, file):
    """Panels side by side, wider for more bars. On a logarithmic scale they share their axis."""
    panels = [panel for panel in chart["panels"] if panel["bars"]]
    # Inches. Fixed margins: to fit them to the text takes longer than all the rest.
    width, height = max(9, 1.6 + sum(0.5 * len(p["bars"]) + 1 for p in panels)), 5.6 + 0.16 * len(chart["notes"])
    figure = pyplot.figure(figsize=(width, height))
    figure.text(0.15 / width, 1 - 0.15 / height, chart["title"], fontsize=12, fontweight="bold", va="top")
    figure.text(0.15 / width, 1 - 0.75 / height, chart["axis"], fontsize=9, va="top", color="#555")
    handles = [pyplot.Rectangle((0, 0), 1, 1, color=color, label=label) for label, color in zip(chart["series"], COLORS)]
    figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(0, 1 - 0.35 / height), ncols=len(handles), fontsize=8,
                  frameon=False)
    figure.text(0.15 / width, 0.1 / height, "\n".join(chart["notes"]), fontsize=7, va="bottom", color="#555")
    if panels:
        below = 1.5 + 0.16 * len(chart["notes"])
        grid = figure.subplots(1, len(panels), squeeze=False, sharey="log" in chart, gridspec_kw={
            "width_ratios": [0.5 * len(p["bars"]) + 0.2 for p in panels], "wspace": 0.8 * len(panels) / (width - 1.6),
            "left": 0.9 / width, "right": 1 - 0.3 / width, "top": 1 - 1.5 / height, "bottom": below / height})
        for axes, panel in zip(grid[0], panels):
            if "log" in chart:
                axes.set_yscale("log")
            draw_bars(axes, panel, chart)
    save(figure, file)


def save(figure, file):
    figure.savefig(file, metadata={"Date": None})
    pyplot.close(figure)
    print(f"wrote {file}")


def get_stages(entry, stages):
    return [entry["stage_s"][stage]["median"] for stage in stages]


def make_names(entries, key, known, prefix):
    """Parts of file names: scenes of the user's may be called anything, and are numbered."""
    return [e[key] if e[key] in known else f"{prefix}{k}" for k, e in enumerate(entries)]


def chart_paper1(r):
    s, device = r["settings"], r["device"]
    where = (f"Relief {r['build']['commit']}, {device['name']} ({device['engine']}), {s['width']}x{s['height']}, "
             f"medians of {s['runs']} runs; level {s['level']}")
    whose = "time of the device" if device["engine"] == "vulkan" else f"summed over {device['threads']} threads"

    def notes(figure):
        return [where] + ["Paper: " + says["text"] for says in r["paper_says"] if says["about"] == figure]

    def stage_chart(title, what, stages, panels, lines):
        return {"title": title, "axis": f"{what}, {whose}", "series": list(stages.values()), "panels": panels, "notes": lines}

    def single(label, place, value):
        return make_bar(label, [0] * place + [value])

    rows = [make_panel(row["scene"], [single("direct", 0, row["direct"]["total_bytes"]),
                                      single("paper", 1, row["paper"]["direct_bytes"]),
                                      *(single(f"level {cost['level']}", 2, cost["total_bytes"])
                                        for cost in row["tessellated_estimate"]),
                                      single("paper", 3, row["paper"]["tessellated_bytes"])],
                       f"{row['patches']} patches, {row['direct']['bytes_a_patch']:.1f} bytes each") for row in r["table1_1"]]
    yield "paper1_table1", {"title": "Table 1.1: geometry and acceleration structures, direct against pre-tessellated",
                            "axis": "bytes, maps apart, logarithmic", "units": BYTES, "log": True, "panels": rows, "notes": [where],
                            "series": ["Relief, direct (allocated)", "paper, direct", "Relief, pre-tessellated (estimate)",
                                       "paper, pre-tessellated"]}

    def frame_bar(scene, variant):
        if variant.get("outcome", "measured") != "measured":
            return make_bar(variant["name"], [], note="not made: " + format_value(scene["tessellated_peak_bytes"], BYTES))
        return make_bar(variant["name"], get_stages(variant, FRAME_STAGES), variant["stages_total_s"])

    def frames(part):
        return [make_panel(scene["scene"], [frame_bar(scene, v) for v in scene["variants"]]) for scene in r[part]]

    yield "paper1_figure1_7", stage_chart("Figure 1.7: breakdown of a frame, one primary and one shadow ray a pixel",
                                          "time of a frame", FRAME_STAGES, frames("figure1_7"), notes("figure1_7"))

    def cast_bar(label, cast):
        return make_bar(label, get_stages(cast, CAST_STAGES), cast["total_s"])

    casts = [make_panel(scene["scene"], [cast_bar(("shadow" if cast["kind"] == "shadow" else "primary")
                                                  + (", cache" if v["name"] == "direct" else ""), cast)
                                         for v in scene["variants"] for cast in v["casts"]]) for scene in r["figure1_9"]]
    yield "paper1_figure1_9", stage_chart("Figure 1.9: top and middle cast, sort, bottom cast", "time of a cast", CAST_STAGES,
                                          casts, notes("figure1_9"))
    depths = [make_panel("with the cache" if v["name"] == "direct" else "no cache, as in the paper",
                         [cast_bar(f"{cast['depth']}{' (sh)' if cast['kind'] == 'shadow' else ''}", cast) for cast in v["casts"]])
              for scene in r["figure1_10"] for v in scene["variants"]]
    yield "paper1_figure1_10", stage_chart("Figure 1.10: casts by depth of the path, Bark in white",
                                           "time of a cast; (sh): shadow rays", CAST_STAGES, depths, notes("figure1_10"))
    if "bottom_forms" in r:
        yield "paper1_bottom_forms", stage_chart("A frame by form of the bottom level: split or fused", "time of a frame",
                                                 FRAME_STAGES, frames("bottom_forms"),
                                                 [where, "Fused: trees are built within the bottom cast."])


def chart_paper2(r):
    s, meshes = r["settings"], r["meshes"]
    where = (f"{s['engine']}, {meshes[0]['device'] if meshes else ''}, {s['threads'] or r['machine']['threads']} threads; "
             f"{s['width']} x {s['height']} primary rays; commit {r['build']['commit']}")

    def panels(make):
        return [make_panel(m["mesh"], [make(m, build) for build in m["builds"]], f"{m['triangles']} triangles") for m in meshes]

    def time_bar(_, build):
        name = build["tree"] + (" (device)" if build["built_on"] == "device" else "")
        return make_bar(name, [build["seconds"]["median"]], build["seconds"])

    def bytes_bar(mesh, build):
        return make_bar(build["tree"], [build["bytes_a_triangle"], build["link_bytes"] / mesh["triangles"]])

    yield "paper2_builds", {"title": "Building a tree", "axis": "time", "log": True, "series": ["build"],
                            "panels": panels(time_bar), "notes": [where]}
    models = [f"The paper's heap: {m['model']}, {m['bytes_a_triangle']:.0f} bytes a triangle." for m in r["paper_models"]]
    yield "paper2_bytes", {"title": "Bytes a triangle, triangles not counted", "axis": "bytes", "units": BYTES,
                           "series": ["nodes, directory, ids", "links or cells"], "panels": panels(bytes_bar),
                           "notes": [where, "Links are those of parent or of skip links, one of them; cells those of backtrack.",
                                     *models]}
    for mesh, name in zip(meshes, make_names(meshes, "mesh", ["body", "hall", "knot"], "mesh")):
        for rays, count in mesh["rays"].items():
            trees = {}
            for cast in mesh["casts"]:
                if cast["rays"] == rays:
                    label = cast["traversal"] + (", last hit" if cast["start"] == "last hit" else "")
                    seconds = {key: 1e6 * cast["seconds"][key] / count for key in ("median", "lowest", "highest")}
                    trees.setdefault(cast["tree"], []).append(make_bar(label, [seconds["median"]], seconds))
            yield f"paper2_{name}_{rays}", {"title": f"{rays} rays, {mesh['mesh']}", "axis": "time of a million rays",
                                            "series": ["walk and triangle tests"],
                                            "panels": [make_panel(tree, bars) for tree, bars in trees.items()],
                                            "notes": [where, "Every panel has an axis of its own."]}


def chart_paper3(r):
    s = r["settings"]
    where = (f"{s['engine']}, {r.get('device', {}).get('name', '')}; {s['width']} x {s['height']} pixels; "
             f"commit {r['build']['commit']}")

    def measured(scene):
        return [way for way in scene["ways"] if way["outcome"] == "measured" and way["method"] == "compute"]

    def frame_bar(way):
        if way["outcome"] != "measured":
            return make_bar(way["method"], [], note="refused")
        return make_bar(way["method"], get_stages(way, FRAME_STAGES), way["stages_total_s"])

    yield "paper3_bytes", {"title": "Bytes of a scene by structure", "axis": "bytes", "units": BYTES,
                           "series": ["geometry", "structures"], "notes": [where],
                           "panels": [make_panel(scene["scene"], [make_bar(f"{way['structure']} {way['traversal']}",
                                                                           [way["geometry_bytes"], way["structures_bytes"]])
                                                                  for way in measured(scene)]) for scene in r["scenes"]]}
    names = make_names(r["scenes"], "scene", ["body", "hall", "knot", "pumpkin", "bark"], "mesh")
    for scene, name in zip(r["scenes"], names):
        pairs = {}
        for way in scene["ways"]:
            pairs.setdefault(f"{way['structure']} {way['traversal']}", []).append(frame_bar(way))
        yield f"paper3_{name}", {"title": f"A frame of {scene['scene']}: one primary and one shadow ray a pixel",
                                 "axis": "time by stage", "series": list(FRAME_STAGES.values()),
                                 "panels": [make_panel(pair, bars) for pair, bars in pairs.items()],
                                 "notes": [where, "Every panel has an axis of its own."]}


PEER_SCENES = ["party", "rock", "rock_mild", "rocks", "rocks_mild", "rock_close", "rock_close_mild", "pumpkin", "bark"]


def chart_peers(r):
    s = r["settings"]
    where = (f"Relief {r['build']['commit']}, Embree {r['embree_version']}, {r['machine']['processor']}, {s['threads']} threads, "
             f"{s['width']}x{s['height']}, medians of {s['runs']} runs")

    def cold_bar(way, cold):
        parts = [cold.get(part, {}).get("median", 0) for part in ("tessellate_s", "prepare_s", "build_s", "primary_s", "occlusion_s")]
        return make_bar(way, [parts[0] + parts[1], *parts[2:]], cold["first_occlusion_s"])

    def cast_bars(cast, isa):
        for way in cast["ways"]:
            call = way.get("call", "")
            if way["threads"] != s["threads"] or way.get("isa", isa) != isa or call.endswith("8"):
                continue
            width = "" if not call else " x16" if call.endswith("16") else " x1"
            name = ("relief " if way["program"] == "relief" else "") + way["way"] + width
            yield make_bar(name, [way["seconds"]["median"]], way["seconds"])

    names = list(dict.fromkeys(scene["scene"] for scene in r["scenes"]))
    for number, name in enumerate(names):
        stem = name if name in PEER_SCENES else f"scene{number}"
        levels = [scene for scene in r["scenes"] if scene["scene"] == name]
        yield f"peers_{stem}_cold", {"title": f"{name}: first image from cold, one occlusion ray a hit", "axis": "wall clock",
                                     "series": ["prepare or tessellate", "build", "primary rays", "occlusion rays"],
                                     "panels": [make_panel(f"level {scene['level']}",
                                                           [cold_bar(*item) for item in scene["cold"].items()])
                                                for scene in levels], "notes": [where]}
        for scene in levels:
            yield f"peers_{stem}_{scene['level']}_rays", {
                "title": f"{name}, level {scene['level']}: the same rays, warm", "axis": "wall clock",
                "series": ["all rays of the kind"], "notes": [where],
                "panels": [make_panel(cast["rays"], list(cast_bars(cast, scene["isa"]))) for cast in scene["casts"]]}


def chart_cycles(r):
    s = r["settings"]
    where = (f"{s['width']} x {s['height']} pixels, {s['threads']} threads, {r['machine']['processor']}; Blender {r['blender']}; "
             f"commit {r['build']['commit']}")

    def title(case):
        return f"{case['samples']} samples, {case['bounces']} bounces"

    def time_bar(label, side):
        prepare, first, render = (side[part]["median"] for part in ("prepare_s", "first_sample_s", "render_s"))
        return make_bar(label, [prepare, first - prepare, render - first], side["render_s"])

    def memory_bar(label, side):
        return make_bar(label, [side["resident_peak_bytes"]["median"]], side["resident_peak_bytes"])

    def sides(make, case):
        return [make("Cycles", case["cycles"]), make("Relief", case["relief"])]

    yield "cycles_memory", {"title": "Peak resident memory", "axis": "bytes of the process", "units": BYTES, "series": ["resident"],
                            "panels": [make_panel(scene["scene"], sides(memory_bar, scene["cases"][3]), title(scene["cases"][3]))
                                       for scene in r["scenes"]], "notes": [where]}
    for scene in r["scenes"]:
        yield f"cycles_{scene['scene']}", {
            "title": f"Cycles and Relief: {scene['scene']}", "axis": "from the scene in memory to the picture",
            "series": ["preparation", "first sample", "the others"], "notes": [where, "Every panel has an axis of its own."],
            "panels": [make_panel(title(case), sides(time_bar, case), f"importance map: {case['importance_map']}")
                       for case in scene["cases"]]}


CHARACTERS = ["body", "head", "crowd"]


def chart_characters(r):
    s = r["settings"]
    where = (f"{s['samples']} samples, {s['bounces']} bounces, {s['threads']} threads, {r['machine']['processor']}; medians of "
             f"{s['runs']} runs; commit {r['build']['commit']}")
    notes = [where, "Every panel has an axis of its own.", *(f"Skipped: {one['name']}: {one['reason']}" for one in r["skipped"])]

    def panel(case, make):
        return make_panel(f"{case['width']} x {case['height']}", [make(*item) for item in case["programs"].items()])

    def cold_bar(name, program):
        first, render = (program[part]["median"] for part in ("first_sample_s", "render_s"))
        return make_bar(name, [first, max(render - first, 0)], program["render_s"])

    def memory_bar(name, program):
        return make_bar(name, [program["resident_peak_bytes"]["median"]], program["resident_peak_bytes"])

    def session_panel(case, measure):
        bars = [make_bar(name, [program[measure]["median"]], program[measure])
                for name, program in case["programs"].items() if measure in program]
        return make_panel(measure.removesuffix("_s"), bars, f"{case['width']} x {case['height']}")

    names = list(dict.fromkeys(case["scene"] for case in r["cases"]))
    for number, name in enumerate(names):
        stem = name if name in CHARACTERS else f"file{number}"
        cases = [case for case in r["cases"] if case["scene"] == name]
        yield f"characters_{stem}_cold", {"title": f"{name}: from cold", "axis": "seconds", "series": ["first sample", "the others"],
                                          "panels": [panel(case, cold_bar) for case in cases], "notes": notes}
        yield f"characters_{stem}_memory", {"title": f"{name}: peak resident memory", "axis": "bytes of the process", "units": BYTES,
                                            "series": ["resident"], "panels": [panel(case, memory_bar) for case in cases],
                                            "notes": notes}
        yield f"characters_{stem}_session", {
            "title": f"{name}: the next picture in a session", "axis": "seconds", "series": ["one sample"], "notes": notes,
            "panels": [session_panel(case, measure) for case in cases for measure in ("turned_s", "moved_s", "changed_s")]}


def chart_frame(r):
    s = r["settings"]
    programs = ["baseline", "relief"] if "baseline" in r else ["relief"]
    where = (f"{s['engine']}, {s['width']} x {s['height']} pixels, {s['samples']} samples, {s['bounces']} bounces, "
             f"{s['threads']} threads, {r['machine']['processor']}; medians of {s['runs']} runs; commit {r['build']['commit']}")

    def name(case, program):
        return f"{case['isa']} {program}" if case["isa"] else program

    def speed_bar(case, program):
        speed = case[program]["samples_per_s"]
        if speed is None:
            return make_bar(name(case, program), [], note="not told")
        return make_bar(name(case, program), [0] * programs.index(program) + [speed["median"]], speed)

    def panels(make):
        scenes = list(dict.fromkeys(case["scene"] for case in r["cases"]))
        return [make_panel(scene, [make(case, program) for case in r["cases"] if case["scene"] == scene for program in programs])
                for scene in scenes]

    stages = list(dict.fromkeys(stage for case in r["cases"] for program in programs for stage in case[program]["stages"]))

    def stage_bar(case, program):
        told = case[program]["stages"]
        if not told:
            return make_bar(name(case, program), [], note="not told")
        return make_bar(name(case, program), [told[stage]["seconds"]["median"] if stage in told else 0 for stage in stages])

    yield "frame_speed", {"title": "Path-traced frames: samples a second", "axis": "samples a second, lowest and highest run",
                          "units": RATES, "series": programs, "panels": panels(speed_bar),
                          "notes": [where, "Every panel has an axis of its own."]}
    yield "frame_stages", {"title": "Path-traced frames: stages", "axis": "seconds, summed over threads of the CPU engine",
                           "series": [FRAME_STAGES.get(stage, stage) for stage in stages], "panels": panels(stage_bar),
                           "notes": [where, "Every panel has an axis of its own."]}


def draw_lines(chart, file):
    """Error against time, both logarithmic; a line a series."""
    figure = pyplot.figure(figsize=(8, 6))
    axes = figure.subplots(gridspec_kw={"left": 0.1, "right": 0.97, "top": 0.93, "bottom": 0.12 + 0.03 * len(chart["notes"])})
    for line in chart["lines"]:
        axes.plot(line["seconds"], line["errors"], marker="o", label=line["label"], color=line["color"],
                  linestyle="--" if line["dashed"] else "-")
        for x, y, samples in zip(line["seconds"], line["errors"], line["samples"]):
            axes.annotate(str(samples), (x, y), textcoords="offset points", xytext=(4, 4), fontsize=7)
    axes.set(xscale="log", yscale="log", xlabel="seconds", ylabel="relative squared error", title=chart["title"])
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend()
    figure.text(0.02, 0.01, "\n".join(chart["notes"]), fontsize=7, color="#555")
    save(figure, file)


def chart_quality(r):
    s = r["settings"]
    where = (f"{s['width']} x {s['height']} pixels, {s['bounces']} bounces, {s['threads']} threads, {r['machine']['processor']}; "
             f"Blender {r['blender']}; commit {r['build']['commit']}")

    def line(series):
        points = series["points"]
        return {"label": ("Relief" if series["program"] == "relief" else "Cycles") + (", denoised" if series["denoised"] else ""),
                "color": COLORS[0 if series["program"] == "relief" else 2], "dashed": series["denoised"],
                **{name: [point[key] for point in points]
                   for name, key in (("seconds", "seconds"), ("errors", "error"), ("samples", "samples"))}}

    for scene in r["scenes"]:
        yield f"quality_{scene['scene']}", {"title": f"Error against time: {scene['scene']}",
                                            "lines": [line(series) for series in scene["series"]],
                                            "notes": [where, "Numbers at points are samples a pixel."]}


CHARTS = {"paper1": chart_paper1, "paper2": chart_paper2, "paper3": chart_paper3, "peers": chart_peers, "cycles": chart_cycles,
          "quality": chart_quality, "characters": chart_characters, "frame": chart_frame,
          "edits": lambda _: [], "triangles": lambda _: []}  # tables say it all


def read_result(file):
    """What a suite reported, None where the file holds something else."""
    content = json.loads(file.read_text())
    if isinstance(content, dict) and "parts" in content:
        content = content["parts"].get("bench", {}).get("result")
    return content if isinstance(content, dict) and content.get("suite") in CHARTS else None


def main():
    paths = [pathlib.Path(path) for path in sys.argv[1:]]
    if not paths:
        sys.exit(__doc__.strip())
    # The same bits for the same results.
    matplotlib.rcParams.update({"svg.hashsalt": "relief", "svg.fonttype": "none", "font.family": "sans-serif"})
    for path in paths:
        files = sorted(path.glob("*.json")) if path.is_dir() else [path]
        results = [(file, result) for file in files if (result := read_result(file))]
        if not results:
            sys.exit(f"{path}: no result of `relief bench`")
        for file, result in results:
            for name, chart in CHARTS[result["suite"]](result):
                (draw_lines if "lines" in chart else draw)(chart, file.with_name(name + ".svg"))


main()
