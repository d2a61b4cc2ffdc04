#!/usr/bin/env python3
"""Tally from OBS Studio to Vantage: obs-websocket 5 in, TSL UMD 3.1 out.

    obs_tally.py --source Vantage --password SECRET --tally 127.0.0.1:8900

While the programme scene of OBS shows the source, tally 1 (programme) of the display is lit, and
while the preview scene does in Studio Mode, tally 2 (preview). The host runs with
`--control tsl://:8900`. Without packages beyond Python's own library.
"""

import argparse
import base64
import hashlib
import json
import os
import socket
import struct
import sys
import time

RECONNECT_S = 2
REPEAT_S = 1
SCENES, SCENE_ITEMS, UI = 1 << 2, 1 << 7, 1 << 10


class Closed(Exception):
    """OBS has closed the connection; the message says why."""


class WebSocket:
    """A client of RFC 6455 for texts."""

    def __init__(self, host, port):
        self._socket = socket.create_connection((host, port), timeout=5)
        key = base64.b64encode(os.urandom(16)).decode()
        self._socket.sendall(
            f"GET / HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        self._bytes = b""
        while b"\r\n\r\n" not in self._bytes:
            self._receive()
        head, self._bytes = self._bytes.split(b"\r\n\r\n", 1)
        if b" 101 " not in head.splitlines()[0]:
            raise Closed("the port is not obs-websocket's")

    def _receive(self):
        more = self._socket.recv(65536)
        if not more:
            raise Closed("OBS has closed the connection")
        self._bytes += more

    def send(self, message):
        data = json.dumps(message).encode()
        mask = os.urandom(4)
        size = len(data)
        head = bytes([0x81, 0x80 | size]) if size < 126 else bytes([0x81, 0xFE]) + struct.pack(">H", size)
        self._socket.sendall(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(data)))

    def _frame(self):
        """Kind and content of the next frame; nothing if it is not whole yet."""
        if len(self._bytes) < 2:
            return None
        size, at = self._bytes[1] & 0x7F, 2
        if size >= 126:
            wide = 2 if size == 126 else 8
            if len(self._bytes) < at + wide:
                return None
            size, at = int.from_bytes(self._bytes[at : at + wide], "big"), at + wide
        if len(self._bytes) < at + size:
            return None
        kind, content = self._bytes[0] & 0x0F, self._bytes[at : at + size]
        self._bytes = self._bytes[at + size :]
        return kind, content

    def receive(self, timeout_s):
        """The next message; nothing if none comes in this time."""
        end = time.monotonic() + timeout_s
        while True:
            frame = self._frame()
            if frame is None:
                left = end - time.monotonic()
                if left <= 0:
                    return None
                self._socket.settimeout(left)
                try:
                    self._receive()
                except TimeoutError:
                    return None
                continue
            kind, content = frame
            if kind == 1:
                return json.loads(content)
            if kind == 8:
                code = int.from_bytes(content[:2], "big") if len(content) >= 2 else 0
                reason = content[2:].decode("utf-8", "replace")
                raise Closed(reason or f"OBS has closed the connection (code {code})")


def answer_to(password, challenge, salt):
    """The authentication of obs-websocket 5."""
    secret = base64.b64encode(hashlib.sha256((password + salt).encode()).digest()).decode()
    return base64.b64encode(hashlib.sha256((secret + challenge).encode()).digest()).decode()


def tsl_message(address, label, programme, preview):
    """A display of TSL UMD 3.1: 18 bytes with two tallies at full brightness."""
    control = 0x30 | (0x01 if programme else 0) | (0x02 if preview else 0)
    return bytes([0x80 | address, control]) + label.encode("ascii", "replace")[:16].ljust(16)


class Obs:
    """What OBS shows."""

    def __init__(self, options):
        self._socket = WebSocket(options.host, options.port)
        self._source = options.source
        self._requests = 0
        self.is_changed = True
        hello = self._expect(0)["d"]
        identify = {"rpcVersion": 1, "eventSubscriptions": SCENES | SCENE_ITEMS | UI}
        if "authentication" in hello:
            needed = hello["authentication"]
            identify["authentication"] = answer_to(
                options.password, needed["challenge"], needed["salt"]
            )
        self._socket.send({"op": 1, "d": identify})
        self._expect(2)

    def _expect(self, operation, wanted=None):
        while True:
            message = self._socket.receive(5)
            if message is None:
                raise Closed("OBS does not answer")
            if message["op"] == operation and (wanted is None or message["d"]["requestId"] == wanted):
                return message
            self.is_changed |= message["op"] == 5

    def _ask(self, kind, **data):
        self._requests += 1
        name = str(self._requests)
        self._socket.send(
            {"op": 6, "d": {"requestType": kind, "requestId": name, "requestData": data}}
        )
        answer = self._expect(7, name)["d"]
        return answer.get("responseData", {}) if answer["requestStatus"]["result"] else {}

    def _shows(self, scene, depth=0):
        """Whether a scene shows the source, itself or by a scene within it."""
        if not scene or depth > 8:
            return False
        for item in self._ask("GetSceneItemList", sceneName=scene).get("sceneItems", []):
            if not item["sceneItemEnabled"]:
                continue
            if item["sourceName"] == self._source or self._shows(
                item["sourceName"] if item.get("sourceType") == "OBS_SOURCE_TYPE_SCENE" else "", depth + 1
            ):
                return True
        return False

    def tally(self):
        """Whether the source is on programme, and on preview."""
        self.is_changed = False
        programme = self._ask("GetCurrentProgramScene").get("currentProgramSceneName", "")
        preview = self._ask("GetCurrentPreviewScene").get("currentPreviewSceneName", "")
        return self._shows(programme), self._shows(preview)

    def wait(self, timeout_s):
        message = self._socket.receive(timeout_s)
        self.is_changed |= message is not None and message["op"] == 5


def main():
    parser = argparse.ArgumentParser(description="Send tally from OBS Studio to Vantage.")
    parser.add_argument("--host", default="127.0.0.1", help="computer that OBS runs on")
    parser.add_argument("--port", type=int, default=4455, help="port of obs-websocket")
    parser.add_argument("--password", default=os.environ.get("OBS_PASSWORD", ""))
    parser.add_argument("--source", default="Vantage", help="name of the source in OBS")
    parser.add_argument("--tally", default="127.0.0.1:8900", help="HOST:PORT of --control tsl://")
    parser.add_argument("--address", type=int, default=0, help="display of TSL UMD, 0 to 126")
    options = parser.parse_args()
    host, _, port = options.tally.rpartition(":")
    if not host or not port.isdigit() or not 0 <= options.address <= 126:
        parser.error("--tally is HOST:PORT, and --address is 0 to 126")
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    told = None
    while True:
        try:
            obs = Obs(options)
            print("OBS is connected", file=sys.stderr)
            state = (False, False)
            while True:
                if obs.is_changed:
                    state = obs.tally()
                    if state != told:
                        print(f"programme {state[0]}, preview {state[1]}", file=sys.stderr, flush=True)
                    told = state
                out.sendto(tsl_message(options.address, options.source, *state), (host, int(port)))
                obs.wait(REPEAT_S)
        except (Closed, OSError) as error:
            if told != "away":
                print(f"{error}; trying again", file=sys.stderr, flush=True)
            told = "away"
            out.sendto(tsl_message(options.address, options.source, False, False), (host, int(port)))
            time.sleep(RECONNECT_S)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        pass
