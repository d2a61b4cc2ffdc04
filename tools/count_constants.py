#!/usr/bin/env python3
"""Counts the constants of synthesis, by room: the shared tolerances, and the numbers that a file names for itself.

  tools/count_constants.py [--list]

A constant is a `constexpr` or GLSL `const` of a number, a colour or a time with a literal value; sizes of arrays, macros and
what is computed from other constants do not count. --list prints each with its place.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
ROOMS = "background baked foreground fused points refine surfaces synthesis views".split()
NUMBER = r"-?(?:\d[\d']*\.?\d*|\.\d+)(?:[eE][-+]?\d+)?[fFuU]*"
NAMED = re.compile(r"\b(?:constexpr|const) (?:float|double|int|vec[234]|[\w:]+) (\w+(?:\[\])? *= *" + NUMBER + r"(?:, \w+ *= *" + NUMBER + r")*) *;")
SHARED = re.compile(r"^TOLERANCE\((\w+), ", re.M)


def constants(path):
    text = path.read_text()
    for match in NAMED.finditer(text):
        for part in match.group(1).split(", "):
            yield text.count("\n", 0, match.start()) + 1, part


def main():
    total = 0
    for room in ROOMS:
        files = []
        for top, suffixes in (("host_app", (".h", ".cpp")), ("shaders", (".frag", ".vert", ".comp", ".glsl"))):
            files += [p for p in sorted((ROOT / top / room).rglob("*")) if p.suffix in suffixes]
        found = [(path.relative_to(ROOT), line, text) for path in files for line, text in constants(path)]
        total += len(found)
        print(f"{room:12} {len(found):4}")
        if "--list" in sys.argv[1:]:
            for path, line, text in found:
                print(f"    {path}:{line}: {text}")
    shared = len(SHARED.findall((ROOT / "shaders/shared/tolerances.glsl").read_text()))
    print(f"named in one file {total}, shared by all in shaders/shared/tolerances.glsl {shared}")


if __name__ == "__main__":
    main()
