"""The page in a real browser against a real daemon: what a user sees and clicks."""
import contextlib
import json
import math
import re
import sqlite3
import subprocess

import pytest
import requests
from selenium.common.exceptions import ElementNotInteractableException, NoSuchElementException, StaleElementReferenceException
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait
from test_heap_and_fill import SPECS

HOSTILE = '<img src=x onerror="document.title=\'owned\'"><b>bold</b>'


def until(browser, seen, seconds=20):
    """Wait for seen(browser) to be truthy; elements that a poll has just replaced count as not yet seen."""
    ignored = [NoSuchElementException, StaleElementReferenceException]
    return WebDriverWait(browser, seconds, 0.1, ignored).until(seen)


def find(browser, selector):
    return browser.find_element(By.CSS_SELECTOR, selector)


def find_all(browser, selector):
    return browser.find_elements(By.CSS_SELECTOR, selector)


def row_of(browser, job):
    return until(browser, lambda b: find(b, f"#job-{job}"))


def use_phone(browser):
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                            {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True})


def jobs_shown(browser):
    return [row.get_attribute("id").removeprefix("job-") for row in find_all(browser, "tr.job")]


def scrolls_sideways(browser):
    return browser.execute_script("return document.documentElement.scrollWidth > window.innerWidth")


def test_an_empty_list_shows_two_lines_that_submit_the_first_job(fake, browser):
    browser.get(fake.url)
    shown = until(browser, lambda b: find(b, "#empty pre").text)
    lines = shown.replace("\\\n", " ").splitlines()
    assert len(lines) == 2 and all(line.startswith("curl ") and fake.url in line for line in lines)
    answer = [json.loads(subprocess.run(line.replace("curl", "curl -sS", 1), shell=True, capture_output=True, check=True).stdout)
              for line in lines]
    assert [job["jobID"] for job in answer[1]["jobs"]] == [answer[0]["jobID"]]
    assert row_of(browser, answer[0]["jobID"]).is_displayed()  # it came without a reload


def test_a_job_is_followed_to_its_angle(daemon, browser):
    browser.get(daemon.url)
    job = daemon.submit(project="followed")
    row = row_of(browser, job)
    until(browser, lambda b: find(row, ".badge").text == "successful", 60)
    results = daemon.get(f"/jobs/{job}/results").json()
    repose = results["repose"]
    decimals = min(3, max(0, 1 - math.floor(math.log10(repose["standard_error_deg"]))))  # two digits of the error
    assert find(row, ".angle .value").text.startswith(f"{repose['angle_deg']:.{decimals}f} ± ")
    regime = results["regime"]
    assert find(row, "td.regime").text == regime["name"] + ("" if regime["certain"] else ", not certain")
    inputs = find(row, "td.inputs").text
    assert all(words in inputs for words in ("μ 0.3", "6 rad/s", "drum Ø 40 mm", "× 4 mm", "30 % full"))

    opener = find(row, ".opener")
    assert opener.text == "followed" and opener.get_attribute("aria-expanded") == "false"
    opener.send_keys(Keys.ENTER)
    until(browser, lambda b: find(b, f"#detail-{job} .plot .line"))
    assert opener.get_attribute("aria-expanded") == "true"
    methods = {cell.text.splitlines()[0] for cell in find_all(browser, ".methods tbody th")}
    assert methods == {repose["method"], *repose["other_methods"]}
    links = [link.get_attribute("href") for link in find_all(browser, ".links a")]
    assert len(links) == 7 and all(requests.get(link).status_code == 200 for link in links)
    fields, = (link for link in links if link.endswith("/fields.hdf"))
    assert requests.get(fields).content[:4] == b"\x89HDF"
    find(browser, ".snapshots summary").click()
    snapshot = until(browser, lambda b: find(b, ".snapshots li a"))
    assert requests.get(snapshot.get_attribute("href")).content[:4] == b"\x89HDF"
    browser.refresh()  # the opened row is part of the view in the URL
    until(browser, lambda b: find(b, f"#detail-{job} .answer strong").is_displayed())


