#!/usr/bin/env python3
"""Reads files that other programs wrote, and writes docs/results/interop.md: writer, form, reader, verdict.

  tests/interop/interop.py [--bin FOLDER] [-o FILE]

Every file and message is made here, by the real writer. A writer that is not installed gives rows that say SKIPPED.
The packages of all writers are imagemagick, python3-pil, python3-opencv, netpbm, ffmpeg, libimage-exiftool-perl,
liblo-tools and libltc11 or libltc-dev.

A picture is right if the disparities of its pair are those of the original pair, or those of the original pair with
the colours that the form can hold. A calibration is right if its numbers are those that were written. A video is right
if the pictures that a rig shows are the frames of its pulses. OSC is right if all commands are executed, and time code
if the codes that were written are heard. The exit status is 1 if a row is wrong.
"""

import argparse
import ctypes
import ctypes.util
import json
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import time
import wave

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
                 "This page says which pictures, videos, calibrations and time codes of other programs Vantage reads, and what it says about the",
                 "others.", "",
                 "```text", "tests/interop/interop.py --bin build/release/bin -o docs/results/interop.md", "```", "",
                 "The command writes this page. It makes every file with the program named, reads it with Vantage, and compares the result with",
                 "the original. The verdict *right* means the same result, as far as the last column says. *Named* means a difference or a refusal that Vantage",
                 "names. *Wrong* means a difference that Vantage does not notice. A program that is missing is SKIPPED.", "",
                 "| writer | format | reader | verdict | result, or message of Vantage |", "| --- | --- | --- | --- | --- |"]
        lines += ["| " + " | ".join(row) + " |" for row in self.rows]
        counts = {v: sum(row[3] == v for row in self.rows) for v in ("right", "named", "wrong", "SKIPPED")}
        lines += ["", ", ".join(f"{count} {name}" for name, count in counts.items()) + ".", "",
                  "[Calibration](../build/calibration.md#6-calibrations-of-other-programs) says how other programs' calibrations are read."]
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


class Videos:
    """Videos, played by a rig: every pulse shows the frame of its number, modulo the length."""

    FRAMES, STEP = 10, 20

    def __init__(self, programs, folder, table):
        self.rig, self.folder, self.table = programs / "vantage-rig", folder / "videos", table
        self.folder.mkdir()

    def row(self, form, name, options):
        reader = "`vantage-rig capture`"
        film = self.folder / name
        source = f"color=black:size=64x48:rate=25,format=gray,geq=lum='20+N*{self.STEP}'"
        code, _, error = run("ffmpeg", "-v", "error", "-y", "-f", "lavfi", "-i", source, "-frames:v", self.FRAMES,
                             *options, film)
        if code:
            self.table.add("FFmpeg", form, reader, "SKIPPED", f"the writer refuses: {said(error)}")
            return
        config, taken = self.folder / f"{name}.toml", self.folder / f"{name}.pictures"
        config.write_text(f'version = 1\nname = "a"\ncalibration = "none"\n[source]\nkind = "files"\n'
                          f'left = "{name}"\nright = "{name}"\nrate_hz = 10\n[stream]\nbind = "tcp://127.0.0.1:*"\n')
        code, _, error = run(self.rig, "capture", "--config", config, "--every", 3, "--count", 8, "-o", taken)
        if code:
            self.table.add("FFmpeg", form, reader, "wrong", said(error))
            return
        misses = []
        for side in ("left", "right"):
            for picture in sorted(taken.glob(f"{side}_*.png")):
                raw = subprocess.run(["ffmpeg", "-v", "error", "-i", picture, "-f", "rawvideo", "-pix_fmt", "gray", "-"],
                                     capture_output=True).stdout
                frame = int(re.search(r"(\d+)\.png", picture.name).group(1)) % self.FRAMES
                misses.append(abs(sum(raw) / len(raw) - (20 + frame * self.STEP)))
        worst = max(misses, default=255)
        self.table.add("FFmpeg", form, reader, "right" if worst < self.STEP / 2 else "wrong",
                       f"{len(misses)} pictures are the frames of their pulses (grey within {worst:.0f})"
                       if worst < self.STEP / 2 else f"a picture is {worst:.0f} grey levels from its frame")

    def all(self):
        grey = ["-pix_fmt", "yuvj420p"]
        for form, name, options in [
                ("Motion JPEG in AVI", "mjpeg.avi", ["-c:v", "mjpeg", "-q:v", "2", *grey]),
                ("H.264 in MP4", "h264.mp4", ["-c:v", "libx264", "-crf", "10", *grey]),
                ("H.264 with B frames in Matroska", "bframes.mkv", ["-c:v", "libx264", "-bf", "3", "-crf", "10", *grey]),
                ("HEVC in MP4", "hevc.mp4", ["-c:v", "libx265", "-crf", "10", "-x265-params", "log-level=none", *grey]),
                ("FFV1 in Matroska", "ffv1.mkv", ["-c:v", "ffv1", "-pix_fmt", "gray"]),
                ("VP9 in WebM", "vp9.webm", ["-c:v", "libvpx-vp9", "-crf", "10", "-color_range", "pc", *grey[:1], "yuv420p"]),
                ("MPEG-4 in MOV", "mpeg4.mov", ["-c:v", "mpeg4", "-q:v", "2"]),
                ("MPEG-2 in a transport stream", "mpeg2.ts", ["-c:v", "mpeg2video", "-q:v", "2", "-g", "5"]),
                ("raw YUV in Y4M", "raw.y4m", ["-pix_fmt", "yuv420p"]),
                ("ProRes in MOV", "prores.mov", ["-c:v", "prores_ks", "-pix_fmt", "yuv422p10le"])]:
            self.row(form, name, options)


