"""Tests of the Python module over the take of version 1: two rigs of 96x72, 15 pulses."""

import ast
import gc
import inspect
import json
import os
import resource
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from PIL import Image

import vantage

SOURCES = Path(__file__).resolve().parents[2]
TAKE = SOURCES / "tests" / "takes" / "version_1.mkv"
PROGRAMS = Path(os.environ["VANTAGE_PROGRAMS"])


def exported_views(folder, pulse):
    """The view set that `vantage take export` writes of the first pulse."""
    subprocess.run(
        [PROGRAMS / "vantage", "take", "export", TAKE, "--as", "views", "--to", "0.2", "-o", folder],
        check=True,
        capture_output=True,
    )
    return folder / "000000"


def read_ply(path):
    """Positions (n, 3) and colours (n, 3) of a binary PLY, as its header lists them."""
    header, _, data = path.read_bytes().partition(b"end_header\n")
    lines = [line.split() for line in header.decode().splitlines()]
    types = {"float": "<f4", "uchar": "u1", "double": "<f8"}
    layout = [(line[2], types[line[1]]) for line in lines if line[0] == "property"]
    count = next(int(line[2]) for line in lines if line[:2] == ["element", "vertex"])
    points = np.frombuffer(data, layout, count)
    return (
        np.stack([points[axis] for axis in "xyz"], axis=1).astype(np.float64),
        np.stack([points[channel] for channel in ("red", "green", "blue")], axis=1),
    )


def hits(frame, pose, picture, positions, colours):
    """Which points have the colour of the pixel that a camera of transforms.json sees them at."""
    at = (np.linalg.inv(pose) @ np.c_[positions, np.ones(len(positions))].T)[:3]
    with np.errstate(divide="ignore", invalid="ignore"):
        columns = np.floor(frame["fl_x"] * at[0] / -at[2] + frame["cx"])
        rows = np.floor(frame["fl_y"] * -at[1] / -at[2] + frame["cy"])
    inside = (at[2] < 0) & (columns >= 0) & (columns < frame["w"]) & (rows >= 0) & (rows < frame["h"])
    seen = np.zeros(len(positions), bool)
    pixels = picture[rows[inside].astype(int), columns[inside].astype(int)].astype(int)
    seen[inside] = np.abs(pixels - colours[inside]).max(axis=1) <= 2
    return seen


