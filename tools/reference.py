#!/usr/bin/env python3
"""Writes the pages of docs/reference from the programs' own tables; tools/reference.sh calls it.

  tools/reference.py PROGRAMS FOLDER    PROGRAMS: the folder with vantage, vantage-rig, vantage-calib and config_sentences

- Command line: the programs' --help.
- rig.toml, stage.toml: keys, defaults and descriptions from the examples in hw_config, which a unit test compares with the
  code; type and range from the sentences with which the code's own reader refuses a wrong value (config_sentences).
- Commands and lamps: `vantage control`. Metrics: the calls in host_app/metrics/open_metrics.cpp.
- File formats: the documented examples in hw_config.
"""
import os
import re
import subprocess
import sys
import tempfile

UNITS = [
    ("_deg_s", "degrees/s"), ("_m_s", "m/s"), ("_deg", "degrees"), ("_hz", "Hz"), ("_px", "px"), ("_us", "µs"), ("_ms", "ms"),
    ("_mb", "MB"), ("_s", "s"), ("_m", "m"), ("hours", "h"), ("gigabytes", "GB"), ("minutes", "min"),
    ("noise_sigma", "grey levels"), ("queue_frames", "frames"), ("disparities", "px"),
]
GENERATED = "<!-- Written by tools/reference.sh; edit its sources, not this page. -->\n"


def run(*command):
    """What a program prints; its standard error if it prints nothing."""
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "COLUMNS": "100"}, check=False)
    return done.stdout or done.stderr


def help_page(program, path, opening):
    """Every command of a program with its --help, as one page."""
    sections = []

    def visit(words):
        text = run(path, *words, "--help").rstrip("\n")
        # CLI11 lists the options that an option excludes or needs by their addresses.
        text = re.sub(r"(Excludes|Needs):((?: --[\w-]+)+)", lambda m: f"{m[1]}: {' '.join(sorted(m[2].split()))}", text)
        name = " ".join([program, *words])
        sections.append(f"## {name}\n\n```text\n{text}\n```\n")
        listed = re.search(r"^Subcommands:\n(.*?)(?:\n\n|\Z)", text, flags=re.S | re.M)
        for line in listed.group(1).split("\n") if listed else []:
            command = re.match(r"  ([a-z][a-z0-9-]*)(?:\s|$)", line)
            if command:
                visit([*words, command.group(1)])

    visit([])
    return f"{GENERATED}# {program}\n\n{opening}\n\n" + "\n".join(sections)


class Key:
    def __init__(self, table, name, value, is_given, text):
        self.table, self.name, self.value, self.is_given, self.text = table, name, value, is_given, text
        self.type = self.range = ""


def documented_keys(example):
    """The keys of a documented example file, in order: tables with their text, and keys."""
    tables, keys, table, pending = [], [], "", []
    with open(example, encoding="utf-8") as file:
        lines = file.read().split("\n")
    for line in lines:
        header = re.match(r"(\[+)([\w.]+)\]+\s*$", line)
        key = re.match(r"(# )?([a-z_0-9]+|\"[^\"]+\") = (\"[^\"]*\"|\[[^\]]*\]|[^#\s]+)\s*(?:# (.*))?$", line)
        if header:
            table = header.group(2)
            if table in [name for name, _ in tables]:
                table = None  # a second table of an array shows nothing new
            else:
                tables.append((table, " ".join(pending)))
            pending = []
        elif key and table is not None:
            if key.group(2).startswith('"'):
                continue
            text = " ".join([*pending, key.group(4) or ""]).strip()
            keys.append(Key(table, key.group(2), key.group(3), not key.group(1), text))
            pending = []
        elif line.startswith("# "):
            pending.append(line[2:].strip())
        elif re.match(r"\s+# ", line) and keys:
            keys[-1].text += " " + line.strip()[2:].strip()
        elif not line.strip() or line.strip() == "#":
            pending = []
    return tables, keys


def refusals(sentences, template, probes):
    """What the configuration's reader says of files in which a key has a value; probes are pairs of both."""
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for number, (key, value) in enumerate(probes):
            files.append(os.path.join(folder, f"{template.__name__.split('_')[0]}{number}.toml"))
            with open(files[-1], "w", encoding="utf-8") as out:
                out.write(template(key, f"{key.name} = {value}\n"))
        said = subprocess.run([sentences, *files], capture_output=True, text=True, check=True).stdout.split("\n")
    assert len(said) == len(probes) + 1
    return said[:-1]


