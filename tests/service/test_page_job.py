"""The page of one job in a real browser: bed and curve on one clock, and everything that is known of the job."""
import hashlib
import json
import math
import re
import subprocess

import pytest
from conftest import ROOT, SPEC
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select
from accessibility import violations
from test_page import HOSTILE, find, find_all, scrolls_sideways, until, use_phone
from test_page_paper import printed_pages

TWO_KINDS = SPEC | {"particles": [{"diameter": 0.004, "share": 0.5}, {"diameter": 0.003, "share": 0.5}], "snapshots": {"interval": 0.05}}
PIXELS = """const canvas = document.querySelector(arguments[0]);
if (!canvas) return [0, 0];
const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
const colors = new Set(); let sum = 0;
for (let k = 0; k < data.length; k += 4 * 7) { colors.add(data[k] << 16 | data[k + 1] << 8 | data[k + 2]); sum = (31 * sum + data[k] + 3 * data[k + 1] + 7 * data[k + 2]) % 1e9; }
return [colors.size, sum];"""


def pixels(browser, canvas=".bed"):
    """[number of colours, a number that any change of the picture changes]"""
    return browser.execute_script(PIXELS, canvas)


def drawn(browser, canvas=".bed", other_than=None):
    """The same, once the picture is no empty sheet, and not this one."""
    return until(browser, lambda b: (lambda now: now if now[0] > 200 and now != other_than else None)(pixels(b, canvas)), 60)


def leaves(value, path=()):
    if isinstance(value, dict):
        return [leaf for name, member in value.items() for leaf in leaves(member, (*path, name))]
    return [(path, value)]


@pytest.fixture
def finished(daemon):
    job = daemon.submit(TWO_KINDS, project=HOSTILE, note="it's \u202eone")
    daemon.ended(job)
    return job


def check_the_clock(daemon, browser, job, before):
    """The slider moves from frame to frame, and the bed and the address with it."""
    times = [snapshot["time"] for snapshot in daemon.get(f"/jobs/{job}/snapshots").json()["snapshots"]]
    slider = find(browser, ".transport .time")
    assert float(slider.get_attribute("max")) == pytest.approx(times[-1], abs=0.02)
    for _ in range(3):
        slider.send_keys(Keys.ARROW_LEFT)
    shown = float(slider.get_attribute("value"))
    assert shown in [pytest.approx(times[-3], abs=1e-6), pytest.approx(times[-4], abs=1e-6)]
    drawn(browser, other_than=before)
    until(browser, lambda b: re.search(r"[#&]t=([\d.]+)", b.current_url) and float(re.search(r"[#&]t=([\d.]+)", b.current_url)[1]) == pytest.approx(shown, rel=1e-3))
    find(browser, ".transport .play").click()
    until(browser, lambda b: float(slider.get_attribute("value")) > shown)


def check_results_and_inputs(daemon, browser, job):
    """All of them are there, under their names, with what differs from the default marked."""
    results, spec = daemon.get(f"/jobs/{job}/results").json(), daemon.get(f"/jobs/{job}/spec").json()
    named = {row.get_attribute("title") for row in find_all(browser, "#results tbody tr")}
    wanted = {".".join(path) for path, value in leaves(results) if isinstance(value, (int, float, str)) and "standard_error" not in path[-1]
              and "other_methods_standard_error_deg" not in path}
    assert wanted and wanted <= named
    marked = {row.get_attribute("title") for row in find_all(browser, "#inputs tr:has(.set)")}
    assert {"fill_fraction", "contact.maximum_overlap", "snapshots.interval"} <= marked
    assert not marked & {"contact.restitution", "contact.friction", "wall.friction", "gravity", "threads", "drum.ends"}
    assert {".".join(path) for path, _ in leaves({k: v for k, v in spec["inputs"].items() if k != "particles"})} <= {
        row.get_attribute("title") for row in find_all(browser, "#inputs tbody tr")}
    repose = results["repose"]
    assert f"{repose['angle_deg']:.1f}"[:3] in find(browser, "#answer-row strong").text


