#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Both studies in a real browser, each by a scripted participant: what it asks, refuses, keeps, and shows to the administrator.

    tests/study_test.py build/release
"""

import json
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
        self.number, self.errors, self.session = 0, [], None
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
            if answer.get("method") == "Runtime.exceptionThrown":
                self.errors.append(answer["params"]["exceptionDetails"].get("exception", {}).get("description", "unknown"))
            if answer.get("id") == self.number:
                check("error" not in answer, f"{method}: {answer.get('error')}")
                return answer["result"]

    def receive(self):
        bytes_ = bytearray()
        while (one := self.reader.read(1)) != b"\0":
            check(one, "the browser ended")
            bytes_ += one
        return json.loads(bytes_)

    def go(self, address):
        self.call("Page.navigate", url=address)

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
LOADED = "return [...document.images].every(image => image.complete && image.naturalWidth > 0)"


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
            browser.call("Page.reload")
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


def main():
    gnomon = pathlib.Path(sys.argv[1]).resolve() / "gnomon"
    program = shutil.which("chromium")
    check(program, "chromium is not installed; tools/install_packages brings it")
    with tempfile.TemporaryDirectory() as name:
        scratch = pathlib.Path(name)
        shots = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else scratch
        (scratch / "two.toml").write_text(SWEEP)
        quiet = {"check": True, "capture_output": True}
        subprocess.run([gnomon, "study", "prepare", scratch / "survey", "--sweep", scratch / "two.toml"], **quiet)
        subprocess.run([gnomon, "study", "prepare", scratch / "threshold", "--kind", "threshold"], **quiet)
        browser = Browser(program, scratch)
        try:
            take_survey(browser, gnomon, scratch / "survey", shots)
            take_threshold(browser, gnomon, scratch / "threshold", shots)
            check(browser.errors == [], f"a script failed: {browser.errors}")
        finally:
            browser.close()
    print("both studies are taken, refuse what is missing, and show the administrator how they go")


if __name__ == "__main__":
    main()