def measure(sentences, template, keys):
    """Finds type and range of keys from what the reader refuses."""
    for key, said in zip(keys, refusals(sentences, template, [(key, "1979-05-27") for key in keys])):
        wanted = re.search(r"must be (.*), but is a date", said)
        key.type = re.sub(r"^an? ", "", wanted.group(1)) if wanted else "string"
    probes = [
        (key, value)
        for key in keys
        for value in {
            "integer": ("9223372036854775807", "-9223372036854775807"),
            "number": ("1e300", "-1e300"),
            "string": ('"?"',),
        }.get(key.type, ())
    ]
    for (key, _), said in zip(probes, refusals(sentences, template, probes)):
        both = re.search(r"must be (\S+) to (\S+?)(?:,|;|$)", said)
        least = re.search(r"must be at least (\S+)", said)
        choices = re.search(r"must not be '\?'; the ones there are: (.*)", said)
        if choices:
            key.range, key.type = choices.group(1), "one of"
        elif both and "2147483647" not in both.group(2):
            key.range = f"{both.group(1)} to {both.group(2)}"
        elif both and not both.group(1).startswith("-"):
            key.range = f"at least {both.group(1)}"
        elif least and not key.range:
            key.range = f"at least {least.group(1)}"
    for key in keys:
        key.type = {"true or false": "boolean"}.get(key.type, key.type)


def cell(text):
    return text.replace("|", "\\|").strip() or " "


def toml_page(name, example, opening, sentences, template):
    tables, keys = documented_keys(example)
    measure(sentences, template, keys)
    text = f"{GENERATED}# {name}\n\n{opening}\n"
    for table, words in [("", "")] + tables:
        members = [key for key in keys if key.table == table]
        text += f"\n## {f'[{table}]' if table else 'At the top'}\n"
        if words:
            text += f"\n{words}\n"
        if not members:
            continue
        text += "\n| key | type | unit | default | range | meaning |\n| --- | --- | --- | --- | --- | --- |\n"
        for key in members:
            said = key.text
            default = f"`{key.value}`" if key.is_given else "none"
            stated = re.search(r"default: ([^;]*)", said)
            if stated and not key.is_given:
                default = stated.group(1).strip().rstrip(".")
            said = re.sub(r"(^|[;.] )default: [^;]*(?:; |$)", lambda found: found.group(1), said).strip(" ;")
            if key.is_given and said.endswith("; required"):
                default, said = "required", said.removesuffix("; required")
            if key.is_given and said.endswith("Required."):
                default, said = "required", said.removesuffix("Required.").strip()
            if key.range:
                said = re.sub(r"(?:^|[,;] |, )-?[\d.]+ to -?[\d.]+(?: px)?(?=[.;,]|$)", "", said, count=1).strip(" ;")
            if not re.match(r"(\w+(, \w+)*( and \w+)?:|timedatectl|tcp|imx)", said):
                said = said[:1].upper() + said[1:]
            said = re.sub(r"(?<=\. )[a-z]", lambda found: found.group(0).upper(), said)
            unit = next((unit for ending, unit in UNITS if key.name.endswith(ending)), "")
            text += f"| `{key.name}` | {key.type} | {unit} | {cell(default)} | {cell(key.range)} | {cell(said)} |\n"
    return text


def rig_template(key, line):
    if key.table == "":
        head = {"version": 'name = "a"\n', "name": "version = 1\n"}.get(key.name, 'version = 1\nname = "a"\n')
        return head + line + ("xxxx = 1\n")
    return f'version = 1\nname = "a"\nxxxx = 1\n[{key.table}]\n{line}'


def stage_template(key, line):
    rig = {"name": 'endpoint = "tcp://127.0.0.1:1"\n', "endpoint": 'name = "a"\n'}
    start = "" if key.name == "version" else "version = 1\n"
    top = line if key.table == "" else ""
    member = rig.get(key.name, 'name = "a"\nendpoint = "tcp://127.0.0.1:1"\n') + line if key.table == "rigs" else 'name = "a"\nendpoint = "tcp://127.0.0.1:1"\n'
    text = f"{start}xxxx = 1\n{top}[[rigs]]\n{member}"
    return text if key.table in ("", "rigs") else text + f"[{key.table}]\n{line}"


def commands_page(vantage):
    tables = [table.strip("\n") for table in run(vantage, "control").strip("\n").split("\n\n")]
    heads = ["Commands: time, clips and play list", "Lamps: time, clips and play list", "Commands: camera, outputs and the rest", "Lamps: camera, outputs and the rest"]
    assert len(tables) == len(heads), "`vantage control` prints another number of tables than this page has headings"
    text = f"""{GENERATED}# Commands and lamps

A command is an action of an operator. Keys, jog wheels, OSC, RossTalk and MIDI all give commands of this one table. A lamp is a
state that a surface can show. [Control](../operate/control.md) describes how commands are sent and lamps are received.
`vantage control` prints these tables, and `vantage control --json` prints them for programs.

In a command N is a number, PERCENT is a share of the normal speed, STEPS are steps of a jog wheel, and TIME and NAME are words.
"""
    for head, table in zip(heads, tables):
        text += f"\n## {head}\n\n{table}\n"
    return text


