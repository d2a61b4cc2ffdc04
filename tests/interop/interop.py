#!/usr/bin/env python3
"""Reads files that other programs wrote, and writes docs/results/interop.md: writer, form, reader, verdict.

  tests/interop/interop.py [--bin FOLDER] [-o FILE]

Every file is made here, by the real writer. A writer that is not installed gives rows that say SKIPPED. The packages
of all writers are imagemagick, python3-pil, python3-opencv, netpbm, ffmpeg and libimage-exiftool-perl.

A picture is right if the disparities of its pair are those of the original pair, or those of the original pair with
the colours that the form can hold. A calibration is right if its numbers are those that were written. The exit status
is 1 if a row is wrong.
"""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIZE, DISPARITIES, SHIFT = (160, 120), 16, 6


def run(*command, cwd=None):
    done = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def module(name):
    try:
        return __import__(name)
    except ImportError:
        return None


def said(stderr):
    """The last sentence that the program wrote, without its time stamp and name."""
    lines = [line for line in stderr.splitlines() if line.strip()]
    if not lines:
        return ""
    return re.sub(r"^[\d:.]+ ", "", re.sub(r"/\S*/", "", lines[-1])).replace("|", "/")


class Table:
    def __init__(self):
        self.rows, self.wrong = [], 0

    def add(self, writer, form, reader, verdict, note=""):
        self.wrong += verdict == "wrong"
        self.rows.append((writer, form, reader, verdict, note))
        print(f"{verdict:8} {writer}: {form}: {note}", flush=True)

    def markdown(self):
        lines = ["# Files of other programs", "",
                 "`tests/interop/interop.py` writes this page. It makes every file with the program named, reads it with Vantage, and",
                 "compares the result with the original. *Right*: the same result. *Named*: a difference or a refusal that Vantage names.", "",
                 "| writer | form | reader | verdict | what Vantage said |", "| --- | --- | --- | --- | --- |"]
        lines += ["| " + " | ".join(row) + " |" for row in self.rows]
        counts = {v: sum(row[3] == v for row in self.rows) for v in ("right", "named", "wrong", "SKIPPED")}
        lines += ["", ", ".join(f"{count} {name}" for name, count in counts.items()) + "."]
        return "\n".join(lines) + "\n"


