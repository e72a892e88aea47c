"""The page of studies in a real browser against a real daemon."""
import json
import subprocess

import requests
from conftest import SPEC
from selenium.webdriver.common.keys import Keys
from test_page import HOSTILE, find, find_all, jobs_shown, scrolls_sideways, until, use_phone


def click(browser, selector):
    """What the page may draw anew at any moment."""
    until(browser, lambda b: find(b, selector).click() or True)


def submit(daemon, **study):
    answer = requests.post(f"{daemon.url}/studies", json={"base": {"inputs": SPEC}} | study)
    assert answer.status_code == 201, answer.text
    return answer.json()["studyID"]


def test_an_empty_list_shows_a_line_that_submits_the_first_study(fake, browser):
    browser.get(f"{fake.url}/web/studies.html")
    line = until(browser, lambda b: find(b, "#empty pre").text).replace("\\\n", " ")
    made = json.loads(subprocess.run(line.replace("curl", "curl -sS", 1), shell=True, capture_output=True, check=True).stdout)
    assert made["jobs"] == 6
    until(browser, lambda b: find(b, f"#study-{made['studyID']} .badge").text == "successful", 60)  # it came without a reload


def test_a_study_is_followed_to_its_table(fake, browser):
    cases = [{"name": "smooth", "inputs": {"contact": {"friction": 0.1}}, "label": {"angle": 20, "paper": "23"}},
             {"name": "broken", "inputs": {"contact": {"friction": 0.4}}, "label": {"fake": "fault"}}]
    browser.get(fake.url)
    study = submit(fake, name="followed", cases=cases, repeats=3)
    find(browser, ".places a[href$='studies.html']").click()
    click(browser, f"#study-{study} a")
    until(browser, lambda b: find(b, "#head .badge").text == "failed")
    until(browser, lambda b: find_all(b, "#cases tbody tr")[0].text.count("3 of 3"))
    headings = [cell.text for cell in find_all(browser, "#cases thead th")]
    assert headings[:2] == ["case", "contact/friction"] and {"paper", "runs", "regime", "angle of repose"} <= set(headings)
    angle = fake.get(f"/studies/{study}/results").json()["cases"][0]["results"]["angle_deg"]
    smooth, broken = [dict(zip(headings, [cell.text for cell in find_all(row, "th, td")])) for row in find_all(browser, "#cases tbody tr")]
    decimals = 2 if angle["standard_error"] < 1 else 1  # two digits of the error
    assert smooth["angle of repose"] == f"{angle['mean']:.{decimals}f} ± {angle['standard_error']:.{decimals}f}°"
    assert (smooth["case"], smooth["contact/friction"], smooth["paper"], smooth["regime"]) == ("smooth", "0.1", "23", "rolling")
    assert broken["angle of repose"] == "–" and "3 failed" in broken["runs"]
    links = [link.get_attribute("href") for link in find_all(browser, "#links a")]
    assert len(links) == 4 and all(requests.get(link).status_code == 200 for link in links)
    browser.refresh()  # the study is part of the address
    until(browser, lambda b: find(b, "#head h1").text == "followed")
    find(browser, "#links a[href^='/?study=']").click()
    jobs = until(browser, jobs_shown)
    assert len(jobs) == 6 and study in find(browser, "#of-study").text
    other = fake.submit()
    browser.refresh()
    assert other not in until(browser, jobs_shown)
    find(browser, "#of-study a[href='/']").click()
    until(browser, lambda b: other in jobs_shown(b))


