"""The Blender add-on over exports of the take of version 1: two rigs of 96x72."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
from PIL import Image

SOURCES = Path(__file__).resolve().parents[2]
ADD_ON = SOURCES / "blender" / "vantage_import.py"
TAKE = SOURCES / "tests" / "takes" / "version_1.mkv"

# Renders what the first rig saw, once with the surfaces and once with the points, and prints the scene.
RENDER = """
import bpy, json, os
scene = bpy.context.scene
scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 16, False
scene.render.film_transparent = True
scene.render.resolution_x, scene.render.resolution_y = 96, 72
scene.camera = bpy.data.objects["left"]
scene.frame_set(1)
# A pixel of these small pictures is 6 cm wide.
for node in bpy.data.node_groups["Vantage points"].nodes:
    if "Radius" in node.inputs:
        node.inputs["Radius"].default_value = 0.06
for kind in ("Surface", "Points"):
    for thing in bpy.data.objects:
        if thing.type == "MESH":
            thing.animation_data_clear()
            thing.hide_render = thing.name.split()[0] != kind
    scene.render.filepath = os.path.abspath(kind + ".png")
    bpy.ops.render.render(write_still=True)
flight = bpy.data.objects["Flight"]
with open("scene.json", "w") as file:
    json.dump({"frames": scene.frame_end, "place": list(flight.matrix_world.translation),
               "rate": scene.render.fps / scene.render.fps_base,
               "angle": flight.data.angle_x, "names": [o.name for o in bpy.data.objects]}, file)
"""


class ImportTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_here(self, *command):
        # Blender takes relative paths as relative to PWD.
        here = dict(os.environ, PWD=str(self.folder))
        return subprocess.run(command, cwd=self.folder, env=here, capture_output=True, text=True, check=False)

    def export(self, kind, *options):
        done = self.run_here(os.environ["VANTAGE"], "take", "export", TAKE, "--as", kind, *options, "-o", kind)
        self.assertEqual(done.returncode, 0, done.stderr)

    def blender(self, *arguments):
        return self.run_here("blender", "--background", *arguments)

    def test_a_render_through_a_rig_is_its_picture(self):
        self.export("camera")
        for kind in ("training", "glb", "ply"):
            self.export(kind, "--to", "0.2")
        done = self.blender(
            "--python", ADD_ON, "--", "camera", "training", "glb", "ply", "-o", "scene.blend"
        )
        self.assertTrue((self.folder / "scene.blend").exists(), done.stdout + done.stderr)
        (self.folder / "render.py").write_text(RENDER)
        done = self.blender("scene.blend", "--python-exit-code", "1", "--python", "render.py")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

        with Image.open(self.folder / "training" / "000000" / "images" / "left.jpg") as image:
            filmed = np.asarray(image.convert("RGB")).astype(int)
        for kind in ("Surface", "Points"):
            with Image.open(self.folder / f"{kind}.png") as image:
                rendered = np.asarray(image.convert("RGBA")).astype(int)
            opaque = rendered[..., 3] == 255
            self.assertGreater(opaque.mean(), 0.4, kind)
            error = np.abs(rendered[..., :3] - filmed)[opaque]
            self.assertLess(np.median(error), 8, kind)
            self.assertLess(abs((rendered[..., :3] - filmed)[opaque].mean()), 4, f"{kind}: brightness")

        scene = json.loads((self.folder / "scene.json").read_text())
        rows = (self.folder / "camera" / "camera.csv").read_text().splitlines()
        head, first = rows[0].split(","), rows[1].split(",")
        row = {name: float(first[head.index(name)]) for name in ("x_m", "y_m", "z_m", "field_of_view_deg")}
        self.assertEqual(scene["frames"], len(rows) - 1)
        np.testing.assert_allclose(scene["place"], [row["x_m"], -row["z_m"], row["y_m"]], atol=1e-5)
        self.assertAlmostEqual(np.degrees(scene["angle"]), row["field_of_view_deg"], places=3)
        for name in ("left", "right", "Flight"):
            self.assertIn(name, scene["names"])

    def test_other_files_are_refused_with_a_sentence(self):
        (self.folder / "cut.ply").write_bytes(
            b"ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty float x\nend_header\n"
        )
        for export, sentence in (("none", "is no export that this add-on reads"), ("cut.ply", "is cut short")):
            done = self.blender("--python", ADD_ON, "--", export, "-o", "scene.blend")
            self.assertIn(sentence, done.stdout + done.stderr)
            self.assertNotEqual(done.returncode, 0)
            self.assertFalse((self.folder / "scene.blend").exists())


if __name__ == "__main__":
    unittest.main()