class TimecodeWriter:
    """The encoder of libltc."""

    class Timecode(ctypes.Structure):
        _fields_ = [("timezone", ctypes.c_char * 6)] + [
            (name, ctypes.c_ubyte) for name in ("years", "months", "days", "hours", "mins", "secs", "frame")]

    def __init__(self):
        name = ctypes.util.find_library("ltc")
        self.library = ctypes.CDLL(name) if name else None
        if self.library:
            self.library.ltc_encoder_create.restype = ctypes.c_void_p
            self.library.ltc_encoder_create.argtypes = [ctypes.c_double, ctypes.c_double, ctypes.c_int, ctypes.c_int]

    def samples(self, rate, fps, frames):
        encoder = ctypes.c_void_p(self.library.ltc_encoder_create(rate, fps, 1, 0))
        start = self.Timecode(b"+0000", 0, 0, 0, 10, 0, 0, 0)
        self.library.ltc_encoder_set_timecode(encoder, ctypes.byref(start))
        buffer = (ctypes.c_ubyte * (2 * int(rate / fps) + 64))()
        result = bytearray()
        for _ in range(frames):
            self.library.ltc_encoder_encode_frame(encoder)
            result += bytes(buffer[:self.library.ltc_encoder_get_buffer(encoder, buffer)])
            self.library.ltc_encoder_inc_timecode(encoder)
        self.library.ltc_encoder_free(encoder)
        return result

    def write(self, file, rate, fps, frames, channels=1, channel=0):
        with wave.open(str(file), "wb") as out:
            out.setnchannels(channels)
            out.setsampwidth(2)
            out.setframerate(rate)
            data = bytearray()
            for sample in self.samples(rate, fps, frames):
                for i in range(channels):
                    data += int((sample - 128) * 200 if i == channel else 0).to_bytes(2, "little", signed=True)
            out.writeframes(bytes(data))


