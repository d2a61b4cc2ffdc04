#!/usr/bin/env python3
"""Checks what MkDocs does not: anchors, links of README.md and CONTRIBUTING.md, pages outside the navigation, large pictures.

  tools/check_links.py

Anchors are the headings' own, as MkDocs and GitHub make them: lower case, hyphens for spaces, no punctuation.
"""
import os
import re
import subprocess
import sys
import unicodedata

LARGEST_PICTURE_BYTES = 1_000_000


def anchors(text):
    """The anchors of a page's headings; a repeated heading gets _1, _2 and so on."""
    found = set()
    text = re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)
    for heading in re.findall(r"^#+ +(.*?)\s*$", text, flags=re.M):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        plain = unicodedata.normalize("NFKD", heading).encode("ascii", "ignore").decode()
        base = re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", plain).strip().lower())
        name, count = base, 0
        while name in found:
            count += 1
            name = f"{base}_{count}"
        found.add(name)
    return found


def main():
    listed = subprocess.check_output(
        ["git", "ls-files", "-co", "--exclude-standard", "*.md", "docs/pictures"], text=True
    ).split("\n")
    pages = [name for name in listed if name.endswith(".md") and os.path.exists(name)]
    texts = {name: open(name, encoding="utf-8").read() for name in pages}
    faults, links, used = [], 0, set()
    for page, text in texts.items():
        if page.startswith("tests/"):
            continue
        text = re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)
        for target in re.findall(r"(?:\]\(|<img src=\")([^)\s\"]+)", re.sub(r"`[^`]*`", "", text)):
            if "://" in target or target.startswith("mailto:"):
                continue
            links += 1
            path, _, anchor = target.partition("#")
            file = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
            used.add(file)
            if not os.path.exists(file):
                faults.append(f"{page}: there is no {target}")
            elif page.startswith("docs/") and not file.startswith("docs/"):
                faults.append(f"{page}: {target} is not a part of the site; write its path as code instead")
            elif anchor and file in texts and anchor not in anchors(texts[file]):
                faults.append(f"{page}: {file} has no heading for #{anchor}")
    navigation = open("mkdocs.yml", encoding="utf-8").read()
    for page in pages:
        name = page.removeprefix("docs/")
        if page.startswith("docs/") and not page.startswith("docs/develop/adr/0") and f": {name}\n" not in navigation:
            faults.append(f"{page}: mkdocs.yml does not list it under nav")
    for name in listed:
        if name.startswith("docs/pictures/") and os.path.exists(name):
            if os.path.getsize(name) > LARGEST_PICTURE_BYTES:
                faults.append(f"{name}: {os.path.getsize(name)} bytes; pictures have at most {LARGEST_PICTURE_BYTES}")
            if name not in used:
                faults.append(f"{name}: no page shows it")
    for fault in faults:
        print(f"FAILED  {fault}")
    print(f"links: {links} of {len(pages)} documents, {len(faults)} faults")
    return len(faults) > 0


if __name__ == "__main__":
    sys.exit(main())
