#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The report in a real browser, from a file and without a network: what it shows, sorts and switches.

    tests/report_test.py build/release
"""

import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

CLICKS = """
<script>
addEventListener('load', () => {
  const seen = {errors: []};
  addEventListener('error', event => seen.errors.push(event.message));
  const table = [...document.querySelectorAll('table')].find(t => t.getAttribute('aria-label').startsWith('Errors and costs'));
  const heads = [...table.querySelectorAll('thead th')];
  const column = heads.findIndex(head => head.textContent.trim() === 'rmse');
  const values = () => [...table.querySelectorAll('tbody tr')].map(row => parseFloat(row.children[column].textContent));
  heads[column].querySelector('button').click();
  seen.first = values();
  heads[column].querySelector('button').click();
  seen.second = values();
  seen.themes = [document.documentElement.dataset.theme];
  [...document.querySelectorAll('button')].find(b => /^(Dark|Light)$/.test(b.textContent)).click();
  seen.themes.push(document.documentElement.dataset.theme);
  seen.flip = [...document.querySelectorAll('button')].filter(b => b.textContent === 'Flip').map(b => {
    b.click();
    return b.getAttribute('aria-pressed');
  });
  seen.alts = [...document.images].every(image => image.alt || image.closest('[aria-hidden]') || image.closest('[role]') ||
                                                  image.parentElement.querySelector('[aria-label]'));
  seen.pictures = [...new Set([...document.images].map(image => image.getAttribute('src')).filter(Boolean))];
  document.body.setAttribute('data-seen', JSON.stringify(seen));
});
</script>
"""


class Seen(html.parser.HTMLParser):
    """Picks up what the clicks left on the body."""

    found = None

    def handle_starttag(self, tag, attrs):
        if tag == "body":
            self.found = json.loads(dict(attrs).get("data-seen", "null"))


def check(holds, sentence):
    if not holds:
        sys.exit(f"report: {sentence}")


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    browser = shutil.which("chromium")
    check(browser, "chromium is not installed; tools/install_packages brings it")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as scratch:  # a browser may still write while it ends
        folder = pathlib.Path(scratch) / "report"
        subprocess.run([str(build / "gnomon"), "compare", "contact", "-r", "hard", "-r", "pcf", "-r", "volumes", "--size", "96x64",
                        "--samples", "4", "--repeat", "1", "-o", str(folder)], check=True, capture_output=True)
        page = (folder / "index.html").read_text(encoding="utf-8")
        check(not re.search(r"""(src|href)=["']?https?:""", page), "the page asks for something from a network")

        driven = folder / "driven.html"
        driven.write_text(page.replace("</body>", CLICKS + "</body>"), encoding="utf-8")
        done = subprocess.run(
            [browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run",
             "--disable-component-update", "--disable-sync", f"--user-data-dir={scratch}/profile", "--virtual-time-budget=5000",
             "--dump-dom", driven.as_uri()], capture_output=True, text=True, timeout=120, check=False,
            env={**os.environ, "HOME": scratch})
        parser = Seen()
        parser.feed(done.stdout)
        seen = parser.found
        check(seen, f"the page's script did not run to its end: {done.stderr[-800:]}")
        check(seen["errors"] == [], f"the page's script failed: {seen['errors']}")
        check(len(seen["first"]) == 3, f"three recipes were compared, the table has {len(seen['first'])} rows")
        check(seen["first"] == sorted(seen["first"]), f"a click on 'rmse' does not sort upwards: {seen['first']}")
        check(seen["second"] == sorted(seen["second"], reverse=True), f"a second click does not sort downwards: {seen['second']}")
        check(sorted(seen["themes"]) == ["dark", "light"], f"the button does not switch the theme: {seen['themes']}")
        check(seen["flip"] == ["true"], f"the comparison does not flip: {seen['flip']}")
        check(seen["alts"], "a picture has no text for those who cannot see it")
        for picture in seen["pictures"]:
            check(picture.startswith("data:") or (folder / picture).is_file(), f"the picture {picture} is not there")
        check(len(seen["pictures"]) >= 4, "fewer pictures than the reference and three recipes")
    print("the report opens, sorts, flips and switches its theme")


if __name__ == "__main__":
    main()
