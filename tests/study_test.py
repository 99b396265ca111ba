#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Both studies in a real browser, each by a scripted participant: what it asks, refuses, keeps, and shows to the administrator.

    tests/study_test.py build/release
"""

import csv
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import urllib.request

SWEEP = """
title = "Two pages"
samples = 1
size = "64x48"
[[grid]]
scene = "{scene}"
recipe = "{technique}"
[[grid.axis]]
name = "scene"
values = ["contact", "half-plane"]
[[grid.axis]]
name = "technique"
values = ["none", "hard"]
"""


def check(holds, sentence):
    if not holds:
        sys.exit(f"study: {sentence}")


class Browser:
    """Chromium without a window, spoken to through its debugging pipe."""

    def __init__(self, program, scratch):
        ours_in, theirs_out = os.pipe()
        theirs_in, ours_out = os.pipe()

        def wire():
            # By way of others, which are neither 3 nor 4.
            first, second = os.dup(theirs_in), os.dup(theirs_out)
            os.dup2(first, 3)
            os.dup2(second, 4)

        self.process = subprocess.Popen(
            [program, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
             "--disable-component-update", "--disable-sync", f"--user-data-dir={scratch}/profile", "--remote-debugging-pipe",
             "--window-size=1400,1000"], close_fds=False, preexec_fn=wire, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env={**os.environ, "HOME": str(scratch)})
        os.close(theirs_in)
        os.close(theirs_out)
        self.reader, self.writer = os.fdopen(ours_in, "rb"), os.fdopen(ours_out, "wb")
        self.number, self.errors, self.session, self.loads = 0, [], None, 0
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.call("Runtime.enable")
        self.call("Page.enable")

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        self.writer.write(json.dumps(message).encode() + b"\0")
        self.writer.flush()
        while True:
            answer = self.receive()
            if answer.get("id") == self.number:
                check("error" not in answer, f"{method}: {answer.get('error')}")
                return answer["result"]

    def receive(self):
        bytes_ = bytearray()
        while (one := self.reader.read(1)) != b"\0":
            check(one, "the browser ended")
            bytes_ += one
        answer = json.loads(bytes_)
        if answer.get("method") == "Runtime.exceptionThrown":
            self.errors.append(answer["params"]["exceptionDetails"].get("exception", {}).get("description", "unknown"))
        self.loads += answer.get("method") == "Page.loadEventFired"
        return answer

    def load(self, method, **parameters):
        """Until the new page stands there: what is asked of the old one meanwhile is answered by it, and a click on it is lost."""
        before = self.loads
        self.call(method, **parameters)
        while self.loads == before:
            self.receive()

    def go(self, address):
        self.load("Page.navigate", url=address)

    def reload(self):
        self.load("Page.reload")

    def run(self, script):
        result = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        check("exceptionDetails" not in result, f"{script}: {result.get('exceptionDetails')}")
        return result["result"].get("value")

    def wait(self, script, what, seconds=30):
        end = time.monotonic() + seconds
        while not (value := self.run(f"(() => {{ {script} }})()")):
            check(time.monotonic() < end, f"{what} did not come: {self.run('document.body.innerText.slice(0, 400)')}")
            time.sleep(0.02)
        return value

    def picture(self, path):
        import base64
        path.write_bytes(base64.b64decode(self.call("Page.captureScreenshot")["data"]))

    def close(self):
        """In order, so that none of its processes still writes into the profile while that is removed."""
        self.session = None
        try:
            self.call("Browser.close")
            self.process.wait(timeout=20)
        except (SystemExit, OSError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()


class Server:
    def __init__(self, gnomon, folder):
        self.process = subprocess.Popen([str(gnomon), "study", "serve", str(folder), "--port", "0"], stdout=subprocess.PIPE, text=True)
        self.participants = self.process.stdout.readline().split()[-1]
        self.administrator = self.process.stdout.readline().split()[-1]

    def state_of_all(self):
        address = self.administrator.replace("/admin?", "/api/admin?")
        return json.loads(urllib.request.urlopen(address, timeout=10).read())

    def end(self, number=signal.SIGTERM):
        self.process.send_signal(number)
        self.process.wait(timeout=20)


HEAD = "return document.querySelector('h1')?.textContent"
LOADED = "return document.images.length > 0 && [...document.images].every(image => image.complete && image.naturalWidth > 0)"

# One who looks at pixels alone: whether the edge bends anywhere. Where the brightness is halfway is found in every column (or row,
# where the edge stands upright), smoothed over five; it is no line where the slope over five pixels is 0.2 off its mean. Answers until
# the study ends, and gives how many times.
OBSERVER = """
(async () => {
  const canvas = document.createElement('canvas'), pen = canvas.getContext('2d', {willReadFrequently: true});
  function contour(value, n) {
    let low = 255, high = 0;
    for (let i = 0; i < n; ++i) for (let k = 0; k < n; ++k) { low = Math.min(low, value(i, k)); high = Math.max(high, value(i, k)); }
    const half = 0.5 * (low + high), places = [];
    for (let i = 0; i < n; ++i) for (let k = 1; k < n; ++k) {
      const a = value(i, k - 1) - half, b = value(i, k) - half;
      if (a * b <= 0 && a !== b) { places.push(k - 1 + a / (a - b)); break; }
    }
    return places;
  }
  function isLine(image) {
    const n = canvas.width = canvas.height = image.naturalWidth;
    pen.drawImage(image, 0, 0);
    const data = pen.getImageData(0, 0, n, n).data;
    const down = contour((x, y) => data[4 * (y * n + x)], n), across = contour((y, x) => data[4 * (y * n + x)], n);
    const places = down.length >= across.length ? down : across;
    const smooth = places.slice(4).map((unused, i) => (places[i] + places[i + 1] + places[i + 2] + places[i + 3] + places[i + 4]) / 5);
    const mean = (smooth[smooth.length - 1] - smooth[0]) / (smooth.length - 1);
    return smooth.slice(5).every((place, i) => Math.abs((place - smooth[i]) / 5 - mean) < 0.2);
  }
  const pause = () => new Promise(resolve => setTimeout(resolve, 2));
  const ended = () => document.querySelector('h1')?.textContent === 'Thank you';
  for (let trials = 0, last = null, end = Date.now() + 90000; ; ++trials) {
    while (!ended() && (!document.querySelector('img') || document.querySelector('img') === last)) {
      if (Date.now() > end) return -trials;
      await pause();
    }
    if (ended()) return trials;
    last = document.querySelector('img');
    await last.decode();
    document.querySelector(isLine(last) ? '#yes' : '#no').click();
  }
})()
"""


def take_survey(browser, gnomon, folder, shots):
    server = Server(gnomon, folder)
    browser.go(server.participants)
    browser.wait(HEAD + " === 'How realistic are these shadows?'", "the welcome")
    browser.run("document.querySelector('button.go').click()")
    for page in range(2):
        browser.wait(HEAD + f" === 'Scene {page + 1} of 2'", f"page {page + 1}")
        browser.wait(LOADED, "its pictures")
        check(browser.run("document.querySelectorAll('.pictures figure').length") == 3, "a page has not three pictures")
        text = browser.run("document.body.innerText")
        check("9 = the most realistic" in text and "1 = the least realistic" in text, "the direction of the ranks is not said")
        check(not re.search(r"none|hard[^ ]|reference", browser.run("document.querySelector('.pictures').outerHTML")), "a technique's name can be read")
        # Nothing is sent before all is answered.
        browser.run("document.querySelector('button.go').click()")
        browser.wait("return document.querySelector('.wrong').textContent.includes('Every picture needs a rank')", "the demand for ranks")
        browser.run("document.querySelectorAll('.pictures figure').forEach((figure, i) => "
                    "[...figure.querySelectorAll('button')].find(b => b.textContent === String([9, 4, 4][i])).click())")
        browser.run("document.querySelector('button.go').click()")
        browser.wait("return document.querySelector('.wrong').textContent.includes('how hard')", "the demand for difficulty")
        # A picture grows when it is clicked.
        browser.run("document.querySelector('.pictures img').click()")
        browser.wait("return document.querySelector('dialog').open", "the zoom")
        browser.run("document.querySelector('dialog').click()")
        browser.run("document.querySelectorAll('input[name=difficulty]')[3].click()")
        if page == 0:
            browser.picture(shots / "survey.png")
        browser.run("document.querySelector('button.go').click()")
        browser.wait(HEAD + ".startsWith('Which one')", "the question for the best")
        browser.run("document.querySelectorAll('.choose img')[1].click()")
        browser.wait("return document.querySelector('.wrong').textContent.includes('9 is the most realistic')", "the objection")
        if page == 0:
            # A page that is loaded again, by a server that was killed, goes on; what was not sent is asked again.
            browser.run("document.querySelectorAll('.choose img')[0].click()")
            browser.wait(HEAD + " === 'Scene 2 of 2'", "the second page")
        else:
            browser.run("document.querySelectorAll('.choose img')[0].click()")
    browser.wait(HEAD + " === 'Thank you'", "the end")
    state = server.state_of_all()
    check(state["people"][0]["done"], "the survey is not done")
    browser.go(server.administrator)
    browser.wait("return document.querySelectorAll('svg').length >= 2", "the administrator's charts")
    browser.picture(shots / "survey-admin.png")
    server.end()


def take_threshold(browser, gnomon, folder, shots):
    server = Server(gnomon, folder)
    browser.go(server.participants)
    browser.wait(HEAD + " === 'Your screen'", "the adjustment")
    browser.picture(shots / "screen.png")
    browser.run("document.querySelector('#gamma').value = 2; document.querySelector('#gamma').dispatchEvent(new Event('input'))")
    browser.run("document.querySelector('button.go').click()")
    for position in range(12):
        browser.wait(HEAD + " === 'Is the original image a line?'", "the question")
        browser.wait(LOADED, "the stimulus")
        before = browser.run("document.querySelector('img').src")
        check(f"position={position}&" in before, f"trial {position} shows {before}")
        if position == 0:
            # A pixel of the picture is one of the screen.
            size = browser.run("document.querySelector('img').getBoundingClientRect().width * devicePixelRatio / document.querySelector('img').naturalWidth")
            check(size == 1, f"a pixel of the stimulus is {size} pixels of the screen")
            browser.picture(shots / "trial.png")
        if position == 6:
            # The page is loaded again: the same trial stands there.
            browser.reload()
            browser.wait(HEAD + " === 'Is the original image a line?'", "the question after a reload")
            browser.wait(LOADED, "the stimulus after a reload")
            check(browser.run("document.querySelector('img').src") == before, "a reload changed the trial")
        browser.run(f"document.querySelector('{'#yes' if position % 2 else '#no'}').click()")
        browser.wait(f"return document.querySelector('img')?.src !== '{before}'", "the next trial")
    check(server.state_of_all()["people"][0]["answers"] == 12, "twelve answers were given")
    browser.go(server.administrator)
    browser.wait("return document.querySelectorAll('svg').length >= 1", "the administrator's charts")
    browser.picture(shots / "threshold-admin.png")
    server.end()


def take_threshold_to_the_end(browser, gnomon, folder):
    """Every round, by an observer whose thresholds are sharp: the quests must find where they lie."""
    server = Server(gnomon, folder)
    browser.go(server.participants)
    browser.wait(HEAD + " === 'Your screen'", "the adjustment")
    browser.run("document.querySelector('button.go').click()")
    browser.wait(LOADED, "the first trial")
    trials = browser.run(OBSERVER)
    check(trials > 0, f"the study did not end within {-trials} trials")
    person = server.state_of_all()["people"][0]
    server.end()
    check(person["done"] and person["answers"] == trials, f"{trials} answers were given, and the administrator sees {person}")

    # What is exported is what was answered.
    subprocess.run([gnomon, "study", "export", folder, "-o", folder / "answers.csv"], check=True, capture_output=True)
    with open(folder / "answers.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    check([int(row["position"]) for row in rows] == list(range(trials)), f"{trials} answers were given and {len(rows)} exported")
    check(all((row["right"] == "true") == (row["line"] == row["said_line"]) for row in rows), "a right answer is exported as a wrong one")
    lines = sum(row["line"] == "true" for row in rows)
    check(0.3 * trials < lines < 0.7 * trials, f"{lines} of {trials} trials are lines")
    for round_ in person["rounds"]:
        quest = round_["quests"][0]
        name = f"{round_['pattern']} at contrast {round_['contrast']}"
        mine = [row for row in rows if row["pattern"] == round_["pattern"] and float(row["contrast"]) == round_["contrast"]]
        check(quest["converged"] and 10 <= len(mine) < 80 and len(quest["radii"]) == len(mine), f"{name}: {len(mine)} trials, {quest}")
        # Steps are seen under smaller filters than those that hide them, to some hundredths, for a picture that is turned has other
        # eight-bit steps; and the quest's threshold lies between both.
        seen = [float(row["radius"]) for row in mine if row["line"] == "false" and row["said_line"] == "false"]
        hidden = [float(row["radius"]) for row in mine if row["line"] == "false" and row["said_line"] == "true"]
        check(seen and hidden and max(seen) < 1.1 * min(hidden), f"{name}: steps were seen under {sorted(seen)} and not under {sorted(hidden)}")
        sharp = math.sqrt(max(seen) * min(hidden))
        # Sharp to three deviations at which a quest ends, 0.045 decades each.
        check(abs(math.log10(quest["radius"] / sharp)) < 0.135, f"{name}: the quest found {quest['radius']}, between {max(seen)} and {min(hidden)}")


def main():
    gnomon = pathlib.Path(sys.argv[1]).resolve() / "gnomon"
    program = shutil.which("chromium")
    check(program, "chromium is not installed; tools/install_packages brings it")
    # What a browser that was killed leaves behind is no failure of a study.
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        scratch = pathlib.Path(name)
        shots = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else scratch
        (scratch / "two.toml").write_text(SWEEP)
        quiet = {"check": True, "capture_output": True}
        subprocess.run([gnomon, "study", "prepare", scratch / "survey", "--sweep", scratch / "two.toml"], **quiet)
        subprocess.run([gnomon, "study", "prepare", scratch / "threshold", "--kind", "threshold"], **quiet)
        subprocess.run([gnomon, "study", "prepare", scratch / "whole", "--kind", "threshold"], **quiet)
        # One size of artifact and one contrast, in small pictures: two rounds of a quest each.
        plan = json.loads((scratch / "whole/study.json").read_text())
        (scratch / "whole/study.json").write_text(json.dumps({**plan, "artifacts": [8.0], "contrasts": [0.5], "picture_size": 200}))
        browser = Browser(program, scratch)
        try:
            take_survey(browser, gnomon, scratch / "survey", shots)
            take_threshold(browser, gnomon, scratch / "threshold", shots)
            take_threshold_to_the_end(browser, gnomon, scratch / "whole")
            check(browser.errors == [], f"a script failed: {browser.errors}")
        finally:
            browser.close()
    print("both studies are taken, refuse what is missing, and show the administrator how they go")


if __name__ == "__main__":
    main()
