"""Chromium without a window, steered over its pipe by the DevTools protocol: messages of JSON that end with a zero
byte, on the file descriptors 3 and 4."""

import base64
import json
import os
import shutil
import subprocess
import tempfile

PROGRAMS = "chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"
OPTIONS = ("--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-angle=swiftshader",
           "--enable-unsafe-swiftshader",
           "--hide-scrollbars", "--no-first-run", "--disable-extensions", "--remote-debugging-pipe")


def find_browser():
    """Path of a Chromium, or None."""
    return next(filter(None, map(shutil.which, PROGRAMS)), None)


class Browser:
    """A browser with one page. `events`: what it told, (method, parameters)."""

    def __init__(self, program, *options):
        self.profile = tempfile.TemporaryDirectory(prefix="squeal-browser-", ignore_cleanup_errors=True)
        to_browser, self.write_end = os.pipe()
        self.read_end, from_browser = os.pipe()
        moved = [os.dup2(end, 200 + i) for i, end in enumerate((to_browser, from_browser))]
        place = f'exec "$0" "$@" 3<&{moved[0]} 4>&{moved[1]}'
        command = ["bash", "-c", place, program, *OPTIONS, *options, f"--user-data-dir={self.profile.name}",
                   "about:blank"]
        self.process = subprocess.Popen(command, pass_fds=moved, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for end in (to_browser, from_browser, *moved):
            os.close(end)
        self.number, self.rest, self.events, self.answers, self.session = 0, b"", [], {}, None
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.ask(f"{domain}.enable")

    def read(self):
        """Takes one piece of what the browser says."""
        piece = os.read(self.read_end, 1 << 20)
        if not piece:
            raise RuntimeError("the browser has ended")
        *messages, self.rest = (self.rest + piece).split(b"\0")
        for message in map(json.loads, messages):
            if "id" in message:
                self.answers[message["id"]] = message
            else:
                self.events.append((message["method"], message.get("params", {})))

    def ask(self, method, **parameters):
        """One command and its answer."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.write_end, json.dumps(message).encode() + b"\0")
        while self.number not in self.answers:
            self.read()
        answer = self.answers.pop(self.number)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def open(self, url, width, height=900, **media):
        """Loads a page in a window of that size; media: prefers-color-scheme and the like, with underscores."""
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1,
                 mobile=width < 600)
        features = [{"name": name.replace("_", "-"), "value": value} for name, value in media.items()]
        self.ask("Emulation.setEmulatedMedia", features=features)
        self.events.clear()
        self.ask("Page.navigate", url=url)
        while not any(method == "Page.loadEventFired" for method, _ in self.events):
            self.read()

    def run(self, script):
        """Value of an expression of JavaScript."""
        answer = self.ask("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{script}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def wait(self, seconds):
        """Lets the page go on."""
        self.run(f"new Promise(done => setTimeout(done, {1000 * seconds}))")

    def faults(self):
        """Errors and warnings of the page, and what it asked the network for."""
        for method, told in list(self.events):
            if method == "Runtime.exceptionThrown":
                yield f"exception {told['exceptionDetails'].get('exception', told['exceptionDetails'])}"
            elif method == "Runtime.consoleAPICalled" and told["type"] in ("error", "warning", "assert"):
                yield f"console {told['type']} {told['args']}"
            elif method == "Log.entryAdded" and told["entry"]["level"] in ("error", "warning"):
                yield f"log {told['entry']['text']}"
            elif method == "Network.requestWillBeSent" and not told["request"]["url"].startswith(("file:", "data:", "blob:")):
                yield f"request {told['request']['url']}"

    def picture(self, path, full=True):
        """A PNG of the page."""
        answer = self.ask("Page.captureScreenshot", format="png", captureBeyondViewport=full)
        path.write_bytes(base64.b64decode(answer["data"]))

    def pdf(self, path):
        """As it is printed."""
        path.write_bytes(base64.b64decode(self.ask("Page.printToPDF", printBackground=True)["data"]))

    def close(self):
        """Ends the browser."""
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        for end in (self.read_end, self.write_end):
            os.close(end)
        self.profile.cleanup()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
