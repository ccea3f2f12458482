"""Headless Chromium, driven by selenium: what a page looks like, and what hands can do to it."""

import io
import json
import os
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

BROWSER = next(filter(None, map(shutil.which, ("chromium", "google-chrome"))), None)
DRIVER = shutil.which("chromedriver")

needs_browser = pytest.mark.skipif(
    BROWSER is None or DRIVER is None,
    reason="no Chromium with its driver: on Debian, apt-get install chromium chromium-driver",
)

_ARGUMENTS = (
    "--headless=new", "--no-first-run", "--disable-background-networking", "--disable-sync",
    "--disable-component-update", "--disable-quic", "--window-size=1000,660",
    # WebGL in software: no graphics card is asked for.
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
)  # fmt: skip


@contextmanager
def open_browser(profile: Path) -> Iterator[Any]:
    """A browser with an empty profile in a folder; it asks nothing of the network by itself."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = BROWSER
    for argument in (*_ARGUMENTS, f"--user-data-dir={profile}"):
        options.add_argument(argument)
    if os.geteuid() == 0:
        options.add_argument("--no-sandbox")  # Chromium's own refuses root
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    browser = webdriver.Chrome(options=options, service=Service(DRIVER))
    try:
        yield browser
    finally:
        browser.quit()


def requested(browser: Any) -> set[str]:
    """Addresses that the page has asked for since the last call."""
    found = set()
    for entry in browser.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            found.add(message["params"]["request"]["url"])
        elif message["method"] == "Network.webSocketCreated":
            found.add(message["params"]["url"])
    return found


def picture(browser: Any) -> np.ndarray:
    """What the window shows, (height, width, 3), 0 to 255."""
    return np.asarray(Image.open(io.BytesIO(browser.get_screenshot_as_png())).convert("RGB"))


def wait_for(condition: Callable[[], Any], what: str, timeout: float = 90.0) -> Any:
    """The condition's first true value, or a failure that says what was waited for."""
    from selenium.common.exceptions import StaleElementReferenceException

    end = time.monotonic() + timeout
    while time.monotonic() < end:
        with suppress(StaleElementReferenceException):  # the page was just drawn anew
            value = condition()
            if isinstance(value, np.ndarray) or value:
                return value
        time.sleep(0.05)
    pytest.fail(f"waited {timeout:g} s in vain: {what}")
