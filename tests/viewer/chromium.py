"""Chromium without a window, driven through its DevTools protocol, and what it says of a page: requests, messages of
the console, the accessibility tree.
"""

import base64
import json
import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

SECONDS = 30.0  # that an answer may take
KEYS = {"ArrowRight": 39, "ArrowLeft": 37, "ArrowUp": 38, "ArrowDown": 40, "PageDown": 34, "PageUp": 33, "Home": 36,
        "End": 35, "Tab": 9, "Enter": 13, "Escape": 27}  # fmt: skip


class Browser:
    """One tab of a running Chromium."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket, self.count, self.session = socket, 0, ""
        self.events: list[dict[str, Any]] = []
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network", "Accessibility", "DOM"):
            self.ask(f"{domain}.enable")

    def ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        """The result of a method of the protocol. What happens until it is there is added to `events`."""
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        self.socket.send(json.dumps(message | ({"sessionId": self.session} if self.session else {})))
        while (answer := self._next()).get("id") != self.count:
            self.events.append(answer)
        assert "error" not in answer, (method, answer)
        return answer["result"]

    def _next(self) -> dict[str, Any]:
        return json.loads(self.socket.recv(timeout=SECONDS))

    def size(self, width: int, height: int, phone: bool = False) -> None:
        """Of the page's window, in CSS pixels."""
        self.ask(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2 if phone else 1,
            mobile=phone,
        )  # fmt: skip
        self.ask("Emulation.setTouchEmulationEnabled", enabled=phone)

    def open(self, address: str) -> None:
        """Open a page, and wait until it is loaded. Events of earlier pages are forgotten."""
        for url in ("about:blank", address):  # not from page to page: with the same path, nothing would be loaded
            self.events.clear()
            self.ask("Page.navigate", url=url)
            while not self.said("Page.loadEventFired"):
                self.events.append(self._next())

    def said(self, method: str) -> list[dict[str, Any]]:
        """The parameters of all events of this kind."""
        return [event["params"] for event in self.events if event.get("method") == method]

    def run(self, script: str) -> Any:
        """The value of an expression of JavaScript."""
        found = self.ask("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    def key(self, name: str, shift: bool = False) -> None:
        for kind in ("keyDown", "keyUp"):
            self.ask(
                "Input.dispatchKeyEvent", type=kind, key=name, code=name, windowsVirtualKeyCode=KEYS[name],
                modifiers=8 if shift else 0,
            )  # fmt: skip

    def move(self, x: float, y: float) -> None:
        self.ask("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)

    def click(self, x: float, y: float) -> None:
        for kind in ("mousePressed", "mouseReleased"):
            self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def touch(self, *places: tuple[float, float]) -> None:
        """A finger goes through these places."""
        for k, (x, y) in enumerate(places):
            kind = "touchMove" if k else "touchStart"
            self.ask("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y}])
        self.ask("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def named(self) -> list[tuple[str, str]]:
        """(role, name) of everything that can have the focus, as a screen reader gets them."""
        nodes = self.ask("Accessibility.getFullAXTree")["nodes"]
        return [
            (node["role"]["value"], node.get("name", {}).get("value", ""))
            for node in nodes
            if any(p["name"] == "focusable" and p["value"]["value"] for p in node.get("properties", ()))
        ]

    def picture(self, path: Path) -> None:
        path.write_bytes(base64.b64decode(self.ask("Page.captureScreenshot")["data"]))


@contextmanager
def chromium(folder: Path) -> Iterator[Browser]:
    """A browser whose profile is in this folder."""
    command = ["chromium", "--headless=new", "--remote-debugging-port=0", f"--user-data-dir={folder}", "--disable-gpu"]
    if os.geteuid() == 0:
        command.append("--no-sandbox")  # Chromium has none for root
    with subprocess.Popen([*command, "about:blank"], stderr=subprocess.PIPE, text=True) as program:
        try:
            assert program.stderr
            said = next(line for line in program.stderr if line.startswith("DevTools listening on "))
            with connect(said.split()[-1], max_size=None) as socket:
                yield Browser(socket)
        finally:
            program.terminate()