@pytest.mark.parametrize("process, words", [("heap", ("tube Ø 20 mm", "50 mm/s", "plate Ø 36 mm", "μ 0.5")),
                                            ("fill", ("cylinder Ø 30 mm", "0.9 m/s", "800 a second", "μ 0.3"))])
def test_heaps_and_fills_show_their_angles(daemon, browser, process, words):
    answer = requests.post(f"{daemon.url}/processes/{process}/execution", timeout=30, json={"inputs": SPECS[process]})
    job = answer.json()["jobID"]
    assert daemon.ended(job)["status"] == "successful"
    browser.get(daemon.url)
    row = row_of(browser, job)
    results = daemon.get(f"/jobs/{job}/results").json()
    repose = results["repose"]
    # shown with the digits that its error leaves
    assert float(re.match(r"[\d.]+", find(row, ".angle .value").text)[0]) == pytest.approx(repose["angle_deg"], abs=0.5)
    inputs = find(row, "td.inputs").text
    assert all(word in inputs for word in words) and "drum" not in inputs
    find(row, ".opener").click()
    shown = until(browser, lambda b: find(b, f"#detail-{job} .answer").text)
    assert "16 azimuths" in shown and "at rest" in shown and {"heap": "lost", "fill": "while the stream ran"}[process] in shown
    until(browser, lambda b: find(b, f"#detail-{job} .plot .line"))
    methods = {cell.text.splitlines()[0] for cell in find_all(browser, ".methods tbody th")}
    assert methods == {repose["method"], *repose["other_methods"]}


def test_a_heap_too_small_for_an_angle_says_so(daemon, browser):
    inputs = SPECS["heap"] | {"tube": {"diameter": 0.015, "lift_speed": 0.05}, "particle_count": 100}
    job = requests.post(f"{daemon.url}/processes/heap/execution", timeout=30, json={"inputs": inputs}).json()["jobID"]
    assert daemon.ended(job)["status"] == "successful"
    assert daemon.get(f"/jobs/{job}/results").json()["repose"]["angle_deg"] is None
    browser.get(daemon.url)
    find(row_of(browser, job), ".opener").click()
    assert "too few particles" in until(browser, lambda b: find(b, f"#detail-{job} .answer").text)
    assert "None of its samples has an angle" in until(browser, lambda b: find(b, f"#detail-{job} .plot-box").text)


def test_a_granule_shows_its_least_rate(daemon, browser):
    answer = requests.post(f"{daemon.url}/processes/granule/execution", timeout=30,
                           json={"inputs": {"friction": 0.5, "rotation_rate": 18.0}, "label": {"project": "one particle"}})
    job = answer.json()["jobID"]
    daemon.ended(job)
    browser.get(daemon.url)
    row = row_of(browser, job)
    least = daemon.get(f"/jobs/{job}/results").json()["granule"]["minimum_rotation_rate"]
    assert find(row, ".angle .value").text.startswith(f"≥ {least:.2f} rad/s")
    assert find(row, "td.regime").text == "sliding"
    inputs = find(row, "td.inputs").text
    assert all(words in inputs for words in ("μ 0.5", "18 rad/s", "R 63 mm")) and "drum" not in inputs
    find(row, ".opener").click()
    shown = until(browser, lambda b: find(b, f"#detail-{job} .answer").text)
    assert f"≥ {least:.2f} rad/s" in shown and "sliding" in shown
    equations = [cell.text.splitlines()[0] for cell in find_all(browser, ".methods tbody th")]
    assert equations == ["this test", "Eq 33", "Eq 34", "Eqns 36–37"]
    rounds = daemon.get(f"/jobs/{job}/results").json()["regime"]["evidence"]["revolutions"]
    assert f"revolutions followed\n{rounds}\n" in find(browser, f"#detail-{job} .results").text
    links = [link.get_attribute("href") for link in find_all(browser, ".links a")]
    assert len(links) == 4 and all(requests.get(link).status_code == 200 for link in links)  # no samples, no snapshots
    assert find_all(browser, f"#detail-{job} .plot") == [] and find_all(browser, f"#detail-{job} .snapshots") == []
    assert not scrolls_sideways(browser)