class Pictures:
    """Pairs of pictures, matched by `vantage-rig match`."""

    def __init__(self, programs, folder, table):
        self.rig, self.folder, self.table = programs / "vantage-rig", folder, table
        self.original = [folder / "left.png", folder / "right.png"]
        width, height = SIZE
        source = f"testsrc2=size={width + SHIFT}x{height}:rate=1,noise=alls=40:all_seed=7,format=rgb24"
        for side, x in zip(self.original, (0, SHIFT)):
            code, _, error = run("ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i", source, "-frames:v", "1",
                                 "-vf", f"crop={width}:{height}:{x}:0", side)
            if code:
                raise SystemExit(f"interop: ffmpeg did not make the original pictures: {error}")
        self.expected = self.disparities(self.original)[0]

    def disparities(self, pair):
        result = self.folder / "disparity.png"
        result.unlink(missing_ok=True)
        code, _, error = run(self.rig, "match", "--disparities", DISPARITIES, "--preset", "fast", "--repeats", 1,
                             "-o", result, *pair)
        if code:
            return None, error
        raw = subprocess.run(["ffmpeg", "-v", "error", "-i", result, "-f", "rawvideo", "-pix_fmt", "gray16le", "-"],
                             capture_output=True).stdout
        return [int.from_bytes(raw[i:i + 2], "little") for i in range(0, len(raw), 2)], error

    def row(self, writer, form, pair, least_equal=0.9, refusal_is_right=False):
        """least_equal: share of the pixels whose disparity must be within half a pixel of the original's."""
        if not all(picture.exists() for picture in pair):
            self.table.add(writer, form, "`vantage-rig match`", "SKIPPED", "this version of the writer does not write it")
            return
        got, error = self.disparities(pair)
        if got is None:
            verdict = "named" if refusal_is_right and said(error) else "wrong"
            self.table.add(writer, form, "`vantage-rig match`", verdict, said(error))
            return
        equal = sum(abs(a - b) <= 16 for a, b in zip(got, self.expected)) / len(self.expected)
        warnings = [said(line) for line in error.splitlines() if "warning" in line]
        verdict = "wrong" if equal < least_equal else "named" if warnings else "right"
        self.table.add(writer, form, "`vantage-rig match`", verdict,
                       warnings[0] if warnings else f"{equal:.0%} of the pixels have the same disparity")

    def by_command(self, writer, tool, form, extension, command, **expectation):
        """command(source, target): the words of a command line."""
        if not shutil.which(tool):
            self.table.add(writer, form, "`vantage-rig match`", "SKIPPED", f"{tool} is not installed")
            return
        stem = re.sub(r"\W+", "_", f"{writer}_{form}")
        pair = [self.folder / f"{stem}_{side.stem}.{extension}" for side in self.original]
        for source, target in zip(self.original, pair):
            code, _, error = run(*command(source, target))
            if code:
                self.table.add(writer, form, "`vantage-rig match`", "SKIPPED", f"the writer refuses: {said(error)}")
                return
        self.row(writer, form, pair, **expectation)

    def by_module(self, writer, available, form, extension, write, **expectation):
        """write(source, target): calls the writer's functions."""
        if not available:
            self.table.add(writer, form, "`vantage-rig match`", "SKIPPED", "its Python module is not installed")
            return
        stem = re.sub(r"\W+", "_", f"{writer}_{form}")
        pair = [self.folder / f"{stem}_{side.stem}.{extension}" for side in self.original]
        try:
            for source, target in zip(self.original, pair):
                write(source, target)
        except Exception as error:
            self.table.add(writer, form, "`vantage-rig match`", "SKIPPED", f"the writer refuses: {error}".replace("|", "/"))
            return
        self.row(writer, form, pair, **expectation)

    def all(self):
        grey = {"least_equal": 0.6}  # colour is a part of the matching cost
        for form, extension, options, expectation in [
                ("PNG", "png", [], {}),
                ("PNG, interlaced", "png", ["-interlace", "PNG"], {}),
                ("PNG of 16 bits", "png", ["-define", "png:bit-depth=16"], {}),
                ("PNG with a palette", "png", ["-colors", "200"], {"least_equal": 0.6}),
                ("grey PNG with alpha", "png", ["-colorspace", "Gray", "-alpha", "on"], grey),
                ("JPEG 4:2:0", "jpg", ["-sampling-factor", "2x2", "-quality", "95"], {"least_equal": 0.7}),
                ("progressive JPEG", "jpg", ["-interlace", "JPEG", "-quality", "97"], {"least_equal": 0.7}),
                ("grey JPEG", "jpg", ["-colorspace", "Gray", "-quality", "97"], grey),
                ("CMYK JPEG", "jpg", ["-colorspace", "CMYK", "-quality", "97"], {"least_equal": 0.5, "refusal_is_right": True}),
                ("TIFF, LZW", "tiff", ["-compress", "LZW"], {"refusal_is_right": True}),
                ("BMP", "bmp", [], {"refusal_is_right": True}),
                ("WebP", "webp", ["-define", "webp:lossless=true"], {"refusal_is_right": True}),
                ("GIF", "gif", [], {"least_equal": 0.5, "refusal_is_right": True}),
                ("PPM", "ppm", [], {}),
                ("plain PPM", "ppm", ["-compress", "none"], {}),
                ("PPM of 16 bits", "ppm", ["-depth", "16"], {}),
                ("PGM", "pgm", ["-colorspace", "Gray"], grey)]:
            self.by_command("ImageMagick", "convert", form, extension,
                            lambda a, b, o=options: ["convert", a, *o, f"png8:{b}" if "-colors" in o else b],
                            **expectation)
        for form, extension, options, expectation in [
                ("PNG", "png", [], {}), ("MJPEG", "jpg", ["-q:v", "2"], {"least_equal": 0.7}), ("PPM", "ppm", [], {}),
                ("BMP", "bmp", [], {"refusal_is_right": True}), ("TIFF", "tiff", [], {"refusal_is_right": True}),
                ("PNG of 16 bits, big endian", "png", ["-pix_fmt", "rgb48be"], {}),
                ("PGM of 16 bits", "pgm", ["-pix_fmt", "gray16be"], grey)]:
            self.by_command("FFmpeg", "ffmpeg", form, extension,
                            lambda a, b, o=options: ["ffmpeg", "-v", "error", "-y", "-i", a, *o, b], **expectation)
        for form, extension, script, expectation in [
                ("PPM", "ppm", 'pngtopnm "$0" > "$1"', {}),
                ("plain PPM", "ppm", 'pngtopnm "$0" | pnmtoplainpnm > "$1"', {}),
                ("PAM", "pam", 'pngtopam "$0" | pamtopam > "$1"', {"refusal_is_right": True}),
                ("PPM, largest value 1023", "ppm", 'pngtopnm "$0" | pamdepth 1023 > "$1"', {}),
                ("PGM", "pgm", 'pngtopnm "$0" | ppmtopgm > "$1"', grey)]:
            self.by_command("Netpbm", "pngtopnm", form, extension,
                            lambda a, b, s=script: ["sh", "-c", s, a, b], **expectation)
        self.by_command("ExifTool", "exiftool", "JPEG with an orientation", "jpg",
                        lambda a, b: ["sh", "-c", 'convert "$0" -quality 97 "$1" && exiftool -q -overwrite_original -Orientation#=6 "$1"',
                                      a, b], least_equal=0.7)
        pil = module("PIL.Image") and __import__("PIL.Image").Image
        for form, extension, options, mode, expectation in [
                ("PNG", "png", {}, "RGB", {}), ("PNG with alpha", "png", {}, "RGBA", {}),
                ("grey PNG", "png", {}, "L", grey),
                ("JPEG", "jpg", {"quality": 97, "subsampling": 0}, "RGB", {"least_equal": 0.7}),
                ("progressive JPEG", "jpg", {"quality": 97, "progressive": True}, "RGB", {"least_equal": 0.7}),
                ("PPM", "ppm", {}, "RGB", {}), ("TIFF", "tiff", {}, "RGB", {"refusal_is_right": True})]:
            self.by_module("Pillow", pil, form, extension,
                           lambda a, b, o=options, m=mode: pil.open(a).convert(m).save(b, **o), **expectation)
        cv2 = module("cv2")
        for form, extension, options, read, expectation in [
                ("PNG", "png", [], 1, {}), ("grey PNG", "png", [], 0, grey), ("JPEG", "jpg", [1, 97], 1, {"least_equal": 0.7}),
                ("PPM", "ppm", [], 1, {}), ("plain PPM", "ppm", [32, 0], 1, {}),
                ("Radiance HDR", "hdr", [], 1, {"least_equal": 0.5, "refusal_is_right": True}),
                ("TIFF", "tiff", [], 1, {"refusal_is_right": True})]:
            self.by_module("OpenCV", cv2, form, extension,
                           lambda a, b, o=options, r=read: cv2.imwrite(str(b), cv2.imread(str(a), r), o), **expectation)