class TakeTest(unittest.TestCase):
    def setUp(self):
        self.take = vantage.Take(TAKE)
        self.addCleanup(self.take.close)

    def test_describes_itself(self):
        self.assertEqual(self.take.rigs, ["left", "right"])
        self.assertEqual(len(self.take), 15)
        self.assertEqual(self.take.pulse_rate_hz, 5)
        self.assertEqual(list(np.diff(self.take.pulses)), [1] * 14)
        self.assertRegex(repr(self.take), "15 frame sets of left, right")

    def test_frame_sets_have_shapes_and_units(self):
        frames = self.take[0]
        self.assertEqual(frames.pulse, self.take.pulses[0])
        self.assertEqual(frames.rigs, ["left", "right"])
        self.assertGreater(frames.decoding_s, 0)
        view = frames["left"]
        self.assertEqual(view.colour.shape, (72, 96, 3))
        self.assertEqual(view.colour.dtype, np.uint8)
        self.assertEqual(view.disparity.shape, (72, 96))
        self.assertEqual(view.world_from_camera.shape, (4, 4))
        known = np.isfinite(view.depth)
        self.assertGreater(known.mean(), 0.5)
        self.assertTrue((view.disparity_steps[~np.isfinite(view.disparity)] == 0).all())
        d = view.disparity[known]
        np.testing.assert_allclose(
            view.depth[known], view.K[0, 0] * view.baseline_m / (d + view.doffs_px), rtol=1e-5
        )
        np.testing.assert_array_equal(view.disparity[known] * 32, view.disparity_steps[known])
        with self.assertRaisesRegex(KeyError, "no frame of rig 'north'"):
            frames["north"]

    def test_depth_and_cameras_are_those_of_the_export(self):
        with tempfile.TemporaryDirectory() as name:
            folder = exported_views(Path(name) / "views", self.take.pulses[0])
            document = json.loads((folder / "views.json").read_text())
            for view in document["views"]:
                here = self.take[0][view["name"]]
                np.testing.assert_allclose(here.K, view["K"], rtol=1e-9)
                np.testing.assert_allclose(
                    here.world_from_camera[:3], view["world_from_camera"], atol=1e-9
                )
                depth = vantage._files.read_pfm(folder / view["depth"])
                np.testing.assert_array_equal(np.isnan(depth), np.isnan(here.depth))
                known = np.isfinite(depth)
                np.testing.assert_allclose(here.depth[known], depth[known], rtol=1e-5)

    def test_arrays_are_not_copies_and_outlive_the_take(self):
        view = self.take[0]["left"]
        first, second = view.colour, view.rgba
        self.assertTrue(np.shares_memory(first, second))
        self.assertFalse(first.flags.writeable)
        before = first.copy()
        other = self.take[7]["left"].colour
        self.take.close()
        del view, second
        gc.collect()
        np.testing.assert_array_equal(first, before)
        self.assertEqual(other.shape, (72, 96, 3))
        with self.assertRaisesRegex(vantage.VantageError, "is closed"):
            self.take.at(1)

    def descriptors(self):
        """How many descriptors of shared memory the process that reads the take has."""
        folder = Path(f"/proc/{self.take._process.pid}/fd")
        return sum("vantage-frame-set" in os.readlink(each) for each in folder.iterdir())

    def test_memory_of_released_frame_sets_is_used_again(self):
        held = [self.take[0], self.take[1]]
        before = [frames["right"].rgba.copy() for frames in held]
        for _ in range(3):
            for frames in self.take:
                del frames
        self.assertLessEqual(self.descriptors(), 4)
        numbers = [self.take._ask({"pulse": int(pulse)})[1]["memory"] for pulse in self.take.pulses]
        self.assertLessEqual(len(set(numbers)), 2, "the memory of the frame set before")
        for frames, pixels in zip(held, before):
            np.testing.assert_array_equal(frames["right"].rgba, pixels)

    def test_memory_that_a_fork_may_hold_is_not_used_again(self):
        frames = self.take[0]
        before = frames["left"].rgba.copy()
        out, into = os.pipe()
        told, telling = os.pipe()
        child = os.fork()
        if child == 0:
            os.read(told, 1)
            os.write(into, b"same" if (frames["left"].rgba == before).all() else b"else")
            os._exit(0)
        del frames
        for frames in self.take:
            pass
        os.write(telling, b"x")
        self.assertEqual(os.read(out, 4), b"same")
        os.waitpid(child, 0)
        for each in (out, into, told, telling):
            os.close(each)

    def test_held_frame_sets_need_no_descriptors(self):
        soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (64, hard))
        self.addCleanup(resource.setrlimit, resource.RLIMIT_NOFILE, (soft, hard))
        held = [frames for _ in range(6) for frames in self.take]
        self.assertEqual(len(held), 90)
        np.testing.assert_array_equal(held[0]["left"].rgba, held[75]["left"].rgba)
        with self.assertRaises(ValueError):
            held[0]["left"].rgba.flags.writeable = True

    def test_is_a_sequence(self):
        self.assertEqual([frames.pulse for frames in self.take], list(self.take.pulses))
        self.assertEqual(self.take[-1].pulse, self.take.pulses[-1])
        self.assertEqual([f.pulse for f in self.take[2:4]], list(self.take.pulses[2:4]))
        with self.assertRaises(IndexError):
            self.take[15]

    def test_points_are_on_the_rays_of_their_pixels(self):
        view = self.take[0]["left"]
        at, colours = view.points()
        self.assertEqual(at.shape, colours.shape)
        self.assertEqual(len(at), np.isfinite(view.depth).sum())
        inside = (np.linalg.inv(view.world_from_camera) @ np.c_[at, np.ones(len(at))].T)[:3]
        pixels = view.depth_K @ inside
        rows, columns = np.nonzero(np.isfinite(view.depth))
        np.testing.assert_allclose(pixels[0] / pixels[2], columns, atol=1e-2)
        np.testing.assert_allclose(pixels[1] / pixels[2], rows, atol=1e-2)
        np.testing.assert_array_equal(colours, view.colour[rows, columns])

    def test_reads_the_flight(self):
        cameras = self.take.cameras()
        self.assertEqual(len(cameras.tick), self.take.ticks)
        self.assertEqual(cameras.world_from_camera.shape, (15, 4, 4))
        np.testing.assert_allclose(np.linalg.det(cameras.world_from_camera[:, :3, :3]), 1)
        self.assertIn(cameras.pulse[0], self.take.pulses)

    def test_faults_are_sentences(self):
        with self.assertRaisesRegex(vantage.VantageError, "no frame of pulse 1"):
            self.take.at(1)
        self.assertEqual(len(self.take[0]), 2, "and the next request is served")
        with self.assertRaisesRegex(vantage.VantageError, "none.mkv"):
            vantage.Take("none.mkv")
        with self.assertRaisesRegex(vantage.VantageError, "install the package"):
            vantage._programs.find_program("vantage-none")


