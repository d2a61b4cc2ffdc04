#!/usr/bin/env python3
"""Reports sentences of documents that are longer than 30 words.

  tools/check_prose.py [FILE...]    these Markdown files, or README.md, CONTRIBUTING.md and docs/

Code, tables, headings and HTML comments are not counted. A piece of inline code and a link's text count as they are read.
"""
import re
import subprocess
import sys

LIMIT = 30
ABBREVIATIONS = ("e.g.", "i.e.", "et al.", "etc.", "cf.", "No.", "vs.")


def blocks(text):
    """Yields (line number, text) of every paragraph and list item."""
    text = re.sub(r"<!--.*?-->", lambda found: "\n" * found.group(0).count("\n"), text, flags=re.S)
    fenced, start, words = False, 0, []
    for number, line in enumerate(text.split("\n") + [""], 1):
        bare = line.strip()
        if bare.startswith("```"):
            fenced = not fenced
            bare = ""
        ends = fenced or not bare or bare.startswith(("|", "#", "---", "!!!", "<")) or re.match(r"[-*] |\d+\. ", bare)
        if ends and words:
            yield start, " ".join(words)
            words = []
        if fenced or not bare or bare.startswith(("|", "#", "---", "!!!", "<")):
            continue
        if not words:
            start = number
        words.append(re.sub(r"^(?:[-*]|\d+\.) ", "", bare))


def sentences(block):
    block = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", block)
    block = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", block)
    block = re.sub(r"`[^`]*`", "code", block)
    for word in ABBREVIATIONS:
        block = block.replace(word, word.replace(".", ""))
    return re.split(r"(?<=[.!?])[\"'*)]*\s+(?=[\"'*(]*[A-Z0-9`\[]|code\b)", block)


def main():
    files = sys.argv[1:] or [
        name
        for name in subprocess.check_output(
            ["git", "ls-files", "-co", "--exclude-standard", "README.md", "CONTRIBUTING.md", "docs/*.md"], text=True
        ).split("\n")
        if name
    ]
    found = checked = 0
    for name in files:
        with open(name, encoding="utf-8") as file:
            text = file.read()
        for line, block in blocks(text):
            for sentence in sentences(block):
                words = [word for word in sentence.split() if re.search(r"\w", word)]
                checked += 1
                if len(words) > LIMIT:
                    found += 1
                    print(f"{name}:{line}: {len(words)} words: {' '.join(words)[:100]} ...")
    print(f"prose: {checked} sentences of {len(files)} documents, {found} of them longer than {LIMIT} words")
    return found > 0


if __name__ == "__main__":
    sys.exit(main())