class Calibrations:
    """Calibrations, read by `vantage-calib import` and given back by `vantage-calib export`."""

    def __init__(self, programs, folder, table):
        self.calib, self.folder, self.table = programs / "vantage-calib", folder, table

    def opencv(self, form, extension):
        cv2, numpy = module("cv2"), module("numpy")
        if not cv2 or not numpy:
            self.table.add("OpenCV", form, "`vantage-calib import`", "SKIPPED", "its Python module is not installed")
            return
        camera = numpy.array([[501.25, 0, 318.5], [0, 502.75, 241.125], [0, 0, 1]])
        lens = numpy.array([[-0.21, 0.07, 0.0004, -0.0003, 0.01]])
        turn, _ = cv2.Rodrigues(numpy.array([0.004, -0.03, 0.002]))
        shift = numpy.array([[-0.121], [0.0007], [0.0011]])
        written = self.folder / f"stereo.{extension}"
        out = cv2.FileStorage(str(written), cv2.FILE_STORAGE_WRITE)
        for name, value in (("M1", camera), ("D1", lens), ("M2", camera), ("D2", lens), ("R", turn), ("T", shift)):
            out.write(name, value)
        out.release()
        ours, back = self.folder / f"{extension}.yaml", self.folder / f"back_{extension}.yml"
        code, _, error = run(self.calib, "import", written, "-o", ours, "--size", 640, 480, "--unit", "m")
        if code == 0:
            code, _, error = run(self.calib, "export", ours, "--as", "opencv", "-o", back)
        if code:
            self.table.add("OpenCV", form, "`vantage-calib import`", "wrong", said(error))
            return
        read = cv2.FileStorage(str(back), cv2.FILE_STORAGE_READ)
        worst = 0.0
        for name, value in (("M1", camera), ("D1", lens), ("M2", camera), ("R", turn), ("T", shift)):
            got = read.getNode(name).mat()
            if got is None:
                worst = float("inf")
            else:
                flat, other = value.ravel(), got.ravel()
                worst = max(worst, float(numpy.abs(flat - other[:flat.size]).max()))
        self.table.add("OpenCV", form, "`vantage-calib import`, read back by OpenCV", "right" if worst < 1e-9 else "wrong",
                       f"largest difference of a number {worst:.1g}")

    def all(self):
        self.opencv("stereo calibration, YAML", "yml")
        self.opencv("stereo calibration, XML", "xml")
        self.opencv("stereo calibration, JSON", "json")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/release/bin", help="folder of the programs")
    parser.add_argument("-o", type=pathlib.Path, default=ROOT / "docs/results/interop.md", help="the page to write")
    parser.add_argument("--json", action="store_true", help="print the counts as JSON")
    options = parser.parse_args()
    table = Table()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        Pictures(options.bin, folder, table).all()
        Calibrations(options.bin, folder, table).all()
    options.o.write_text(table.markdown())
    if options.json:
        print(json.dumps({"wrong": table.wrong, "rows": len(table.rows)}))
    return 1 if table.wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
