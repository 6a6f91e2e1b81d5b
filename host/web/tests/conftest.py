"""The page in Chromium, and the program that it is compared with."""

import os
import shlex
import subprocess
from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright

ROOT = Path(__file__).resolve().parents[3]
MADE = ROOT / "target/web-page"
PAGE = (MADE / "brdfit.html").as_uri()
EXAMPLE = ROOT / "host/web/page/example.csv"
# A machine with other work on it is slow; none of this is a test of time.
PATIENCE = 120_000


class Page:
    """The page as a person drives it."""

    def __init__(self, page):
        self.page = page
        self.requests = []
        self.faults = []
        page.set_default_timeout(PATIENCE)
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("pageerror", lambda error: self.faults.append(str(error)))
        page.on("dialog", lambda dialog: self.faults.append(dialog.message))
        page.goto(PAGE)
        page.wait_for_selector("html[data-ready=yes]")

    def settle(self):
        """Waits until the last thing that was asked for is done."""
        self.page.evaluate("async () => { let last; do { last = settled; await last; } while (last !== settled); }")

    def give(self, *paths):
        """Chooses files, in place of those before."""
        self.page.evaluate("for (const name of given()) bridge.drop(name)")
        self.page.set_input_files("#files", [str(path) for path in paths])
        self.settle()

    def click(self, name):
        self.page.get_by_role("button", name=name, exact=True).click()
        self.settle()

    def set(self, option, value):
        field = self.page.locator(f"#option-{option}")
        self.page.evaluate("id => { const inside = document.getElementById(id).closest('details'); if (inside) inside.open = true; }", f"option-{option}")
        if field.evaluate("element => element.tagName") == "SELECT":
            field.select_option(value)
        elif field.get_attribute("type") == "checkbox":
            field.set_checked(value)
        else:
            field.fill(value)
            field.blur()
        self.settle()

    def text(self, selector):
        return self.page.text_content(selector)

    def error(self):
        return self.text("#error")

    def download(self, name):
        """The bytes that a button saves."""
        with self.page.expect_download() as waits:
            self.page.get_by_role("button", name=name, exact=True).click()
        return Path(waits.value.path()).read_bytes()


@pytest.fixture(scope="session")
def chromium():
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=os.environ.get("CHROMIUM", "/usr/bin/chromium"), args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture
def page(chromium):
    context = chromium.new_context(viewport={"width": 1366, "height": 768})
    opened = Page(context.new_page())
    yield opened
    assert opened.faults == []
    context.close()


def program(*words, folder):
    """What the program writes to standard output, or its line of failure."""
    done = subprocess.run([os.environ["BRDFIT"], *words], cwd=folder, capture_output=True)
    return done.stdout if done.returncode == 0 else done.stderr.decode()


def line(text, folder):
    """The same of a line for a shell."""
    words = shlex.split(text)
    assert words[0] == "brdfit"
    return program(*words[1:], folder=folder)


def wait_until(page, condition):
    """Asks again and again; what waits in the page itself would need eval, which the page forbids."""
    for _ in range(1200):
        if page.evaluate(condition):
            return
        page.wait_for_timeout(50)
    raise AssertionError(f"not within a minute: {condition}")