def test_a_study_can_be_cancelled(fake, browser):
    study = submit(fake, name="long", base={"inputs": SPEC, "label": {"fake": "slow", "seconds": "60"}}, repeats=4)
    browser.get(f"{fake.url}/web/studies.html#{study}")
    click(browser, "#head .stop")
    assert find(browser, "#confirm").is_displayed() and find(browser, "#confirm-what").text == "long"
    find(browser, "#confirm button[value=keep]").click()
    until(browser, lambda b: not find(b, "#confirm").is_displayed())
    assert fake.get(f"/studies/{study}").json()["counts"]["dismissed"] == 0
    click(browser, "#head .stop")
    find(browser, "#confirm button[value=cancel]").click()
    until(browser, lambda b: find(b, "#head .badge").text == "dismissed")
    assert fake.get(f"/studies/{study}").json()["counts"]["dismissed"] == 4
    assert find_all(browser, "#head .stop") == []


def test_what_users_wrote_stays_text_and_a_phone_does_not_scroll_sideways(fake, browser):
    cases = [{"name": HOSTILE, "inputs": {"contact": {"friction": 0.1}, "wall": {"friction": 0.3}}, "label": {HOSTILE[:60]: HOSTILE}}]
    study = submit(fake, name=HOSTILE, cases=cases, repeats=2)
    use_phone(browser)
    browser.get(f"{fake.url}/web/studies.html")
    assert until(browser, lambda b: find(b, "#rows a")).text == HOSTILE
    assert not scrolls_sideways(browser)
    browser.get(f"{fake.url}/web/studies.html#{study}")
    assert until(browser, lambda b: find(b, "#cases tbody th")).text == HOSTILE
    assert find(browser, "#head h1").text == HOSTILE and "owned" != browser.title
    assert not scrolls_sideways(browser)


def test_a_calibration_is_followed_to_its_answer(fake, browser):
    request = {"name": HOSTILE, "base": {"process": "drum", "inputs": SPEC}, "seed": 3, "stop": {"jobs": 14}, "label": {"fit": "steep"},
               "parameters": {"/inputs/contact/friction": {"range": [0.05, 1.0]}},
               "targets": [{"name": "angle", "result": "/repose/angle_deg", "value": 29.0, "standard_error": 0.5}]}
    posted = requests.post(f"{fake.url}/calibrations", json=request)
    assert posted.status_code == 201, posted.text
    calibration = posted.json()["calibrationID"]
    browser.get(f"{fake.url}/web/studies.html")
    click(browser, ".places a[href$='calibrations.html']")
    assert until(browser, lambda b: find(b, f"#calibration-{calibration} a")).text == HOSTILE
    click(browser, f"#calibration-{calibration} a")
    until(browser, lambda b: "identified" in find(b, ".verdict strong").text, 60)
    found = fake.get(f"/calibrations/{calibration}/results").json()
    parts = {find(part, "h2").text: part for part in find_all(browser, ".calibration-part")}
    assert [cell.text for cell in find_all(parts["Parameters"], "tbody th")] == ["contact/friction"]
    best = found["answer"]["best"]["parameters"]["/inputs/contact/friction"]
    assert f"{best:.4g}" in find(parts["Parameters"], "tbody tr").text
    measured = find(parts["Measured and predicted"], "tbody tr").text
    assert "29 ± 0.5" in measured and "°" in measured and len(find_all(parts["Measured and predicted"], "svg .fitted")) == 1
    columns = find_all(parts["What fits"], "svg .column")
    assert len(columns) > 3 and len(find_all(parts["What fits"], "svg .region68")) == 1
    rows = find_all(parts["Runs"], "tbody tr")
    assert len(rows) == len(found["runs"]) and find(rows[-1], "a").get_attribute("href").endswith(found["runs"][0]["job"])
    assert "LAMMPS" in parts["The likeliest set for other programs"].text.upper() and browser.title != "owned"
    use_phone(browser)
    assert not scrolls_sideways(browser)


def test_the_token_is_asked_for_here_too(daemon_with_token, browser):
    browser.get(f"{daemon_with_token.url}/web/studies.html")
    field = until(browser, lambda b: find(b, "#token").is_displayed() and find(b, "#token-value"))
    field.send_keys("a-token-of-this-test", Keys.ENTER)
    until(browser, lambda b: "No studies yet" in find(b, "#empty").text)