def test_progress_and_time_left_move_while_a_job_runs(fake, browser):
    job = fake.submit(project="moving", seconds=30)
    browser.get(fake.url)
    first = until(browser, lambda b: float(find(b, f"#job-{job} progress").get_attribute("value")))
    assert re.fullmatch(r"\d+ % · \S+ s left", find(browser, f"#job-{job} .left").text)
    until(browser, lambda b: float(find(b, f"#job-{job} progress").get_attribute("value")) > first)


def test_why_a_job_failed_is_seen_at_once(fake, browser):
    job = fake.submit(fake="numerical")
    fake.ended(job)
    browser.get(f"{fake.url}/?status=failed")
    row = row_of(browser, job)
    assert "overlap of 0.7 radii" in find(row, ".why").text
    find(row, ".opener").click()
    assert "at step 12 between particles 3 and 4" in until(browser, lambda b: find(b, f"#detail-{job} .reason p").text)


def test_what_users_write_is_shown_as_text(fake, browser):
    job = fake.submit(note=HOSTILE, **{"<i>key</i>": "x"})
    browser.get(f"{fake.url}/?open={job}")
    assert HOSTILE in row_of(browser, job).text
    until(browser, lambda b: "<i>key</i>" in find(b, f"#detail-{job}").text)
    own = "[src*='/picture.png']"  # pictures of beds, which the page itself shows
    assert find_all(browser, f"tbody img:not({own})") == [] and find_all(browser, "tbody b, tbody i") == []
    assert "owned" not in browser.title


def test_filters_are_kept_in_the_url(fake, browser):
    kept, gone = (fake.submit(project=name, seconds=60) for name in ("kept", "gone"))
    requests.delete(f"{fake.url}/jobs/{gone}")
    browser.get(fake.url)
    until(browser, lambda b: jobs_shown(b) == [kept, gone])  # what runs stands first
    find(browser, ".filter.dismissed").click()
    until(browser, lambda b: jobs_shown(b) == [gone])
    assert browser.current_url == f"{fake.url}/?status=dismissed"
    browser.refresh()
    until(browser, lambda b: jobs_shown(b) == [gone])
    assert find(browser, ".filter.dismissed").get_attribute("aria-current") == "true"
    browser.back()
    until(browser, lambda b: jobs_shown(b) == [kept, gone])
    find(browser, "#q").send_keys("kept")
    until(browser, lambda b: jobs_shown(b) == [kept])
    assert browser.current_url == f"{fake.url}/?q=kept"
    find(browser, "#q").send_keys(" not at all")
    until(browser, lambda b: "No such jobs" in find(b, "#empty").text)


def test_a_job_is_cancelled_only_after_a_yes(fake, browser):
    job = fake.submit(project="long", seconds=60)
    browser.get(fake.url)
    row = row_of(browser, job)
    until(browser, lambda b: find(row, ".badge").text == "running")
    find(row, ".stop").click()
    find(browser, "dialog button[value=keep]").click()
    assert fake.job(job)["status"] == "running"
    find(row, ".stop").click()
    assert find(browser, "#confirm-what").text.startswith("long")
    find(browser, "dialog button[value=cancel]").click()
    until(browser, lambda b: find(row, ".badge").text == "dismissed")
    assert fake.job(job)["status"] == "dismissed"
    assert find_all(browser, ".stop") == []


def test_a_daemon_out_of_reach_is_said_and_its_return_is_noticed(fake, browser):
    job = fake.submit(seconds=60)
    browser.get(fake.url)
    row_of(browser, job)
    fake.stop()
    until(browser, lambda b: "out of reach" in find(b, "#trouble").text)
    assert row_of(browser, job).is_displayed()  # what was there stays
    assert find(browser, "#connection").text == "not live"
    fake.start()
    with contextlib.suppress(NoSuchElementException, StaleElementReferenceException, ElementNotInteractableException):
        find(browser, "#trouble button").click()  # unless the page has noticed by itself
    until(browser, lambda b: find(b, "#connection").text == "live")
    assert not find(browser, "#trouble").is_displayed()


