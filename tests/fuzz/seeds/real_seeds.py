#!/usr/bin/env python3
"""Writes inputs of other programs into the folders of the fuzz targets, so that fuzzing mutates real files too.

  tests/fuzz/seeds/real_seeds.py CORPUS

Pictures are of ImageMagick, FFmpeg, Netpbm, Pillow and OpenCV, calibrations of OpenCV, OSC of liblo, and linear time
code of libltc. A writer that is not installed is named and left out. The packages are those of tests/interop.
"""

import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "interop"))
import interop  # noqa: E402


class Corpus:
    def __init__(self, folder):
        self.folder, self.count = pathlib.Path(folder), 0

    def write(self, target, name, data):
        (self.folder / target).mkdir(parents=True, exist_ok=True)
        (self.folder / target / f"real_{name}").write_bytes(data)
        self.count += 1


def left_out(writer):
    print(f"SKIPPED: {writer} is not installed, and its inputs are left out")


def write_pictures(corpus, folder):
    if not shutil.which("convert"):
        left_out("ImageMagick")
        return
    original = folder / "original.png"
    interop.run("convert", "-size", "24x16", "plasma:red-blue", original)
    commands = [("convert", f"im_{name}", extension, ["convert", original, *options]) for name, extension, options in [
        ("interlaced", "png", ["-interlace", "PNG"]), ("deep", "png", ["-define", "png:bit-depth=16"]),
        ("alpha", "png", ["-alpha", "on"]), ("bilevel", "png", ["-monochrome"]), ("grey", "jpg", ["-colorspace", "Gray"]),
        ("progressive", "jpg", ["-interlace", "JPEG"]), ("cmyk", "jpg", ["-colorspace", "CMYK"]),
        ("411", "jpg", ["-sampling-factor", "4x1"]), ("restart", "jpg", ["-define", "jpeg:restart-interval=2"]),
        ("plain", "ppm", ["-compress", "none"]), ("deep", "ppm", ["-depth", "16"]),
        ("plain", "pgm", ["-colorspace", "Gray", "-compress", "none"]), ("plain", "pbm", ["-monochrome", "-compress", "none"])]]
    commands += [("ffmpeg", f"ff_{name}", extension, ["ffmpeg", "-v", "error", "-y", "-i", original, *options])
                 for name, extension, options in [("rgb", "png", []), ("deep", "png", ["-pix_fmt", "rgb48be"]),
                                                  ("mjpeg", "jpg", ["-pix_fmt", "yuvj422p"]),
                                                  ("deep", "pgm", ["-pix_fmt", "gray16be"])]]
    for tool, name, extension, command in commands:
        if not shutil.which(tool):
            continue
        made = folder / f"{name}.{extension}"
        if interop.run(*command, made)[0] == 0:
            corpus.write("picture", made.name, made.read_bytes())
    if not shutil.which("ffmpeg"):
        left_out("FFmpeg")
    if shutil.which("pngtopnm"):
        for name, script in [("netpbm.ppm", "pngtopnm"), ("netpbm_1023.ppm", "pngtopnm | pamdepth 1023"),
                             ("netpbm_plain.ppm", "pngtopnm | pnmtoplainpnm")]:
            made = subprocess.run(["sh", "-c", script], stdin=original.open("rb"), capture_output=True)
            corpus.write("picture", name, made.stdout)
    else:
        left_out("Netpbm")
    pil = interop.module("PIL.Image") and __import__("PIL.Image").Image
    if pil:
        for name, mode, options in [("pillow.png", "RGBA", {}), ("pillow_palette.png", "P", {}), ("pillow_bits.png", "1", {}),
                                    ("pillow.jpg", "RGB", {"subsampling": 0, "exif": b"Exif\0\0MM\0*\0\0\0\x08\0\1\1\x12\0\3\0\0\0\1\0\6\0\0\0\0\0\0"})]:
            pil.open(original).convert(mode).save(folder / name, **options)
            corpus.write("picture", name, (folder / name).read_bytes())
    else:
        left_out("Pillow")


def write_calibrations(corpus, folder):
    cv2 = interop.module("cv2")
    if not cv2:
        left_out("OpenCV")
        return
    import numpy
    camera, lens = numpy.array([[600.5, 0, 320], [0, 601, 240], [0, 0, 1]]), numpy.array([[-0.2, 0.05, 1e-4, 0, 0.01]])
    for extension in ("yml", "xml", "json"):
        made = folder / f"opencv.{extension}"
        storage = cv2.FileStorage(str(made), cv2.FILE_STORAGE_WRITE)
        for side in "12":
            storage.write("M" + side, camera)
            storage.write("D" + side, lens)
        storage.write("R", numpy.eye(3))
        storage.write("T", numpy.array([[-60.0], [0], [0]]))
        storage.release()
        # The first byte chooses the name of the file; 0 is a.yaml.
        corpus.write("calibration_form", made.name, b"\0" + made.read_bytes())


def write_osc(corpus):
    if not shutil.which("oscsend"):
        left_out("liblo")
        return
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(10)
        for name, words in [("none", []), ("integer", ["i", "3"]), ("float", ["f", "0.5"]), ("text", ["s", "go on"]),
                            ("many", ["ifsTFNI", "1", "2.5", "x"]), ("long", ["hd", "5", "2.5"]), ("midi", ["m", "90406400"])]:
            if interop.run("oscsend", "127.0.0.1", receiver.getsockname()[1], "/vantage/shot", *words)[0] == 0:
                corpus.write("osc_message", f"liblo_{name}", receiver.recv(65536))


def write_timecode(corpus):
    writer = interop.TimecodeWriter()
    if not writer.library:
        left_out("libltc")
        return
    for fps in (24, 25, 30):
        samples = writer.samples(48000, fps, 6)
        data = b"".join(int((sample - 128) * 200).to_bytes(2, "little", signed=True) for sample in samples)
        corpus.write("ltc", f"libltc_{fps}", data)


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    corpus = Corpus(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_pictures(corpus, folder)
        write_calibrations(corpus, folder)
    write_osc(corpus)
    write_timecode(corpus)
    print(f"{corpus.count} inputs of other programs")


if __name__ == "__main__":
    main()
