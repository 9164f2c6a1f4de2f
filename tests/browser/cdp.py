"""A small driver for Chromium over the DevTools protocol, since Playwright slows pages with WebSockets."""

import asyncio
import base64
import contextlib
import json
import os
import shutil
import tempfile
import threading
from collections.abc import Coroutine
from pathlib import Path
from typing import Any, TypeVar

import aiohttp
import pytest
from filelock import FileLock

from daidalos.studio.build import build, is_fresh
from places import MACHINE_TEMPORARY

T = TypeVar("T")

FLAGS = (
    "--headless=new",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-background-timer-throttling",
    "--disable-renderer-backgrounding",
    "--disable-component-update",
    "--disable-extensions",
    "--disable-quic",
    "--disable-sync",
    "--disable-gpu",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--mute-audio",
    "--remote-debugging-port=0",
    "--remote-allow-origins=*",
)
START_S = 60
ANSWER_S = 60
MAX_PAGES = 5
CTRL = 2  # among the modifiers of an event


def find_chromium() -> str | None:
    """The browser to drive: `DAIDALOS_CHROMIUM`, else what is on the path."""
    named = os.environ.get("DAIDALOS_CHROMIUM")
    candidates = [named] if named else ["chromium", "chromium-browser", "google-chrome", "chrome"]
    return next((found for name in candidates if (found := shutil.which(name))), None)


def require_chromium() -> None:
    """Skip the test where there is no browser, unless `DAIDALOS_REQUIRE_BROWSER` says that there must be one."""
    if find_chromium() is None:
        text = "no Chromium found; install it, or name it in DAIDALOS_CHROMIUM"
        if os.environ.get("DAIDALOS_REQUIRE_BROWSER"):
            pytest.fail(text)
        pytest.skip(text)


def require_page() -> None:
    """Build the page where it is not; skip the test where that cannot be done, unless it must be."""
    words: list[str] = []
    with FileLock(MACHINE_TEMPORARY / "daidalos-test-page.lock"):  # tests run in several processes
        built = is_fresh() or build(words.append)
    if not built:
        text = f"the page cannot be built: {words}"
        if os.environ.get("DAIDALOS_REQUIRE_BROWSER"):
            pytest.fail(text)
        pytest.skip(text)


class PageError(Exception):
    """The page threw, or did not become what was waited for."""


class PageLeft(PageError):
    """The page went elsewhere while it was asked."""