def multiply_the_only_job(database, copies):
    """Straight into the database of a daemon that is not running: over HTTP it would take minutes."""
    with contextlib.closing(sqlite3.connect(database)) as connection, connection:
        changed = {"number": "number + n", "label": "json_object('project', 'copy ' || n)",
                   "id": "printf('20200101-%06d-00000000', n)"}
        for table, own in (("job", "number"), ("drum_input", "job")):
            columns = [row[1] for row in connection.execute(f"PRAGMA table_info({table})")]
            values = [f"{own} + n" if column == own else changed.get(column, column) for column in columns]
            connection.execute(f"WITH RECURSIVE c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c WHERE n < {copies}) "
                               f"INSERT INTO {table} SELECT {', '.join(values)} FROM {table}, c")


def test_ten_thousand_jobs_are_shown_a_page_at_a_time(fake, browser):
    jobs = [fake.ended(fake.submit())["jobID"]]
    fake.stop()
    multiply_the_only_job(fake.data / "reposed.sqlite", 10_000)
    fake.start()
    browser.get(fake.url)
    until(browser, lambda b: find(b, ".filter.all .count").text == "10,001")
    assert jobs_shown(browser) == [f"20200101-{n:06}-00000000" for n in range(10_000, 9_950, -1)]
    ids = [f"20200101-{n:06}-00000000" for n in range(10_000, 0, -1)] + [jobs[0]]

    def turn(to, first, count):
        until(browser, lambda b: [button for button in find_all(b, "#pages button") if to in button.text][0].click() or True)
        until(browser, lambda b: jobs_shown(b) == ids[first:first + count])
        assert find(browser, ".range").text == f"{first + 1:,}–{first + count:,} of 10,001"

    turn("Next", 50, 50)
    turn("Next", 100, 50)
    browser.refresh()  # a shared address knows the way back
    until(browser, lambda b: jobs_shown(b) == ids[100:150])
    turn("Previous", 50, 50)
    turn("Newest", 0, 50)
    [button for button in find_all(browser, "#pages button") if "Oldest" in button.text][0].click()
    until(browser, lambda b: "sort=created" in b.current_url and "cursor" not in b.current_url)
    find(browser, "#q").send_keys("copy 7777")
    until(browser, lambda b: jobs_shown(b) == ["20200101-007777-00000000"])


def test_a_phone_shows_cards_that_fit(daemon, browser):
    job = daemon.submit(project="a rather long name of a project, " * 3)
    assert daemon.ended(job)["status"] == "successful"
    use_phone(browser)
    browser.get(f"{daemon.url}/?open={job}")
    until(browser, lambda b: find(b, f"#detail-{job} .plot"))
    assert not scrolls_sideways(browser)
    assert not find(browser, "#jobs thead").is_displayed()
    left = {find(row_of(browser, job), cell).rect["x"] for cell in ("td.pick", "td.state", "td.inputs", "td.times")}
    assert len(left) == 1  # under each other
    find(browser, ".snapshots summary").click()
    until(browser, lambda b: find(b, ".snapshots li a"))
    assert not scrolls_sideways(browser)


def test_a_daemon_with_a_token_asks_for_it(daemon_with_token, browser):
    browser.get(daemon_with_token.url)
    field = until(browser, lambda b: find(b, "#token").is_displayed() and find(b, "#token-value"))
    field.send_keys("wrong", Keys.ENTER)
    until(browser, lambda b: find(b, "#token").is_displayed())
    field.clear()
    field.send_keys("a-token-of-this-test", Keys.ENTER)
    until(browser, lambda b: "No jobs yet" in find(b, "#empty").text)
    assert not find(browser, "#token").is_displayed()
