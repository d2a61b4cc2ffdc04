#!/usr/bin/python3
"""Measures how fast a show serves studio devices and programs, and writes docs/results/studio.md.

  tests/bench/studio.py PROGRAMS [PART...]     PROGRAMS is build/release/bin; without parts all
Parts: opentrackio, companion, page, clients, python. All take about five minutes, and need Chromium, Node.js and npm.
With parts or `--print` nothing is written.
"""

import http.client
import json
import os
import platform
import re
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

SOURCES = Path(__file__).resolve().parents[2]
TAKE = SOURCES / "tests" / "takes" / "version_1.mkv"
RATE_HZ = 60000 / 1001
SO_TIMESTAMPNS = 35
sys.path[:0] = [str(SOURCES / "tests" / "web"), str(SOURCES / "python")]


def quantile(values, share):
    return sorted(values)[min(int(share * len(values)), len(values) - 1)]


def spread(values):
    return f"median {quantile(values, 0.5):.2f} ms, longest {max(values):.2f} ms"


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Show:
    """`vantage play` without a window over a copy of a take, which keeps its clips beside it."""

    def __init__(self, programs, folder, *options, take=TAKE):
        copy = shutil.copy(take, folder)
        self._process = subprocess.Popen(
            [programs / "vantage", "play", copy, "--headless", "--json", *options],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )

    def summary(self):
        return json.loads(self._process.communicate()[0].splitlines()[-1])

    def end(self):
        self._process.terminate()
        self._process.communicate()


def opentrackio(programs, folder, seconds=60):
    """Packets of OpenTrackIO at 59.94 Hz, by the time at which the kernel took them."""
    port = free_port(socket.SOCK_DGRAM)
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
    receiver.bind(("127.0.0.1", port))
    receiver.settimeout(60)
    show = Show(
        programs, folder, "--size", "96x72", "--rate", "59.94", "--loop", "--seconds", str(seconds),
        "--output", f"opentrackio://127.0.0.1:{port}",
    )  # fmt: skip
    packets = []
    try:
        while True:
            data, ancillary, _, _ = receiver.recvmsg(65536, 64)
            seconds_, nanoseconds = struct.unpack("@qq", ancillary[0][2])
            packets.append((seconds_ + nanoseconds * 1e-9, json.loads(data[16:])))
            receiver.settimeout(3)
    except socket.timeout:
        pass
    summary = show.summary()
    numbers = [sample["timing"]["sequenceNumber"] for _, sample in packets]
    missing = numbers[-1] - numbers[0] + 1 - len(set(numbers))
    # The grid of ticks is the one on which no packet is early.
    start = min(at - number / RATE_HZ for (at, _), number in zip(packets, numbers))
    late_ms = [1000 * (at - number / RATE_HZ - start) for (at, _), number in zip(packets, numbers)]
    period_ms = 1000 / RATE_HZ
    faults = schema_faults([sample for _, sample in packets[::20]])
    return {
        "packets": len(packets),
        "missing": missing,
        "later than half a period": sum(late > period_ms / 2 for late in late_ms),
        "later than a period": sum(late > period_ms for late in late_ms),
        "lateness": f"{spread(late_ms)}, 99.9 % within {quantile(late_ms, 0.999):.2f} ms",
        "samples that the schema refuses": faults,
        "ticks that the programme repeated": summary["repeated_ticks"],
    }


def schema_faults(samples):
    schema = Path(os.environ.get("VANTAGE_DATA", SOURCES.parent / "shared" / "data")) / "opentrackio" / "schema.json"
    try:
        import jsonschema
    except ImportError:
        return "not checked, python3-jsonschema is missing"
    if not schema.exists():
        return "not checked, the schema is missing"
    validator = jsonschema.Draft202012Validator(json.loads(schema.read_text()))
    return f"{sum(not validator.is_valid(sample) for sample in samples)} of {len(samples)}"


def companion(programs, folder):
    """Presses of the Companion module; its test prints them."""
    done = subprocess.run(
        [SOURCES / "companion" / "test" / "run_tests.sh", programs / "vantage", programs.parent / "companion"],
        capture_output=True,
        text=True,
        check=False,
    )
    if "SKIPPED" in done.stdout or done.returncode != 0:
        return {"companion": done.stdout.splitlines()[-1] if done.stdout else done.stderr}
    found = re.findall(r"^# (from .*?): (.*)$", done.stdout, re.M)
    return dict(found)


