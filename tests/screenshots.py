#!/usr/bin/env python3
"""The pictures of README: the page in headless Chromium, as it shows real runs. Usage: screenshots.py OUT_FOLDER"""
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "service"))
import requests  # noqa: E402
from PIL import Image  # noqa: E402
from conftest import BROWSER_FLAGS, Daemon  # noqa: E402
from selenium import webdriver  # noqa: E402
from selenium.webdriver.chrome.service import Service  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402
from selenium.webdriver.support.ui import WebDriverWait  # noqa: E402

DRUM = {"drum": {"diameter": 0.1, "length": 0.012, "rotation_rate": 2.0}, "particles": [{"diameter": 0.003}],
        "contact": {"friction": 0.3, "maximum_overlap": 0.05}, "duration": {"revolutions": 1.5}, "snapshots": {"interval": 0.2}}
SMALL = DRUM | {"drum": {"diameter": 0.06, "length": 0.012, "rotation_rate": 2.0}, "duration": {"revolutions": 1.0}, "snapshots": {"interval": 0}}
SIZE = (1200, 800)


def ended(daemon, path):
    while requests.get(f"{daemon.url}{path}?wait=30", timeout=60).json()["status"] in ("accepted", "running"):
        pass


def shoot(browser, address, sign, file):
    """Once what this selector names is there, and has been drawn."""
    browser.get(address)
    WebDriverWait(browser, 60).until(lambda b: b.find_elements(By.CSS_SELECTOR, sign))
    time.sleep(3)
    browser.save_screenshot(str(file))
    Image.open(file).convert("RGB").quantize(128).save(file, optimize=True)
    print(file)


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for flag in [*BROWSER_FLAGS, f"--user-data-dir={scratch}/profile", f"--window-size={SIZE[0]},{SIZE[1] + 140}"]:
            options.add_argument(flag)
        daemon = Daemon(Path(scratch))
        daemon.measures = False
        daemon.start()
        browser = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
        try:
            study = requests.post(f"{daemon.url}/studies", timeout=60, json={
                "name": "friction and rate", "base": {"process": "drum", "inputs": SMALL},
                "vary": {"/inputs/contact/friction": [0.1, 0.3, 0.6], "/inputs/drum/rotation_rate": [1.0, 2.0, 4.0]}}).json()["studyID"]
            job = daemon.submit(DRUM, project="glass beads")
            ended(daemon, f"/studies/{study}")
            ended(daemon, f"/jobs/{job}")
            shoot(browser, daemon.url, "tr.job .thumb img", folder / "list.png")
            shoot(browser, f"{daemon.url}/web/job.html?id={job}", "#results tbody tr", folder / "job.png")
            shoot(browser, f"{daemon.url}/web/new.html?example=granudrum", "#estimate dd", folder / "form.png")
            shoot(browser, f"{daemon.url}/web/studies.html#{study}", ".study-figure .case", folder / "study.png")
        finally:
            browser.quit()
            daemon.stop()


main(Path(sys.argv[1]))