class SynthesisTest(unittest.TestCase):
    def test_renders_a_new_view_of_a_frame_set(self):
        with vantage.Take(TAKE) as take:
            frames = take[0]
        view = frames["left"]
        camera = vantage.Camera(96, 72, view.K, view.world_from_camera)
        picture = vantage.render(frames, camera)
        self.assertEqual(picture.shape, (72, 96, 4))
        covered = picture[..., 3] == 255
        self.assertGreater(covered.mean(), 0.8)
        error = np.abs(picture[..., :3].astype(int) - view.colour)[covered].mean()
        self.assertLess(error, 12, "the rig's own view comes back")
        with self.assertRaisesRegex(vantage.VantageError, "nosuch"):
            vantage.render(frames, camera, synth="nosuch")

    def test_cameras_with_a_field_of_view(self):
        camera = vantage.Camera.with_field_of_view(100, 50, np.pi / 2, np.eye(4))
        np.testing.assert_allclose(camera.K, [[50, 0, 49.5], [0, 50, 24.5], [0, 0, 1]])


class StereoTest(unittest.TestCase):
    def test_matches_arrays(self):
        shift = 6
        texture = np.random.default_rng(1).integers(0, 256, (60, 100 + shift, 3), np.uint8)
        texture = np.kron(texture[::2, ::2], np.ones((2, 2, 1), np.uint8))
        left, right = texture[:, :100], texture[:, shift : 100 + shift]
        disparity = vantage.match(left, right, disparities=32, preset="fast")
        self.assertEqual(disparity.shape, (60, 100))
        middle = disparity[10:50, 40:90]
        self.assertAlmostEqual(float(np.nanmedian(middle)), shift, delta=0.5)

    def test_refuses_what_is_no_picture(self):
        with self.assertRaisesRegex(vantage.VantageError, "a picture is an array of uint8"):
            vantage.match(np.zeros((4, 4)), np.zeros((4, 4)))
        with self.assertRaisesRegex(vantage.VantageError, "two pictures of a rectified pair"):
            vantage.match(np.zeros((60, 80), np.uint8), np.zeros((60, 90), np.uint8))