class Show:
    """OSC and linear time code, heard by one show with a virtual rig."""

    CODES = 60

    def __init__(self, programs, folder, table):
        self.host, self.rig, self.folder, self.table = programs / "vantage", programs / "vantage-rig", folder / "show", table
        self.folder.mkdir()

    @staticmethod
    def free_port(kind):
        with socket.socket(socket.AF_INET, kind) as one:
            one.bind(("127.0.0.1", 0))
            return one.getsockname()[1]

    def timecodes(self):
        writer = TimecodeWriter()
        rows = []
        for form, name, settings, convert in [
                ("LTC, 48 kHz", "l48.wav", (48000, 25), None),
                ("LTC, 44.1 kHz, second of two channels", "l44.wav", (44100, 25, self.CODES, 2, 1), None),
                ("LTC, 96 kHz, 30 frames per second", "l96.wav", (96000, 30), None),
                ("LTC, 22.05 kHz, 24 frames per second", "l22.wav", (22050, 24), None),
                ("LTC in FLAC, encoded by FFmpeg", "l.flac", (48000, 25), ["-c:a", "flac"]),
                ("LTC in AAC, encoded by FFmpeg", "l.m4a", (48000, 25), ["-c:a", "aac", "-b:a", "192k"])]:
            if not writer.library:
                self.table.add("libltc", form, "`--control ltc://`", "SKIPPED", "libltc is not installed")
                continue
            rate, fps, *more = settings
            plain = self.folder / (name if not convert else f"{name}.wav")
            writer.write(plain, rate, fps, *(more or [self.CODES]))
            if convert and run("ffmpeg", "-v", "error", "-y", "-i", plain, *convert, self.folder / name)[0]:
                self.table.add("libltc", form, "`--control ltc://`", "SKIPPED", "FFmpeg does not write it")
                continue
            rows.append((form, f"ltc://{self.folder / name}"))
        return rows

    OSC = [("/vantage/freeze", ""), ("/vantage/live", ""), ("/vantage/shot", "i", "1"), ("/vantage/preset", "f", "50")]

    def send(self, port, host):
        """Sends commands once the show renders, as single messages and in a bundle; returns their number."""
        log = []
        for line in host.stderr:
            log.append(line)
            if " fps, " in line:
                break
        sent = 0
        if shutil.which("oscsend"):
            for address, types, *values in self.OSC:
                sent += run("oscsend", "127.0.0.1", port, address, *([types, *values] if types else []))[0] == 0
        time.sleep(4)
        return sent, "".join(log)

    def judge(self, osc_url, sent, heard, ports):
        reader = "`--control osc://`"
        if not shutil.which("oscsend"):
            self.table.add("liblo", "OSC commands", reader, "SKIPPED", "oscsend is not installed")
        else:
            port = ports.get(osc_url, {})
            obeyed = port.get("obeyed", 0)
            is_right = obeyed == sent == len(self.OSC)
            self.table.add("liblo", "OSC commands without and with numbers", reader, "right" if is_right else "wrong",
                           f"{obeyed} of {sent} executed" + (f": {port['last_refusal']}" if port.get("last_refusal") else ""))
        for form, url in heard:
            port = ports.get(url, {})
            # The decoder needs one or two codes to find the first one, and holds back the last.
            codes = port.get("obeyed", 0)
            is_right = codes >= self.CODES - 4 and port.get("told", "").startswith("10:00:0")
            self.table.add("libltc", form, "`--control ltc://`", "right" if is_right else "wrong",
                           f"{codes} of {self.CODES} codes heard" if codes else port.get("told") or port.get("failure", ""))

    def all(self):
        port, osc = self.free_port(socket.SOCK_STREAM), self.free_port(socket.SOCK_DGRAM)
        (self.folder / "rig.toml").write_text(
            f'version = 1\nname = "a"\n[source]\nkind = "virtual"\nrate_hz = 10\nwidth_px = 64\nheight_px = 48\n'
            f'[match]\nmatcher = "exact"\n[stream]\nbind = "tcp://127.0.0.1:{port}"\n')
        (self.folder / "stage.toml").write_text(
            f'version = 1\nrate_hz = 10\n[[rigs]]\nname = "a"\nendpoint = "tcp://127.0.0.1:{port}"\n'
            '[view]\nwidth_px = 64\nheight_px = 48\n')
        heard = self.timecodes()
        osc_url = f"osc://127.0.0.1:{osc}"
        with subprocess.Popen([self.rig, "run", "--config", self.folder / "rig.toml"], stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as rig:
            host = subprocess.Popen(
                [self.host, "live", "--stage", self.folder / "stage.toml", "--headless", "--json", "--wait", "60",
                 "--seconds", "600", "--control", osc_url, *[word for _, url in heard for word in ("--control", url)]],
                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            sent, log = self.send(osc, host)
            host.terminate()
            out, rest = host.communicate()
            rig.terminate()
        try:
            ports = {entry["name"]: entry for entry in json.loads(out)["control"]}
        except (ValueError, KeyError, TypeError):
            raise SystemExit(f"interop: the show ended without a summary: {said(log + rest)}")
        self.judge(osc_url, sent, heard, ports)


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
        Videos(options.bin, folder, table).all()
        Show(options.bin, folder, table).all()
    options.o.write_text(table.markdown())
    if options.json:
        print(json.dumps({"wrong": table.wrong, "rows": len(table.rows)}))
    return 1 if table.wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
