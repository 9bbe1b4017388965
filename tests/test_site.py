#!/usr/bin/env python3
"""The site that scripts/site builds: every page of the repository is in it, every link and picture of every page leads somewhere,
nothing is asked of the network. Breaks when a page links to what is gone, or a folder that is no site would be replaced.

    test_site.py             links
    test_site.py browser     in Chromium, 1280 and 400 points wide, no page is wider than its window, and search finds a word

Exit status 77, skipped, without python3-sphinx, python3-myst-parser and furo; `browser` also without a Chromium."""

import html.parser
import importlib.util
import subprocess
import sys
import tempfile
import urllib.parse
from pathlib import Path

from browser import Browser, find_browser

SOURCE = Path(__file__).resolve().parents[1]
SITE = SOURCE / "scripts/site"
WIDER = "document.scrollingElement.scrollWidth - innerWidth"
FOUND = "[...document.querySelectorAll('#search-results li a')].map(e => e.getAttribute('href'))"


class Links(html.parser.HTMLParser):
    """What a page refers to, and the names of its places."""

    def __init__(self, path):
        super().__init__()
        self.to, self.names = [], set()
        self.feed(path.read_text())

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.names |= {attrs[key] for key in ("id", "name") if attrs.get(key)}
        self.to += [attrs[key] for key in ("href", "src") if attrs.get(key)]


def link_faults(site):
    """Links that lead nowhere, or to the network when the page is loaded."""
    pages = {path: Links(path) for path in site.rglob("*.html")}
    for path, page in pages.items():
        for link in page.to:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme in ("http", "https", "mailto", "data"):
                continue
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if not target.exists():
                yield f"{path.relative_to(site)}: {link} leads nowhere"
            elif parts.fragment and target in pages and parts.fragment not in pages[target].names | {"", "top"}:
                yield f"{path.relative_to(site)}: {link} leads to no place of that page"


def browser_faults(site, program):
    """What Chromium sees."""
    browser = Browser(program)
    for path in sorted(site.rglob("*.html")):
        for width in (1280, 400):
            browser.open(path.as_uri(), width)
            if browser.run(WIDER) > 1:
                yield f"{path.relative_to(site)}: wider than a window of {width}"
            asked = [event["request"]["url"] for method, event in browser.events if method == "Network.requestWillBeSent"]
            yield from (f"{path.relative_to(site)}: asks for {url}" for url in asked if url.startswith("http"))
    browser.open((site / "search.html").as_uri() + "?q=pressure", 1280)
    for _ in range(100):
        found = browser.run(FOUND)
        if any("static" in link for link in found):
            break
        browser.wait(0.1)
    if not any("static" in link for link in found):
        yield f"search for pressure finds {found}"


def refusal_faults(folder):
    """A folder with something else in it stays as it is."""
    (folder / "mine").mkdir()
    (folder / "mine/kept.txt").write_text("kept")
    done = subprocess.run([SITE, "-o", folder / "mine"], capture_output=True, text=True, check=False)
    if done.returncode == 0 or len(done.stderr.splitlines()) != 1 or not (folder / "mine/kept.txt").exists():
        yield f"a folder that is no site: {done.stderr}"


def main():
    program = find_browser() if "browser" in sys.argv else None
    if not all(importlib.util.find_spec(name) for name in ("sphinx", "myst_parser", "furo")) or ("browser" in sys.argv and not program):
        print("needs python3-sphinx, python3-myst-parser and furo; in a browser Chromium")
        return 77
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        done = subprocess.run([SITE, "-o", folder / "site"], capture_output=True, text=True, check=False)
        if done.returncode:
            print(done.stderr)
            return 1
        faults = list(browser_faults(folder / "site", program)) if program else [*link_faults(folder / "site"), *refusal_faults(folder)]
        pages = len(list((folder / "site").rglob("*.html")))
        if pages < 50:
            faults.append(f"only {pages} pages")
    print("\n".join(faults) or f"{pages} pages, {'with' if program else 'without'} a browser")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