class Chromium:
    """One browser with one page; all methods may be called from an ordinary test.

    Parameters
    ----------
    width, height
        Size of the page in CSS pixels.
    """

    def __init__(self, width: int = 1440, height: int = 900) -> None:
        self.errors: list[str] = []
        self._size = (width, height)
        self._numbers = 0
        self._answers: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self._loaded = asyncio.Event()
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="cdp", daemon=True)
        self._thread.start()
        self._profile = tempfile.mkdtemp(prefix="chromium-")
        self._run(self._launch())

    def close(self) -> None:
        """End the browser and remove its profile."""
        self._run(self._shut())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()
        shutil.rmtree(self._profile, ignore_errors=True)

    def __enter__(self) -> "Chromium":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def open(self, url: str) -> None:
        """Go to an address and wait until the page is loaded."""
        self._run(self._load("Page.navigate", url=url))

    def forget(self, url: str) -> None:
        """Remove what pages of an address's origin have stored."""
        origin = "/".join(url.split("/")[:3])
        self._run(self._command("Storage.clearDataForOrigin", origin=origin, storageTypes="all"))

    def trust_all_certificates(self) -> None:
        """Open encrypted pages whoever has signed their certificates."""
        self._run(self._command("Security.setIgnoreCertificateErrors", ignore=True))

    def reload(self) -> None:
        """Load the page again, as the user's key does."""
        self._run(self._load("Page.reload"))

    def resize(self, width: int, height: int) -> None:
        """Set the page's size."""
        self._size = (width, height)
        self._run(self._set_size())

    def evaluate(self, expression: str) -> Any:
        """Value of a JavaScript expression, awaited where it is a promise."""
        answer = self._run(
            self._command("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        )
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise PageError(details.get("exception", {}).get("description") or details["text"])
        return answer["result"].get("value")

    def wait_for(self, condition: str, timeout: float = 60) -> Any:
        """Wait in the page until an expression, or what it promises, is true, and return its value."""
        limit = int(1000 * timeout)
        value = self._evaluate_across_pages(
            f"""new Promise((resolve) => {{
                const until = performance.now() + {limit};
                const look = async () => {{
                    let value;
                    try {{ value = await ({condition}); }} catch {{ value = undefined; }}
                    if (value || performance.now() > until) resolve(value ?? null);
                    else setTimeout(look, 30);
                }};
                look();
            }})"""
        )
        if not value:
            raise PageError(f"not true within {timeout} s: {condition}; errors: {self.errors}")
        return value

    def _evaluate_across_pages(self, expression: str) -> Any:
        """Evaluate, and again on the next page when the page goes elsewhere by itself."""
        for _ in range(MAX_PAGES):
            with contextlib.suppress(PageLeft):
                return self.evaluate(expression)
        return None

    def press(self, key: str, *, ctrl: bool = False) -> None:
        """Press and release a key."""
        more: dict[str, Any] = {"modifiers": CTRL if ctrl else 0}
        if key == "Enter":
            more |= {"code": key, "windowsVirtualKeyCode": 13, "text": "\r"}
        elif len(key) == 1 and not ctrl:
            more |= {"text": key}
        self._run(self._command("Input.dispatchKeyEvent", type="keyDown", key=key, **more))
        self._run(self._command("Input.dispatchKeyEvent", type="keyUp", key=key))

    def type(self, text: str) -> None:
        """Press the keys of a text, into what has the focus."""
        for key in text:
            self.press(key)

    def click(self, x: float, y: float, count: int = 1) -> None:
        """Press and release the left button at a place in the window."""
        self.drag([(x, y)], count=count)

    def click_on(self, selector: str, count: int = 1) -> None:
        """Click the middle of an element, once it is enabled, stands still and nothing lies over it."""
        place = self.wait_for(
            f"""(async () => {{
                const element = document.querySelector({selector!r});
                element.scrollIntoView({{ block: "nearest" }});
                const before = element.getBoundingClientRect();
                for (let frame = 0; frame < 2; frame++) await new Promise(requestAnimationFrame);
                const box = element.getBoundingClientRect();
                const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
                const stands = box.width && box.x === before.x && box.y === before.y;
                const hit = document.elementFromPoint(x, y);
                const isHit = hit && (element.contains(hit) || hit.contains(element));
                return stands && isHit && !element.matches(":disabled") && {{ x, y }};
            }})()"""
        )
        self.click(place["x"], place["y"], count)

    def double_click_on(self, selector: str) -> None:
        """Click the middle of an element twice."""
        self.click_on(selector)
        self.click_on(selector, count=2)

    def choose_file(self, selector: str, path: Path) -> None:
        """Choose a file in a field of files, as its dialog does."""
        self.wait_for(f"document.querySelector({selector!r}) !== null")
        root = self._run(self._command("DOM.getDocument"))["root"]["nodeId"]
        node = self._run(self._command("DOM.querySelector", nodeId=root, selector=selector))["nodeId"]
        self._run(self._command("DOM.setFileInputFiles", files=[str(path)], nodeId=node))

    def drag(
        self,
        points: list[tuple[float, float]],
        button: str = "left",
        *,
        ctrl: bool = False,
        key: str = "",
        count: int = 1,
    ) -> None:
        """Press at the first point, move through the others, press a key there if one is named, and release."""
        mouse: dict[str, Any] = {"button": button, "modifiers": CTRL if ctrl else 0}
        (x, y), *others = points
        self._mouse("mouseMoved", x, y)
        self._mouse("mousePressed", x, y, buttons=1, clickCount=count, **mouse)
        for x, y in others:
            self._mouse("mouseMoved", x, y, buttons=1, **mouse)
        if key:
            self.press(key)
        self._mouse("mouseReleased", x, y, clickCount=count, **mouse)

    def hover(self, x: float, y: float) -> None:
        """Move the mouse to a place in the window."""
        self._mouse("mouseMoved", x, y)

    def wheel(self, x: float, y: float, by: float) -> None:
        """Turn the wheel at a place in the window."""
        self._mouse("mouseWheel", x, y, deltaX=0, deltaY=by)

    def screenshot(self, path: Path | str) -> None:
        """Write a picture of the page as PNG."""
        answer = self._run(self._command("Page.captureScreenshot", format="png"))
        Path(path).write_bytes(base64.b64decode(answer["data"]))

    # Inside ------------------------------------------------------------------------------------------

    def _mouse(self, kind: str, x: float, y: float, **more: Any) -> None:
        self._run(self._command("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more))

    def _run(self, work: Coroutine[Any, Any, T]) -> T:
        return asyncio.run_coroutine_threadsafe(work, self._loop).result()

    async def _launch(self) -> None:
        browser = find_chromium()
        assert browser is not None, "no Chromium found"
        sandbox = ["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []
        self._process = await asyncio.create_subprocess_exec(
            browser,
            *FLAGS,
            *sandbox,
            f"--user-data-dir={self._profile}",
            "about:blank",
            stdout=asyncio.subprocess.DEVNULL,
            stderr=asyncio.subprocess.PIPE,
        )
        port = await asyncio.wait_for(self._debugging_port(), START_S)
        self._http = aiohttp.ClientSession()
        async with self._http.get(f"http://127.0.0.1:{port}/json/list") as response:
            pages = [entry for entry in await response.json() if entry["type"] == "page"]
        self._socket = await self._http.ws_connect(pages[0]["webSocketDebuggerUrl"], max_msg_size=0)
        self._reader = asyncio.create_task(self._read())
        for domain in ("Page", "Runtime", "Log"):
            await self._command(f"{domain}.enable")
        await self._set_size()

    async def _debugging_port(self) -> int:
        assert self._process.stderr is not None
        lines = []
        while line := (await self._process.stderr.readline()).decode(errors="replace"):
            lines.append(line)
            if "DevTools listening on" in line:
                self._drain = asyncio.create_task(self._process.stderr.read())
                return int(line.split("127.0.0.1:")[1].split("/")[0])
        raise PageError("Chromium did not start: " + "".join(lines[-5:]))

    async def _set_size(self) -> None:
        width, height = self._size
        await self._command(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )

    async def _command(self, method: str, **parameters: Any) -> dict[str, Any]:
        self._numbers += 1
        number = self._numbers
        self._answers[number] = asyncio.get_running_loop().create_future()
        await self._socket.send_json({"id": number, "method": method, "params": parameters})
        return await asyncio.wait_for(self._answers[number], ANSWER_S + 60)

    async def _load(self, method: str, **parameters: Any) -> None:
        self._loaded.clear()
        answer = await self._command(method, **parameters)
        if "errorText" in answer:
            raise PageError(answer["errorText"])
        await asyncio.wait_for(self._loaded.wait(), ANSWER_S)

    async def _read(self) -> None:
        async for message in self._socket:
            content = json.loads(message.data)
            if "id" in content:
                answer = self._answers.pop(content["id"])
                if "error" in content:
                    text = content["error"]["message"]
                    left = "navigated" in text or "context was destroyed" in text
                    answer.set_exception(PageLeft(text) if left else PageError(text))
                else:
                    answer.set_result(content["result"])
            else:
                self._note(content["method"], content["params"])

    def _note(self, method: str, parameters: dict[str, Any]) -> None:
        if method == "Page.loadEventFired":
            self._loaded.set()
        elif method == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description") or details["text"])
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
            self.errors.append(" ".join(str(each.get("value", each.get("description"))) for each in parameters["args"]))
        elif method == "Log.entryAdded" and parameters["entry"]["level"] == "error":
            entry = parameters["entry"]
            self.errors.append(f"{entry['text']} {entry.get('url', '')}")

    async def _shut(self) -> None:
        with contextlib.suppress(Exception):
            await asyncio.wait_for(self._command("Browser.close"), 5)
        self._reader.cancel()
        await self._http.close()
        try:
            await asyncio.wait_for(self._process.wait(), 5)
        except TimeoutError:
            self._process.kill()
            await self._process.wait()
        self._drain.cancel()
