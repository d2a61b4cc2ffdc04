"""Tests of obs/obs_tally.py against a small server that speaks obs-websocket 5."""

import base64
import hashlib
import json
import socket
import struct
import subprocess
import sys
import threading
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "obs" / "obs_tally.py"
sys.path.insert(0, str(SCRIPT.parent))
import obs_tally  # noqa: E402

PASSWORD, CHALLENGE, SALT = "secret", "a challenge", "salt"


class FakeObs(threading.Thread):
    """OBS with the scenes On (with the source, within a scene in it) and Off."""

    def __init__(self):
        super().__init__(daemon=True)
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self.programme, self.preview = "Off", "On"
        self.is_identified = threading.Event()
        self.refused = ""
        self._lock = threading.Lock()

    def run(self):
        self._socket, _ = self._listener.accept()
        self._file = self._socket.makefile("rb")
        key = ""
        while line := self._file.readline().strip():
            if line.lower().startswith(b"sec-websocket-key:"):
                key = line.split(b":", 1)[1].strip().decode()
        digest = hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()
        accept = base64.b64encode(digest).decode()
        self._socket.sendall(
            f"HTTP/1.1 101 Switching Protocols\r\nSec-WebSocket-Accept: {accept}\r\n\r\n".encode()
        )
        self.send(0, {"authentication": {"challenge": CHALLENGE, "salt": SALT}})
        try:
            while True:
                self._answer(self._receive())
        except (OSError, struct.error):
            pass
        finally:
            for each in (self._file, self._socket, self._listener):
                each.close()

    def send(self, operation, data):
        text = json.dumps({"op": operation, "d": data}).encode()
        size = bytes([len(text)]) if len(text) < 126 else bytes([126]) + struct.pack(">H", len(text))
        with self._lock:
            self._socket.sendall(bytes([0x81]) + size + text)

    def _receive(self):
        head = self._file.read(2)
        if len(head) < 2:
            raise OSError("the script has left")
        size = head[1] & 0x7F
        if size == 126:
            (size,) = struct.unpack(">H", self._file.read(2))
        mask = self._file.read(4)
        return json.loads(bytes(b ^ mask[i % 4] for i, b in enumerate(self._file.read(size))))

    def _answer(self, message):
        data = message["d"]
        if message["op"] == 1:
            if data["authentication"] != obs_tally.answer_to(PASSWORD, CHALLENGE, SALT):
                self._socket.sendall(bytes([0x88, 2 + 5]) + struct.pack(">H", 4009) + b"wrong")
                return
            self.send(2, {"negotiatedRpcVersion": 1})
            self.is_identified.set()
            return
        scene = data.get("requestData", {}).get("sceneName", "")
        answers = {
            "GetCurrentProgramScene": {"currentProgramSceneName": self.programme},
            "GetCurrentPreviewScene": {"currentPreviewSceneName": self.preview},
            "GetSceneItemList": {"sceneItems": self._items(scene)},
        }
        self.send(
            7,
            {
                "requestId": data["requestId"],
                "requestStatus": {"result": True},
                "responseData": answers[data["requestType"]],
            },
        )

    @staticmethod
    def _items(scene):
        inner = {"sourceName": "Inner", "sourceType": "OBS_SOURCE_TYPE_SCENE", "sceneItemEnabled": True}
        source = {"sourceName": "Vantage", "sourceType": "OBS_SOURCE_TYPE_INPUT"}
        return {
            "On": [inner],
            "Inner": [dict(source, sceneItemEnabled=True)],
            "Off": [dict(source, sceneItemEnabled=False)],
        }.get(scene, [])


class ObsTallyTest(unittest.TestCase):
    def start(self, password):
        self.obs = FakeObs()
        self.obs.start()
        self.display = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.display.bind(("127.0.0.1", 0))
        self.display.settimeout(20)
        self.addCleanup(self.display.close)
        self.script = subprocess.Popen(
            [
                sys.executable,
                SCRIPT,
                f"--port={self.obs.port}",
                f"--password={password}",
                f"--tally=127.0.0.1:{self.display.getsockname()[1]}",
                "--address=5",
            ],
            stderr=subprocess.PIPE,
            text=True,
        )
        self.addCleanup(self.obs.join)
        self.addCleanup(self.script.stderr.close)
        self.addCleanup(self.script.wait)
        self.addCleanup(self.script.kill)

    def wait_for(self, control):
        while (message := self.display.recv(100))[1] != control:
            self.assertEqual(len(message), 18)
        self.assertEqual(message[0], 0x85)
        self.assertEqual(message[2:], b"Vantage         ")

    def test_tally_follows_programme_and_preview(self):
        self.start(PASSWORD)
        self.wait_for(0x32)
        self.obs.programme, self.obs.preview = "On", "Off"
        self.obs.send(5, {"eventType": "CurrentProgramSceneChanged"})
        self.wait_for(0x31)
        self.obs.programme = "Off"
        self.obs.send(5, {"eventType": "CurrentProgramSceneChanged"})
        self.wait_for(0x30)

    def test_tells_why_obs_refuses(self):
        self.start("other")
        self.assertIn("wrong; trying again", self.script.stderr.readline())
        self.assertFalse(self.obs.is_identified.is_set())
        self.wait_for(0x30)


if __name__ == "__main__":
    unittest.main()
