#!/usr/bin/env python3
"""Measures what each step of synthesis is worth: live_truth's figures with one step after the other left out.

A step is left out by a #define that its shader checks for; VANTAGE_SHADERS replaces the shader with a copy that begins
with it. Writes a Markdown table to stdout, with means over the scenes. Needs build/release/bin/live_truth. Six scenes
take about three minutes for each step and processor.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TRUTH = ROOT / "build/release/bin/live_truth"
# Name: what the table calls it (with the step's number in docs/develop/synthesis.md), shader, definition.
STEPS = {
    "nothing": ("nothing", None, None),
    "silhouettes": ("foreground held by other rigs' silhouettes (2)", "foreground_carve.frag", "WITHOUT_SILHOUETTES"),
    "smoothing": ("its depth smoothed (2)", "foreground_depth.frag", "WITHOUT_SMOOTHING"),
    "unmixing": ("the background taken out of its edges (1)", "foreground_colour.frag", "WITHOUT_UNMIXING"),
    "floor": ("the floor (3)", "rig_floor.frag", "WITHOUT_FLOOR"),
    "moving": ("depth moved to where images match (4)", "rig_carve.frag", "WITHOUT_MOVING"),
    "carving": ("depth that others see through carved away (4)", "rig_carve.frag", "WITHOUT_CARVING"),
    "adoption": ("confirmed depth adopted (4)", "rig_adopt.frag", "WITHOUT_ADOPTION"),
    "consistency": ("consistency check of surfaces (6)", "fused_depth.frag", "WITHOUT_CONSISTENCY_CHECK"),
    "confidence": ("less confidence in colours beside edges (7)", "edge_confidence.frag", "WITHOUT_EDGE_CONFIDENCE"),
    "sharpness": ("colours as sharp as the view (7)", "fused_colour.frag", "WITHOUT_SHARPNESS"),
    "penalties": ("rigs' colours decide at edges (8)", "fused_colour.frag", "WITHOUT_COLOUR_PENALTY"),
    "impulses": ("impulse filter (12)", "impulse_filter.frag", "WITHOUT_IMPULSE_FILTER"),
}
COLUMNS = ("PSNR dB", "of the background", "of the foreground", "SSIM", "outlier pixels", "foreground edges",
           "flicker: background", "foreground")
FORMATS = ("{:.2f}", "{:.2f}", "{:.2f}", "{:.4f}", "{:.2f} %", "{:.2f}", "{:.2f}", "{:.2f}")


def write_shader(folder: pathlib.Path, shader: str, definition: str) -> None:
    """Writes the shader, with the definition in its first line, to the folder."""
    found = list((ROOT / "shaders").rglob(shader))
    if len(found) != 1:
        sys.exit(f"step_worth.py: shaders/ has {len(found)} files named {shader}; correct the table of steps")
    text = found[0].read_text()
    if definition not in text:
        sys.exit(f"step_worth.py: {shader} does not check for {definition}: add '#ifdef {definition}' to it")
    (folder / shader).write_text(f"#define {definition} 1\n{text}")


def figures(scene: str, shaders: pathlib.Path, options: list[str]) -> list[float]:
    """Returns live_truth's figures of the product's synthesiser for one scene, from PSNR on."""
    command = [str(TRUTH), "stepped", "--without-times", "--scenes", scene, *options]
    output = subprocess.run(command, env={**os.environ, "VANTAGE_SHADERS": str(shaders)}, check=True,
                            stdout=subprocess.PIPE, text=True).stdout
    rows = [line.split("|") for line in output.splitlines() if line.startswith("| fused")]
    if not rows:
        sys.exit(f"step_worth.py: {' '.join(command)} printed no row of the synthesiser fused")
    return [float(re.sub("[ %]", "", cell)) for cell in rows[0][3:3 + len(COLUMNS)]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", default="4,7,10,13,16,18", help="scenes of the virtual stage (default: %(default)s)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="scenes at a time (default: processors)")
    parser.add_argument("steps", nargs="*", metavar="STEP", help="only these steps: " + ", ".join(STEPS))
    arguments = sys.argv[1:]
    options: list[str] = []
    if "--" in arguments:  # the rest is for live_truth stepped
        at = arguments.index("--")
        arguments, options = arguments[:at], arguments[at + 1:]
    given = parser.parse_args(arguments)
    for step in given.steps:
        if step not in STEPS:
            parser.error(f"there is no step '{step}', only {', '.join(STEPS)}")
    if not TRUTH.exists():
        sys.exit(f"step_worth.py: {TRUTH} is missing: build it with tools/build.sh release live_truth")
    print("| without |", " | ".join(COLUMNS), "|")
    print("| --- |" + " --- |" * len(COLUMNS))
    for step in given.steps or STEPS:
        words, shader, definition = STEPS[step]
        with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
            shaders = pathlib.Path(folder)
            if shader:
                write_shader(shaders, shader, definition)
            rows = list(pool.map(lambda scene: figures(scene, shaders, options), given.scenes.split(",")))
        means = [sum(column) / len(rows) for column in zip(*rows)]
        print(f"| {words} |", " | ".join(text.format(mean) for text, mean in zip(FORMATS, means)), "|", flush=True)


if __name__ == "__main__":
    main()