def metrics_page(source):
    with open(source, encoding="utf-8") as file:
        code = file.read()
    code = re.sub(r"//[^\n]*", "", code)
    calls = re.findall(r'\.(gauge|counter|summary|info)\(\s*"([a-z_]+)",\s*((?:"(?:[^"\\]|\\.)*"\s*)+)\)', code)
    assert len(calls) > 20, f"{source} is written differently than tools/reference.py reads it"
    text = f"""{GENERATED}# Metrics

`--metrics http://:9464` of `vantage live` and `vantage play` serves these metrics at `/metrics` as OpenMetrics 1.0 text, for
Prometheus. Times are in seconds. `hw_config/grafana/vantage.json` is a dashboard for Grafana.

| metric | kind | meaning |
| --- | --- | --- |
"""
    for kind, name, words in calls:
        ending = {"counter": "_total", "info": "_info"}.get(kind, "")
        meaning = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', words))
        meaning = re.sub(r"^Deprecated: see (\w+)\.", r"Deprecated, old name of `vantage_\1`.", meaning)
        text += f"| `vantage_{name}{ending}` | {kind} | {cell(meaning)} |\n"
    return text


FORMATS = [
    ("Flight file", "hw_config/moves/demo.toml", "Shots and a move, for `--flight` and `--path`. [Flight](../operate/flight.md) describes its use."),
    ("Clip file", "hw_config/clips.toml", "Clips and the play list, for `--clips`. [Replay](../operate/replay.md) describes its use."),
    ("Desk file", "hw_config/desk.toml", "The arrangement of the desk, for `--desk`. [Desk](../operate/desk.md) describes its use."),
    ("Jog wheel map", "hw_config/jog/shuttle_xpress.toml", "The actions of a jog wheel's controls, for `--wheels`. [Jog wheels](../operate/jog.md) describes its use."),
    ("MIDI map", "hw_config/midi/standard.toml", "The actions of a MIDI surface, for `--control 'midi://all?map=FILE'`. [MIDI surfaces](../operate/midi.md) describes its use."),
    ("RossTalk map", "hw_config/rosstalk/standard.toml", "The actions of RossTalk messages, for `--control 'rosstalk://...?map=FILE'`. [Control](../operate/control.md) describes its use."),
]


def formats_page():
    text = f"""{GENERATED}# File formats

Vantage reads and writes these files. All of them are TOML with a `version`; an unknown key or a wrong value ends the command
with the file, the line and the remedy. The examples are files of the folder `hw_config`, and tests load them.
[rig.toml](rig_toml.md) and [stage.toml](stage_toml.md) have pages of their own. [Takes](../operate/takes.md) describes the
tracks of a take, and [calibration](../build/calibration.md) the calibration files.
"""
    for title, file, words in FORMATS:
        with open(file, encoding="utf-8") as example:
            content = example.read().rstrip("\n")
        text += f"\n## {title}\n\n{words}\nThe example is `{file}`.\n\n```toml\n{content}\n```\n"
    return text


def main():
    programs, folder = sys.argv[1:3]
    os.makedirs(folder, exist_ok=True)
    vantage, rig, calib, sentences = (
        os.path.join(programs, name) for name in ("vantage", "vantage-rig", "vantage-calib", "config_sentences")
    )
    pages = {
        "vantage": help_page("vantage", vantage, "The program of the host. Results go to standard output and the log to standard error. The exit status is 0, or 1 for a failure, or 2 for wrong usage."),
        "vantage_rig": help_page("vantage-rig", rig, "The program of a rig computer. Results go to standard output and the log to standard error. The exit status is 0, or 1 for a failure, or 2 for wrong usage."),
        "vantage_calib": help_page("vantage-calib", calib, "The calibration program. Results go to standard output and the log to standard error. The exit status is 0, or 1 for a failure, or 2 for wrong usage."),
        "rig_toml": toml_page("rig.toml", "hw_config/rig.toml", "`rig.toml` configures one rig computer: `vantage-rig run --config rig.toml`. Relative paths are relative to the folder of the\nfile. An unknown key ends the command with its line and the nearest known key. The commented example is `hw_config/rig.toml`.", sentences, rig_template),
        "stage_toml": toml_page("stage.toml", "hw_config/stage.toml", "`stage.toml` describes a stage for the host: `vantage live --stage stage.toml`. Relative paths are relative to the folder of\nthe file. An unknown key ends the command with its line and the nearest known key. The commented example is\n`hw_config/stage.toml`.", sentences, stage_template),
        "commands": commands_page(vantage),
        "metrics": metrics_page("host_app/metrics/open_metrics.cpp"),
        "formats": formats_page(),
    }
    for name, text in pages.items():
        with open(os.path.join(folder, f"{name}.md"), "w", encoding="utf-8") as file:
            file.write(text.rstrip("\n") + "\n")


if __name__ == "__main__":
    main()
