"""The page for tablets and phones in headless Chromium: what it looks like, keys, and screen readers.

page_test.py checks it against the pictures and layouts in golden/; `VANTAGE_GOLDEN=write page_test.py`
writes them anew. Look at the pictures before you commit them.
"""

import collections
import io
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import urlparse

import numpy as np
from PIL import Image, ImageDraw

from chromium import LONGEST_WAIT_S, Chromium, find_chromium

HERE = Path(__file__).resolve().parent
SOURCES = HERE.parents[1]
PAGE = SOURCES / "host_app" / "web" / "page.html"
GOLDEN = HERE / "golden"
TAKE = SOURCES / "tests" / "takes" / "version_1.mkv"
# The program `vantage`, named by run_tests.sh.
PROGRAM = os.environ.get("VANTAGE", "")
SIZES = {"phone": (412, 915), "tablet": (1180, 820)}

# Other fonts make lines a little wider or higher: shares of the picture's width and of the page's
# height, differences of grey levels of a picture of 1/16 of the size.
MOST_X, MOST_Y = 0.04, 0.06
MOST_MEAN_GREY, MOST_GREY = 6, 60


def rig(name, state="live", mark="good", sentences=(), locked=True):
    return {
        "name": name,
        "state": state,
        "mark": mark,
        "sentences": list(sentences),
        "clock": "PTP, 0.2 µs" if locked else "not disciplined",
        "locked": locked,
        "calibration": "3 days old",
        "temperature_c": 51.4,
    }


STATE = {
    "rigs": [rig(f"rig{i}") for i in range(1, 7)]
    + [
        rig("rig7", "late", "care", ["the network loses 3 % of its frames"]),
        rig("rig8", "no link", "bad", ["it does not answer at 10.0.0.18"], locked=False),
    ],
    "outputs": [
        {"name": "srt://10.0.0.5:9000", "state": "on", "failed": False},
        {"name": "programme.mkv", "state": "failed", "failed": True},
    ],
    "verdict": {"level": "caution", "why": "rig8: no link"},
    "timecode": "12:34:56:07",
    "take": "A take is recorded: 83 s, 1210 MB",
    "control": True,
    "board": "9x6",
    "lamps": {"live": True, "hold": False, "take": True, "programme": True, "preview": False, "auto": -1},
}
BOARD = {
    "found": True,
    "why": "",
    "seen": 54,
    "of": 54,
    "square_px": 31.5,
    "blur_px": 0.8,
    "burnt_out_share": 0.0,
    "mirrored": False,
    "corners": [[0.3 + 0.05 * i, 0.3 + 0.07 * j] for i in range(9) for j in range(6)],
}


def jpeg(colour):
    """A picture with a bright disc."""
    image = Image.new("RGB", (640, 400), colour)
    ImageDraw.Draw(image).ellipse((220, 100, 420, 300), fill=(230, 210, 160))
    file = io.BytesIO()
    image.save(file, "JPEG", quality=90)
    return file.getvalue()


class FakeHost(ThreadingHTTPServer):
    """A host whose state stands still; without a state it asks for its PIN. `commands` are those that it
    was given; it refuses them with `refusal`. An answer to a path in `broken` breaks off in its middle.
    `asked[path]` is set when a path is asked for, and `held[path]` holds its answer until it is set."""

    refusal = ""

    def __init__(self, state):
        self.state, self.commands = state, []
        self.broken, self.held = set(), {}
        self.asked = collections.defaultdict(threading.Event)
        self.got_command = threading.Event()
        super().__init__(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.serve_forever, daemon=True).start()

    @property
    def url(self):
        return f"http://127.0.0.1:{self.server_address[1]}/"

    def close(self):
        self.shutdown()
        self.server_close()

    def handle_error(self, request, client_address):
        # A page that is closed does not wait for its answers.
        if not isinstance(sys.exc_info()[1], ConnectionError):
            super().handle_error(request, client_address)


class Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    pictures = {"/programme.jpg": jpeg((40, 70, 110)), "/rig.jpg": jpeg((60, 60, 60))}

    def answer(self, status, kind, body):
        if self.path in self.server.held:
            self.server.held[self.path].wait(LONGEST_WAIT_S)
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("X-Sharpness", "41.5")
        self.end_headers()
        if self.path in self.server.broken:
            self.close_connection = True
            body = body[: len(body) // 2]
        self.wfile.write(body)

    def do_GET(self):
        self.server.asked[self.path].set()
        path = urlparse(self.path).path
        if path == "/":
            self.answer(200, "text/html; charset=utf-8", PAGE.read_bytes())
        elif self.server.state is None:
            self.answer(401, "text/plain", b"the PIN is needed\n")
        elif path in self.pictures:
            self.answer(200, "image/jpeg", self.pictures[path])
        elif path in ("/state", "/board"):
            value = self.server.state if path == "/state" else BOARD
            self.answer(200, "application/json", json.dumps(value).encode())
        else:
            self.answer(404, "text/plain", b"there is no such page\n")

    def do_POST(self):
        words = self.rfile.read(int(self.headers["Content-Length"])).decode()
        self.server.commands.append(words)
        self.server.got_command.set()
        if self.path == "/login":
            self.answer(401, "text/plain", b"that is not the PIN\n")
        elif self.server.refusal:
            self.answer(400, "text/plain", self.server.refusal.encode())
        else:
            self.answer(204, "text/plain", b"")

    def log_message(self, *_):
        pass


BOXES = """[...document.querySelectorAll("header, section, figure, h1, h2, button, meter, form, input, p, li")]
  .map(each => [each, each.getBoundingClientRect()])
  .filter(([each, box]) => box.width > 0 && box.height > 0)
  .map(([each, box]) => [each.tagName.toLowerCase() + " " + (each.id || each.getAttribute("aria-label") ||
    (each.tagName === "BUTTON" ? each.textContent : "")), box.x, box.y, box.width, box.height].map(
    value => typeof value === "number" ? Math.round(value) : value.trim()))"""


def layout_differences(boxes, golden, width):
    """Sentences on boxes that are missing, new, or elsewhere."""
    if [box[0] for box in boxes] != [box[0] for box in golden]:
        return [f"other elements: {sorted({b[0] for b in boxes} ^ {b[0] for b in golden})}"]
    height = max(box[2] + box[4] for box in golden)
    differences = []
    for (name, *now), (_, *before) in zip(boxes, golden):
        for i, (most, share) in enumerate([(width, MOST_X), (height, MOST_Y)] * 2):
            if abs(now[i] - before[i]) > most * share:
                differences.append(f"{name}: {'x y width height'.split()[i]} {before[i]} is {now[i]}")
    return differences


def picture_differences(png, golden):
    """Sentences on pictures that look different, however the letters are drawn."""
    now, before = (np.asarray(coarse(each), dtype=float) for each in (png, golden))
    if now.shape != before.shape:
        return [f"another size: {now.shape} for {before.shape}"]
    grey = np.abs(now - before).max(axis=2)
    found = []
    if grey.mean() > MOST_MEAN_GREY:
        found.append(f"it differs by {grey.mean():.1f} grey levels on average")
    if grey.max() > MOST_GREY:
        row, column = np.unravel_index(grey.argmax(), grey.shape)
        found.append(f"at {16 * column}, {16 * row} it differs by {grey.max():.0f} grey levels")
    return found


def coarse(png):
    image = Image.open(io.BytesIO(png)).convert("RGB")
    return image.resize((image.width // 16, image.height // 16), Image.Resampling.BOX)


def wait_until_it_listens(process, port):
    end = time.monotonic() + LONGEST_WAIT_S
    while True:
        try:
            socket.create_connection(("127.0.0.1", port)).close()
            return
        except ConnectionRefusedError:
            if process.poll() is not None:
                raise AssertionError(f"the show has ended with {process.returncode}") from None
            if time.monotonic() > end:
                raise AssertionError(f"the show does not listen within {LONGEST_WAIT_S} s") from None
        time.sleep(0.05)


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Chromium(find_chromium())

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()

    def opened(self, size="tablet", state=None):
        self.host = FakeHost(state)
        self.addCleanup(self.host.close)
        page = self.new_page()
        page.open(self.host.url, *SIZES[size], size == "phone")
        if state is None:
            page.wait_for("!document.getElementById('login').hidden")
        else:
            # The state and the picture come in either order.
            page.wait_for("document.getElementById('level').textContent !== 'connecting'")
            page.wait_for("document.getElementById('picture').naturalWidth > 0")
        page.wait_for_frame()
        return page

    def new_page(self):
        page = self.browser.new_page()
        self.addCleanup(page.close)
        return page

    def open_rig(self, page):
        page.value("document.querySelector('[data-rig=rig7]').click()")
        page.wait_for("document.getElementById('rigpicture').naturalWidth > 0")
        page.value("document.getElementById('board').click()")
        page.wait_for("document.querySelectorAll('#marks circle').length === 54")
        # The focus ring is drawn around the button that has the focus.
        page.value("document.activeElement.blur()")

    def views(self):
        """Every view at every size: its name, its width and the page, which is closed after its turn."""
        for size, (width, _) in SIZES.items():
            for view in ("programme", "rig", "login"):
                page = self.opened(size, None if view == "login" else STATE)
                if view == "rig":
                    self.open_rig(page)
                if view == "login":
                    page.value("document.activeElement.blur()")
                yield f"{view}_{size}", width, page
                page.close()

    def test_looks_as_it_did(self):
        for name, width, page in self.views():
            with self.subTest(name):
                png, boxes = page.screenshot(), page.value(BOXES)
                picture, layout = GOLDEN / f"{name}.png", GOLDEN / f"{name}.json"
                if os.environ.get("VANTAGE_GOLDEN") == "write":
                    GOLDEN.mkdir(exist_ok=True)
                    picture.write_bytes(png)
                    layout.write_text("[\n" + ",\n".join(json.dumps(b) for b in boxes) + "\n]\n")
                golden = json.loads(layout.read_text())
                self.assertEqual(layout_differences(boxes, golden, width), [])
                self.assertEqual(picture_differences(png, picture.read_bytes()), [])
                self.assertEqual(page.faults(), [])

    def test_the_comparison_notices_faults(self):
        page = self.opened("tablet", STATE)
        golden = json.loads((GOLDEN / "programme_tablet.json").read_text())
        picture = (GOLDEN / "programme_tablet.png").read_bytes()
        page.value("document.getElementById('level').style.background = '#ffffff'")
        self.assertNotEqual(picture_differences(page.screenshot(), picture), [])
        page.value("document.querySelector('#transport').style.display = 'block'")
        self.assertNotEqual(layout_differences(page.value(BOXES), golden, SIZES["tablet"][0]), [])
        page.value("document.querySelector('#shots button').remove()")
        self.assertIn("other elements", layout_differences(page.value(BOXES), golden, 1)[0])

    def test_another_font_is_no_fault(self):
        page = self.opened("tablet", STATE)
        page.value("document.body.style.fontFamily = 'monospace'")
        golden = json.loads((GOLDEN / "programme_tablet.json").read_text())
        picture = (GOLDEN / "programme_tablet.png").read_bytes()
        self.assertEqual(layout_differences(page.value(BOXES), golden, SIZES["tablet"][0]), [])
        self.assertEqual(picture_differences(page.screenshot(), picture), [])

    def test_fits_fingers_and_the_width_of_the_device(self):
        for name, width, page in self.views():
            with self.subTest(name):
                self.assertLessEqual(page.value("document.documentElement.scrollWidth"), width)
                for tag, _, _, wide, high in page.value(BOXES):
                    if tag.startswith(("button", "input")):
                        self.assertGreaterEqual(min(wide, high), 44, tag)

    def test_the_picture_of_a_rig_is_large_on_a_phone(self):
        page = self.opened("phone", STATE)
        self.open_rig(page)
        box = page.value(
            "(box => [box.x, box.y, box.width])(document.getElementById('rigpicture').getBoundingClientRect())"
        )
        self.assertEqual(box, [0, 0, SIZES["phone"][0]])

    def test_a_tablet_shows_all_keys_at_once(self):
        page = self.opened("tablet", STATE)
        bottoms = [y + high for tag, _, y, _, high in page.value(BOXES) if tag.startswith("button")]
        self.assertLessEqual(max(bottoms), SIZES["tablet"][1])

    def test_a_refused_command_is_told_where_it_is_seen(self):
        page = self.opened("phone", STATE)
        self.host.refusal = "there is no take to hold"
        page.value("document.querySelector('#transport button').click()")
        page.wait_for("document.getElementById('said').textContent !== ''")
        self.assertEqual(page.value("document.getElementById('said').textContent"), self.host.refusal)
        top, bottom = page.value(
            "(box => [box.top, box.bottom])(document.getElementById('said').getBoundingClientRect())"
        )
        self.assertGreaterEqual(top, 0)
        self.assertLessEqual(bottom, SIZES["phone"][1])

    def focused(self, page):
        return page.value(
            "(each => each.dataset.rig || each.id || each.getAttribute('aria-label') || each.textContent)"
            "(document.activeElement)"
        )

    def test_keys_reach_everything_in_order(self):
        page = self.opened("tablet", STATE)
        order = []
        for _ in range(34):
            page.press("Tab")
            order.append(self.focused(page))
        rigs = [each["name"] for each in STATE["rigs"]]
        self.assertEqual(order[: len(rigs)], rigs)
        self.assertEqual(order[len(rigs) : len(rigs) + 4], ["Live", "Hold", "Frame back", "Frame forward"])
        self.assertEqual(order[21:], [f"Shot {i}" for i in range(1, 10)] + ["Cut", "Auto", "Move", "Start view"])

    def test_keys_give_commands_and_open_rigs(self):
        page = self.opened("tablet", STATE)
        page.press("Tab")
        page.press("Enter")
        page.wait_for("!document.getElementById('technician').hidden")
        self.assertEqual(self.focused(page), "back")
        page.press("Tab")
        self.assertEqual(self.focused(page), "board")
        page.press("Space")
        page.wait_for("document.getElementById('board').getAttribute('aria-pressed') === 'true'")
        page.value("document.getElementById('back').focus()")
        page.press("Enter")
        page.wait_for("!document.getElementById('page').hidden")
        self.assertEqual(self.focused(page), "rig1", "the focus is back where it was")
        for _ in STATE["rigs"]:
            page.press("Tab")
        page.press("Space")
        self.assertTrue(self.host.got_command.wait(LONGEST_WAIT_S))
        self.assertEqual(self.host.commands, ["live"])

    def test_screen_readers_have_names_and_states(self):
        for name, _, page in self.views():
            with self.subTest(name):
                nodes = page.accessible_nodes()
                for node in nodes:
                    if node["role"] in ("button", "textbox", "image", "meter", "region", "heading"):
                        self.assertNotEqual(node["name"].strip(), "", node)
                roles = {node["role"] for node in nodes}
                self.assertIn("heading", roles)
        page = self.opened("tablet", STATE)
        nodes = page.accessible_nodes()

        def named(role, name):
            found = [n for n in nodes if n["role"] == role and n["name"] == name]
            self.assertEqual(len(found), 1, (role, name, [n["name"] for n in nodes if n["role"] == role]))
            return found[0]["properties"]

        self.assertEqual(named("button", "Live")["pressed"], "true")
        self.assertEqual(named("button", "Hold")["pressed"], "false")
        named("button", "rig rig8, no link; show its picture")
        named("image", "The programme")
        for part in ("Programme", "Rigs", "Transport", "Shots", "Take and outputs"):
            named("region", part)
        self.assertEqual(len([n for n in nodes if n["role"] == "main"]), 1)
        self.assertTrue(any(n["role"] == "status" and n["properties"].get("live") == "polite" for n in nodes))
        self.assertTrue(any(n["role"] == "alert" for n in nodes))

    def test_a_page_that_only_shows_has_no_active_keys(self):
        page = self.opened("phone", dict(STATE, control=False))
        self.assertTrue(page.value("[...document.querySelectorAll('.keys button')].every(each => each.disabled)"))

    def test_names_and_sentences_are_text(self):
        evil = "<img src=x onerror=alert(1)>"
        state = dict(STATE, rigs=[rig(evil, sentences=[evil])], take=evil, verdict={"level": "ready", "why": evil})
        page = self.opened("phone", state)
        self.assertEqual(page.value("document.querySelectorAll('#page img').length"), 1)
        self.assertEqual(page.value("document.getElementById('why').textContent"), evil)
        self.assertEqual(page.faults(), [])

    def test_goes_on_after_connections_that_break(self):
        of_the_programme = {"/state", "/programme.jpg"}
        of_a_rig = {"/state", "/rig.jpg?rig=rig7", "/board?rig=rig7"}
        for opens_rig in (False, True):
            page = self.opened("tablet", STATE)
            if opens_rig:
                self.open_rig(page)
            self.host.broken = of_a_rig if opens_rig else of_the_programme
            # The page asks for a path again only after it has the answer before.
            for path in self.host.broken:
                for _ in range(3):
                    self.host.asked[path].clear()
                    self.assertTrue(self.host.asked[path].wait(LONGEST_WAIT_S), path)
            self.assertEqual(page.faults(), [])
            page.close()

    def test_never_shows_the_picture_of_another_rig(self):
        page = self.opened("tablet", STATE)
        late, wanted = "/rig.jpg?rig=rig7", "/rig.jpg?rig=rig8"
        self.host.held = {late: threading.Event(), wanted: threading.Event()}
        for held in self.host.held.values():
            self.addCleanup(held.set)
        page.value("document.querySelector('[data-rig=rig7]').click()")
        self.assertTrue(self.host.asked[late].wait(LONGEST_WAIT_S))
        page.value("document.getElementById('back').click()")
        page.value("document.querySelector('[data-rig=rig8]').click()")
        self.host.held[late].set()
        # The page asks for the next picture when it has done with the last one.
        self.assertTrue(self.host.asked[wanted].wait(LONGEST_WAIT_S))
        self.assertFalse(page.value("document.getElementById('rigpicture').hasAttribute('src')"))
        self.host.held[wanted].set()
        page.wait_for("document.getElementById('rigpicture').naturalWidth > 0")

    def test_marks_lie_on_the_picture_whenever_it_is_loaded(self):
        page = self.opened("tablet", STATE)
        page.value("document.querySelector('[data-rig=rig7]').click()")
        page.value(
            "window.shapes = new Set(); window.marks = document.getElementById('marks');"
            "new MutationObserver(() => shapes.add(marks.getAttribute('viewBox'))).observe(marks, { childList: true })"
        )
        page.value("document.getElementById('board').click()")
        page.wait_for("document.querySelectorAll('#marks circle').length === 54")
        for _ in range(5):
            picture = page.value("document.getElementById('rigpicture').src")
            page.wait_for(f"document.getElementById('rigpicture').src !== {json.dumps(picture)}")
        self.assertEqual(page.value("[...shapes]"), ["0 0 640 400"])

    @unittest.skipUnless(PROGRAM, "no program is given")
    def test_a_show_obeys_the_page(self):
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = free.getsockname()[1]
        with tempfile.TemporaryDirectory() as folder:
            take = shutil.copy(TAKE, folder)
            show = subprocess.Popen(
                [PROGRAM, "play", take, "--headless", "--size", "96x72", "--loop", "--seconds", "600"]
                + ["--web", f"http://127.0.0.1:{port}?control=yes&board=9x6"],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            self.addCleanup(show.wait)
            self.addCleanup(show.terminate)
            wait_until_it_listens(show, port)
            page = self.new_page()
            page.open(f"http://127.0.0.1:{port}/", *SIZES["tablet"], False)
            # The page serves rigs that are waited for before there is a programme.
            page.wait_for("document.querySelector('.rig') !== null")
            page.wait_for("document.getElementById('picture').naturalWidth > 0")
            page.wait_for_frame()
            page.value("document.querySelectorAll('#transport button')[1].focus()")
            page.press("Enter")
            page.wait_for("document.querySelectorAll('#transport button')[1].getAttribute('aria-pressed') === 'true'")
            page.value("document.querySelector('.rig').click()")
            page.wait_for("document.getElementById('rigpicture').naturalWidth > 0")
            page.value("document.getElementById('board').click()")
            page.wait_for("document.getElementById('boardsays').textContent.startsWith('no board: the picture')")
            self.assertEqual(page.faults(), [])


if __name__ == "__main__":
    unittest.main()