def page(programs, folder):
    """First paint of the page over a live stage of eight rigs."""
    from chromium import Chromium, find_chromium

    if find_chromium() is None:
        return {"page": "not measured, there is no Chromium"}
    port = free_port(socket.SOCK_STREAM)
    stage = Stage(programs, folder, 8)
    try:
        show = subprocess.Popen(
            [programs / "vantage", "live", "--stage", stage.file, "--headless", "--size", "320x180", "--json"]
            + ["--web", f"http://127.0.0.1:{port}", "--wait", "100", "--seconds", "600"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        wait_for_rigs(port, 8)
        browser = Chromium(find_chromium())
        paints, rigs = [], 0
        for _ in range(5):
            tab = browser.new_page()
            tab.open(f"http://127.0.0.1:{port}/", 412, 915, True)
            tab.wait_for("document.querySelectorAll('.rig').length > 0")
            tab.wait_for("performance.getEntriesByType('paint').length === 2")
            paints.append(tab.value("performance.getEntriesByName('first-contentful-paint')[0].startTime"))
            rigs = tab.value("document.querySelectorAll('.rig').length")
        browser.close()
        show.terminate()
        show.communicate()
    finally:
        stage.end()
    return {"rigs": rigs, "first contentful paint": spread(paints)}


RIG = """version = 1
name = "{name}"
[source]
rate_hz = 2
width_px = {width}
height_px = {height}
[virtual_rig]
azimuth_deg = {azimuth}
[match]
matcher = "exact"
[stream]
bind = "tcp://127.0.0.1:{port}"
"""


class Stage:
    """Rigs of the virtual stage, at a small size and rate."""

    def __init__(self, programs, folder, rigs, size="96x72"):
        self.file = Path(folder) / "stage.toml"
        self._rigs = []
        width, height = size.split("x")
        text = "version = 1\nrate_hz = 2\n"
        for i in range(rigs):
            port = free_port(socket.SOCK_STREAM)
            name = f"rig{i + 1}"
            text += f'[[rigs]]\nname = "{name}"\nendpoint = "tcp://127.0.0.1:{port}"\n'
            config = Path(folder) / f"{name}.toml"
            config.write_text(RIG.format(name=name, width=width, height=height, azimuth=360 / rigs * i, port=port))
            self._rigs.append(
                subprocess.Popen(
                    [programs / "vantage-rig", "run", "--config", config],
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                )
            )
        self.file.write_text(text)

    def end(self):
        for rig in self._rigs:
            rig.terminate()
        for rig in self._rigs:
            rig.wait()


def wait_for_rigs(port, rigs):
    """Until so many rigs of the page's state are live, for at most two minutes."""
    for _ in range(240):
        try:
            state = get_json(port, "/state")
            if sum(each["state"] == "live" for each in state.get("rigs", [])) == rigs:
                return
        except (ConnectionError, http.client.HTTPException):
            pass
        time.sleep(0.5)


def get_json(port, path):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    connection.request("GET", path)
    return json.loads(connection.getresponse().read())


def clients(programs, folder, seconds=20):
    """Ticks that a programme misses without and with 50 clients of the page."""
    results = {}
    for count in (0, 50):
        port = free_port(socket.SOCK_STREAM)
        show = Show(
            programs, folder, "--size", "320x240", "--rate", "25", "--speed", "0", "--seconds", str(seconds),
            "--web", f"http://127.0.0.1:{port}",
        )  # fmt: skip
        wait_for_rigs(port, 2)
        end, answers = time.monotonic() + seconds - 5, []
        threads = [threading.Thread(target=ask, args=(port, end, answers)) for _ in range(count)]
        for each in threads:
            each.start()
        for each in threads:
            each.join()
        summary = show.summary()
        late = summary["tick_late_ms"]
        results[f"{count} clients"] = (
            f"{len(answers) / (seconds - 5):.0f} requests per second, {sum(a != 200 for a in answers)} refused; "
            f"{summary['missed_ticks']} of {late['count']} ticks missed, 99 % within {late['p99']:.1f} ms"
        )
    return results


def ask(port, end, answers):
    """What one tablet asks for, until `end`."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    while time.monotonic() < end:
        for path in ("/programme.jpg", "/state"):
            connection.request("GET", path)
            answer = connection.getresponse()
            answer.read()
            answers.append(answer.status)
        time.sleep(0.25)


def python(programs, folder):
    """Time of a frame set in Python, beyond its decoding."""
    os.environ["VANTAGE_PROGRAMS"] = str(programs)
    import vantage

    results = {}
    for size in ("320x240", "640x480", "1280x720"):
        path = made_take(programs, Path(folder), 2, size)
        with vantage.Take(path) as take:
            for frames in take:  # the first use of everything
                _ = frames[0].colour
            whole, beyond = [], []
            for pulse in list(take.pulses) * 3:
                start = time.perf_counter()
                frames = take.at(pulse)
                arrays = [(view.colour, view.disparity_steps) for view in frames]
                whole.append(1000 * (time.perf_counter() - start))
                beyond.append(whole[-1] - 1000 * frames.decoding_s)
            del arrays
        results[f"2 rigs of {size}"] = f"{spread(beyond)} beyond decoding ({spread(whole)} in all)"
    return results


def made_take(programs, folder, rigs, size):
    """A short take of the virtual stage."""
    stage = Stage(programs, folder, rigs, size)
    path = folder / f"{rigs}_{size}.mkv"
    try:
        subprocess.run(
            [programs / "vantage", "live", "--stage", stage.file, "--headless", "--size", "96x72", "--wait", "100"]
            + ["--synth", "points", "--seconds", "6", "--take", path],
            check=True,
            capture_output=True,
        )
    finally:
        stage.end()
    return path


PARTS = {
    "opentrackio": (opentrackio, "OpenTrackIO at 59.94 Hz for 60 s", "no late packet, and samples that the schema accepts"),
    "companion": (companion, "Companion", "a key press becomes a command within 20 ms"),
    "page": (page, "The page for tablets", "first paint within 1 s with 8 rigs"),
    "clients": (clients, "50 clients of the page", "no tick missed"),
    "python": (python, "A frame set in Python", "at most 5 ms more than decoding takes"),
}


def main():
    arguments = [each for each in sys.argv[1:] if each != "--print"]
    if not arguments or any(part not in PARTS for part in arguments[1:]):
        sys.exit(__doc__)
    programs = Path(arguments[0]).resolve()
    with open("/proc/cpuinfo", encoding="utf8") as file:
        model = next((line.split(":")[1].strip() for line in file if line.startswith("model name")), platform.machine())
    text = (
        "# Studio\n\n"
        "This page says how fast Vantage serves the devices and programs of a studio: a receiver of camera tracking, a\n"
        "Stream Deck, tablets, and Python. All of them run on one computer and talk over loopback.\n\n"
        "```text\ntests/bench/studio.py build/release/bin\n```\n\n"
        "The command takes four minutes and writes this page. Each part states its goal first.\n\n"
        f"Computer: {os.cpu_count()} processors ({model}), load {os.getloadavg()[0]:.1f} at the start, no GPU needed.\n"
    )
    for part in arguments[1:] or PARTS:
        measure, title, goal = PARTS[part]
        with tempfile.TemporaryDirectory(prefix="vantage-studio-") as folder:
            found = measure(programs, folder)
        text += f"\n## {title}\n\nGoal: {goal}.\n\n| measure | result |\n| --- | --- |\n"
        text += "".join(f"| {name} | {value} |\n" for name, value in found.items())
    text += (
        "\n## Limits\n\n"
        "- Other programs that need a processor lengthen the longest times; the load above tells how many ran.\n"
        "- Loopback has no network delay; a studio's network adds its own.\n"
        "- Real devices were not connected: the measuring programs speak their protocols.\n\n"
        "[Files of other programs](interop.md) lists what was read from them.\n"
    )
    print(text)
    if "--print" not in sys.argv and not arguments[1:]:
        (SOURCES / "docs" / "results" / "studio.md").write_text(text)


if __name__ == "__main__":
    main()