class ExampleTest(unittest.TestCase):
    def test_examples_run(self):
        examples = sorted((SOURCES / "python" / "examples").glob("*.py"))
        self.assertGreater(len(examples), 1)
        with tempfile.TemporaryDirectory() as folder:
            for example in examples:
                done = subprocess.run(
                    [sys.executable, example, TAKE], cwd=folder, capture_output=True, text=True
                )
                self.assertEqual(done.returncode, 0, f"{example.name}: {done.stderr}")
            self.check_nerfstudio(Path(folder) / "nerfstudio")
            self.check_colmap(Path(folder) / "colmap")
            cloud = (Path(folder) / "points.ply").read_bytes()
            self.assertTrue(cloud.startswith(b"ply\nformat binary_little_endian 1.0\n"))
            for name in ("gsplat", "nerfstudio"):
                with self.subTest(name):
                    self.check_transforms(Path(folder) / name)

    def test_the_export_for_training_has_the_same_conventions(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name) / "training"
            subprocess.run(
                [PROGRAMS / "vantage", "take", "export", TAKE, "--as", "training", "--to", "0.2"]
                + ["-o", folder],
                check=True,
                capture_output=True,
            )
            self.check_transforms(folder / "000000")

    def check_transforms(self, folder):
        """The points of the cloud are where transforms.json and the pictures have them.

        Trainers read a pose as OpenGL's: x right, y up, looking along -z; the corner of a picture
        is at (0, 0). Any other convention puts points on pixels of other colours.
        """
        document = json.loads((folder / "transforms.json").read_text())
        self.assertIn(document["camera_model"], ("OPENCV", "PINHOLE"), "those of COLMAP")
        self.assertEqual(len(document["frames"]), 2)
        positions, colours = read_ply(folder / document["ply_file_path"])
        self.assertGreater(len(positions), 500)
        own = []
        for frame in document["frames"]:
            with Image.open(folder / frame["file_path"]) as image:
                self.assertEqual(image.size, (frame["w"], frame["h"]))
                picture = np.asarray(image.convert("RGB"))
            pose = np.array(frame["transform_matrix"])
            np.testing.assert_allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-9)
            self.assertAlmostEqual(np.linalg.det(pose[:3, :3]), 1)
            own.append(hits(frame, pose, picture, positions, colours))
            turned = pose @ np.diag([1, -1, -1, 1])
            self.assertLess(hits(frame, turned, picture, positions, colours).mean(), 0.1)
            shifted = dict(frame, cx=frame["cx"] - 0.5, cy=frame["cy"] - 0.5)
            self.assertLess(hits(shifted, pose, picture, positions, colours).sum(), own[-1].sum() * 0.9)
        self.assertGreater(np.logical_or(*own).mean(), 0.99, "a picture has every point")

    def check_nerfstudio(self, folder):
        frames = json.loads((folder / "transforms.json").read_text())["frames"]
        with vantage.Take(TAKE) as take:
            depth = take[0][0].depth
        millimetres = np.asarray(Image.open(folder / frames[0]["depth_file_path"])).astype(float)
        known = np.isfinite(depth)
        np.testing.assert_allclose(millimetres[known], 1000 * depth[known], atol=1)
        self.assertTrue((millimetres[~known] == 0).all())

    def check_colmap(self, folder):
        """Points of the model have the colour of their place in a picture."""
        model = folder / "sparse" / "0"
        cameras = [line.split() for line in (model / "cameras.txt").read_text().splitlines()]
        images = (model / "images.txt").read_text().split("\n")
        points = np.loadtxt(model / "points3D.txt")
        self.assertEqual([c[1:4] for c in cameras], [["PINHOLE", "96", "72"]] * 2)
        self.assertEqual(images[1::2], ["", ""], "after every image a list of its points")
        number, w, x, y, z, tx, ty, tz, camera, name = images[0].split()
        w, x, y, z = (float(each) for each in (w, x, y, z))
        rotation = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
        fx, fy, cx, cy = (float(each) for each in cameras[0][4:])
        at = np.array(rotation) @ points[:, 1:4].T + np.array([[tx], [ty], [tz]], dtype=float)
        columns, rows = fx * at[0] / at[2] + cx, fy * at[1] / at[2] + cy
        with Image.open(folder / "images" / name) as image:
            picture = np.asarray(image).astype(float)
        own = slice(0, len(points) // 3)  # the points of the first rig come first
        colours = picture[rows[own].astype(int), columns[own].astype(int)]
        np.testing.assert_allclose(colours, points[own, 4:7], atol=1)


class StubTest(unittest.TestCase):
    """The types in __init__.pyi are those of the module."""

    stub = ast.parse((Path(vantage.__file__).parent / "__init__.pyi").read_text())

    def compare(self, name, function, node):
        def shown(parameter):
            default = parameter.default
            return parameter.name, None if default is parameter.empty else default

        given = node.args.posonlyargs + node.args.args
        defaults = [None] * (len(given) - len(node.args.defaults)) + [
            ast.literal_eval(each) for each in node.args.defaults
        ]
        stubbed = list(zip((each.arg for each in given), defaults))
        if node.args.vararg:
            stubbed.append((node.args.vararg.arg, None))
        real = [shown(each) for each in inspect.signature(function).parameters.values()]
        self.assertEqual(stubbed, real, name)
        self.assertIsNotNone(node.returns, f"{name} has a result")

    def test_types_fit_the_module(self):
        functions = {n.name: n for n in self.stub.body if isinstance(n, ast.FunctionDef)}
        classes = {n.name: n for n in self.stub.body if isinstance(n, ast.ClassDef)}
        self.assertEqual(sorted(functions.keys() | classes.keys()), sorted(vantage.__all__))
        for name, node in functions.items():
            self.compare(name, getattr(vantage, name), node)
        for name, node in classes.items():
            real = getattr(vantage, name)
            stubbed = set()
            for each in node.body:
                if isinstance(each, ast.AnnAssign):
                    stubbed.add(each.target.id)
                if not isinstance(each, ast.FunctionDef):
                    continue
                stubbed.add(each.name)
                member = inspect.getattr_static(real, each.name)
                if isinstance(member, classmethod):
                    member = member.__func__
                if inspect.isfunction(member):
                    self.compare(f"{name}.{each.name}", member, each)
            public = {n for n in vars(real) if not n.startswith("_")}
            public |= {n for n in vars(real).get("__annotations__", {}) if not n.startswith("_")}
            self.assertLessEqual(public, stubbed, f"{name}: what the stub lacks")

    def test_everything_public_is_described(self):
        for name in vantage.__all__:
            thing = getattr(vantage, name)
            self.assertTrue(thing.__doc__, name)
            for member, value in vars(thing).items() if inspect.isclass(thing) else ():
                if not member.startswith("_") and callable(getattr(value, "__get__", None)):
                    self.assertTrue(value.__doc__, f"{name}.{member}")

    def test_is_marked_as_typed(self):
        self.assertTrue((Path(vantage.__file__).parent / "py.typed").exists())


if __name__ == "__main__":
    unittest.main()
