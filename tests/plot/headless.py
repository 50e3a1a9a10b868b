"""A headless Chromium that opens a page: messages of its console, requests, and a picture of it.

Speaks the DevTools protocol through a pipe: JSON messages that end with a zero byte, on the descriptors 3 and 4 of the browser.
"""

import base64
import json
import os
import shutil
import subprocess
import tempfile
import time

NAMES = ("chromium-headless-shell", "chromium-shell", "chromium", "chromium-browser", "google-chrome", "chrome")


def program():
    """Path of a Chromium, or None; DROGUE_CHROMIUM names another."""
    return os.environ.get("DROGUE_CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)


class Browser:
    """One browser with one page; a context manager, which ends it."""

    def __init__(self, width=1280, height=900):
        self._folder = tempfile.TemporaryDirectory()
        inner_read, self._to = os.pipe()
        self._from, inner_write = os.pipe()
        self._number, self._buffer, self.events = 0, b"", []

        def connect():
            # Both ends away from 3 and 4 first, which may be among them.
            read, write = os.dup(inner_read), os.dup(inner_write)
            high_read, high_write = os.dup2(read, 60), os.dup2(write, 61)
            os.dup2(high_read, 3)
            os.dup2(high_write, 4)

        self._process = subprocess.Popen(
            [program(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--disable-background-networking", f"--window-size={width},{height}", f"--user-data-dir={self._folder.name}",
             "--remote-debugging-pipe", "about:blank"],
            preexec_fn=connect, pass_fds=(3, 4), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )
        os.close(inner_read)
        os.close(inner_write)
        self._session = None
        targets = self.call("Target.getTargets")["targetInfos"]
        page = next(target for target in targets if target["type"] == "page")
        self._session = self.call("Target.attachToTarget", targetId=page["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self._to)
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._from)
        # Its children may still write for a moment.
        shutil.rmtree(self._folder.name, ignore_errors=True)
        self._folder.cleanup()

    def _read(self):
        while b"\0" not in self._buffer:
            part = os.read(self._from, 1 << 16)
            if not part:
                raise RuntimeError("the browser ended")
            self._buffer += part
        line, _, self._buffer = self._buffer.partition(b"\0")
        return json.loads(line)

    def call(self, method, **parameters):
        """Result of a method of the protocol; keeps the events that come before it."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._read()
            if answer.get("id") != self._number:
                self.events.append(answer)
            elif "error" in answer:
                raise RuntimeError(f"{method}: {answer['error']['message']}")
            else:
                return answer["result"]

    def open(self, file):
        """Loads a file; the events of its load are in `events`."""
        self.events = []
        self.call("Page.navigate", url=file.resolve().as_uri())
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events):
            self.events.append(self._read())
        # Scripts may write to the console after the load.
        time.sleep(0.1)
        self.evaluate("1")

    def evaluate(self, expression):
        """Value of an expression of JavaScript in the page."""
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"]["text"])
        return result["result"].get("value")

    def complaints(self):
        """Texts of the console and of exceptions."""
        named = {"Log.entryAdded": lambda p: p["entry"]["text"], "Runtime.consoleAPICalled": lambda p: str(p["args"]),
                 "Runtime.exceptionThrown": lambda p: p["exceptionDetails"]["text"]}
        return [named[event["method"]](event["params"]) for event in self.events if event.get("method") in named]

    def requests(self):
        """Addresses that the page requested, without data in the page itself."""
        urls = [event["params"]["request"]["url"] for event in self.events if event.get("method") == "Network.requestWillBeSent"]
        return [url for url in urls if not url.startswith("data:")]

    def picture(self, file, **clip):
        """Writes a PNG of the whole page, or of a part: x, y, width, height, scale."""
        more = {"clip": clip} if clip else {}
        data = self.call("Page.captureScreenshot", captureBeyondViewport=True, **more)["data"]
        file.write_bytes(base64.b64decode(data))
