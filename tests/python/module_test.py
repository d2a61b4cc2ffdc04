"""Tests of the Python module over the take of version 1: two rigs of 96x72, 15 pulses."""

import gc
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

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
            cloud = (Path(folder) / "points.ply").read_bytes()
            self.assertTrue(cloud.startswith(b"ply\nformat binary_little_endian 1.0\n"))
            transforms = json.loads((Path(folder) / "gsplat" / "transforms.json").read_text())
            self.assertEqual(len(transforms["frames"]), 2)
            self.assertTrue((Path(folder) / "gsplat" / transforms["ply_file_path"]).exists())
            self.assertTrue((Path(folder) / "gsplat" / transforms["frames"][0]["file_path"]).exists())


if __name__ == "__main__":
    unittest.main()