def test_the_page_of_a_job_shows_bed_curve_and_all_that_is_known(daemon, browser, finished):
    job = finished
    browser.get(f"{daemon.url}/jobs/{job}?f=html")
    first = drawn(browser)
    assert browser.current_url.startswith(f"{daemon.url}/web/job.html?id={job}")
    assert HOSTILE in find(browser, "h1").text and browser.title.startswith(HOSTILE) and find_all(browser, "h1 img, h1 b") == []
    until(browser, lambda b: pixels(b, ".curve canvas")[0] > 3)
    curve = find(browser, "#curve").get_attribute("aria-label")
    count = len(daemon.get(f"/jobs/{job}/samples").json()["samples"])
    assert f"{count} samples" in curve

    colored = Select(find(browser, ".color-by"))
    assert {"speed", "species", "size", "spin", "contacts"} <= {option.text for option in colored.options}
    colored.select_by_value("species")
    second = drawn(browser, other_than=first)
    until(browser, lambda b: len(find_all(b, ".legend .swatch")) == 2 and "colour=species" in b.current_url)
    browser.execute_script("const c = document.querySelector('.cut'); c.value = 0.4; c.dispatchEvent(new Event('input'))")
    third = drawn(browser, other_than=second)
    find(browser, ".bed").send_keys(Keys.ARROW_RIGHT, Keys.ARROW_DOWN)
    fourth = drawn(browser, other_than=third)
    check_the_clock(daemon, browser, job, fourth)

    before = pixels(browser, ".curve canvas")
    find(browser, ".definitions input[value=chord_deg]").click()
    until(browser, lambda b: pixels(b, ".curve canvas") != before)
    check_results_and_inputs(daemon, browser, job)
    find(browser, ".fields summary").click()
    until(browser, lambda b: pixels(b, ".heat canvas")[0] > 3)
    command = find(browser, ".curl code").text
    again = json.loads(subprocess.run(command.replace("curl", "curl -sS", 1), shell=True, capture_output=True, check=True).stdout)["jobID"]
    assert daemon.get(f"/jobs/{again}/spec").json() == daemon.get(f"/jobs/{job}/spec").json()
    assert find(browser, ".job-actions a").get_attribute("href") == f"{daemon.url}/web/new.html?from={job}"
    assert violations(browser) == []
    use_phone(browser)
    until(browser, lambda b: not scrolls_sideways(b))
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    assert 2 <= printed_pages(browser) <= 5
    daemon.ended(again)
    check_beds_beside_each_other(daemon, browser, job, again)


def check_beds_beside_each_other(daemon, browser, job, again):
    """Two runs of one spec: two beds that are alike and move together, and no input that differs."""
    browser.get(f"{daemon.url}/web/compare.html?ids={job},{again}")
    beds = [f".beds section:nth-child({k}) .bed" for k in (1, 2)]
    before = [drawn(browser, bed) for bed in beds]
    assert "the same inputs" in until(browser, lambda b: find(b, "#inputs").text)
    for _ in range(3):
        find(browser, ".transport .time").send_keys(Keys.ARROW_LEFT)
    until(browser, lambda b: (lambda now: now[0] == now[1] and now[0] not in before)([pixels(b, bed) for bed in beds]))
    until(browser, lambda b: pixels(b, ".curve canvas")[0] > 3)
    assert violations(browser) == []


def test_comparing_tells_what_differs_and_by_how_many_standard_errors(fake, browser):
    jobs = [fake.submit(SPEC | {"contact": {"friction": friction, "maximum_overlap": 0.05}, "seed": seed}, angle=20, project="alike")
            for friction, seed in ((0.2, 5), (0.4, 12))]
    angles = [fake.get(f"/jobs/{job}/results").json()["repose"]["angle_deg"] for job in jobs if fake.ended(job)["status"] == "successful"]
    away = (angles[1] - angles[0]) / math.hypot(0.3, 0.3)  # each has this error
    browser.get(f"{fake.url}/web/compare.html?ids={','.join(jobs)}")
    rows = until(browser, lambda b: find_all(b, "#inputs tbody tr"))
    assert {row.find_element(By.TAG_NAME, "th").text: [cell.text for cell in row.find_elements(By.TAG_NAME, "td")] for row in rows} == {
        "contact.friction": ["0.2", "0.4"], "seed": ["5", "12"]}
    cell = until(browser, lambda b: find(b, "#results tr[title='repose.angle_deg'] td:last-child")).text
    assert cell.startswith(f"{angles[1]:.2f}") and float(re.search(r"[+−]([\d.]+) standard errors", cell)[1]) == pytest.approx(abs(away), rel=0.1)
    heads = [head.text for head in find_all(browser, "#results thead th")]
    assert all(job[-8:] in head for job, head in zip(jobs, heads[1:], strict=True))  # of one name, told apart
    assert len(find_all(browser, ".beds .bed")) == 2
    browser.get(f"{fake.url}/web/compare.html?ids={jobs[0]}")
    assert "2 to 6" in until(browser, lambda b: find(b, "#trouble").text)


def test_the_library_for_curves_is_what_was_checked_in():
    """Its files have the sums that stand beside them, with its licence among them."""
    folder = ROOT / "web/vendor"
    sums = dict(reversed(line.split()) for line in (folder / "SHA256SUMS").read_text().splitlines())
    assert set(sums) == {file.name for file in folder.iterdir()} - {"SHA256SUMS"} and "uPlot.LICENSE" in sums
    assert all(hashlib.sha256((folder / name).read_bytes()).hexdigest() == told for name, told in sums.items())
