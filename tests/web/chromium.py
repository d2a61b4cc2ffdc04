"""Drives headless Chromium by the DevTools protocol over pipes, with Python's own library alone."""

import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

# Far beyond the duration of any step.
LONGEST_WAIT_S = 120


def find_chromium():
    """The path of Chromium, or None."""
    return shutil.which("chromium") or shutil.which("chromium-browser")


class Page:
    """A tab, which keeps its events. End it with `close`: an open tab goes on asking its host."""

    def __init__(self, browser, target, session):
        self._browser, self._target, self._session = browser, target, session
        self._is_open = True
        for domain in ("Page", "Runtime", "Log", "Accessibility", "DOM"):
            self.call(domain + ".enable")
        self.call("Page.setLifecycleEventsEnabled", enabled=True)

    def call(self, method, **parameters):
        return self._browser.call(method, parameters, self._session)

    def open(self, url, width, height, is_phone):
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=is_phone,
        )
        answer = self.call("Page.navigate", url=url)
        if "errorText" in answer:
            raise AssertionError(f"{url}: {answer['errorText']}")
        # Until this event an expression may still be evaluated in the page that was open before.
        self._browser.wait_for_event(
            lambda event: event["method"] == "Page.lifecycleEvent"
            and event["params"]["name"] == "load"
            and event["params"]["loaderId"] == answer["loaderId"]
        )

    def close(self):
        if not self._is_open:
            return
        self._is_open = False
        self._browser.call("Target.closeTarget", {"targetId": self._target})
        self._browser.wait_for_event(
            lambda event: event["method"] == "Target.detachedFromTarget"
            and event["params"]["sessionId"] == self._session
        )

    def value(self, expression):
        """The value of a JavaScript expression; promises are awaited."""
        answer = self.call(
            "Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True
        )
        if "exceptionDetails" in answer:
            raise AssertionError(f"{expression}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def wait_for(self, expression):
        end = time.monotonic() + LONGEST_WAIT_S
        while not self.value(expression):
            if time.monotonic() > end:
                raise AssertionError(f"not within {LONGEST_WAIT_S} s: {expression}")
            time.sleep(0.05)

    def wait_for_frame(self):
        """Waits until what the page has now is drawn. Chromium drops keys before its first frame."""
        self.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")

    def press(self, key):
        codes = {"Tab": (9, ""), "Enter": (13, "\r"), "Space": (32, " ")}
        code, text = codes[key]
        name = " " if key == "Space" else key
        common = {"key": name, "code": key, "windowsVirtualKeyCode": code}
        self.call("Input.dispatchKeyEvent", type="keyDown", text=text, **common)
        self.call("Input.dispatchKeyEvent", type="keyUp", **common)

    def accessible_nodes(self):
        """What a screen reader has: role, name and properties of every node that is not ignored."""
        nodes = self.call("Accessibility.getFullAXTree")["nodes"]
        return [
            {
                "role": node["role"]["value"],
                "name": node.get("name", {}).get("value", ""),
                "properties": {
                    each["name"]: each["value"].get("value") for each in node.get("properties", [])
                },
            }
            for node in nodes
            if not node["ignored"] and "role" in node
        ]

    def screenshot(self):
        """PNG of the visible part."""
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])

    def faults(self):
        """Exceptions and errors that the page has had."""
        return [
            event["params"]
            for event in self._browser.events
            if event.get("sessionId") == self._session
            and (
                event["method"] == "Runtime.exceptionThrown"
                or event["method"] == "Log.entryAdded"
                and event["params"]["entry"]["level"] == "error"
                and event["params"]["entry"]["source"] != "network"
            )
        ]


class Chromium:
    """A browser with a profile of its own, which ends with `close`."""

    def __init__(self, program):
        self._profile = tempfile.mkdtemp(prefix="vantage-chromium-")
        to_browser, self._out = os.pipe()
        self._in, from_browser = os.pipe()
        self._process = subprocess.Popen(
            [
                "/bin/sh",
                "-c",
                f'exec "$@" 3<&{to_browser} 4>&{from_browser}',
                "sh",
                program,
                "--headless",
                "--remote-debugging-pipe",
                "--no-sandbox",
                "--disable-gpu",
                "--hide-scrollbars",
                "--force-color-profile=srgb",
                "--disable-lcd-text",
                "--disable-background-networking",
                "--disable-component-update",
                "--no-first-run",
                "--lang=en",
                f"--user-data-dir={self._profile}",
                "about:blank",
            ],
            pass_fds=(to_browser, from_browser),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_browser)
        os.close(from_browser)
        self._rest, self._number = b"", 0
        self.events = []

    def call(self, method, parameters=None, session=None):
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters or {}}
        if session:
            message["sessionId"] = session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self._out, data) :]
        while True:
            answer = self._next()
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise AssertionError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            if "method" in answer:
                self.events.append(answer)

    def wait_for_event(self, is_awaited):
        """Waits for an event, which may have come already since the last `new_page`."""
        seen = 0
        while True:
            for event in self.events[seen:]:
                if is_awaited(event):
                    return
            seen = len(self.events)
            message = self._next()
            if "method" in message:
                self.events.append(message)

    def _next(self):
        while b"\0" not in self._rest:
            if not select.select([self._in], [], [], LONGEST_WAIT_S)[0]:
                raise AssertionError("Chromium does not answer")
            more = os.read(self._in, 1 << 16)
            if not more:
                raise AssertionError("Chromium has ended")
            self._rest += more
        message, self._rest = self._rest.split(b"\0", 1)
        return json.loads(message)

    def new_page(self):
        self.events = []
        target = self.call("Target.createTarget", {"url": "about:blank"})["targetId"]
        attached = self.call("Target.attachToTarget", {"targetId": target, "flatten": True})
        return Page(self, target, attached["sessionId"])

    def close(self):
        for pipe in (self._out, self._in):
            os.close(pipe)
        self._process.terminate()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        shutil.rmtree(self._profile, ignore_errors=True)
