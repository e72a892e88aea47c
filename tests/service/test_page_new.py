"""The form of a new test in a real browser against a real daemon."""
import json
import math
import shlex
import subprocess

import requests
from selenium.webdriver.support.ui import Select
from test_page import HOSTILE, find, find_all, scrolls_sideways, until


def type_into(browser, pointer, text):
    field = until(browser, lambda b: find(b, f"[id='input{pointer.replace('/', '-')}']"))
    field.clear()
    field.send_keys(text)
    return field


def sent(browser):
    return json.loads(find(browser, "#json").get_attribute("textContent"))


def test_a_test_is_made_by_hand_and_a_study_of_several_values(fake, browser):
    browser.get(f"{fake.url}/web/new.html?process=drum")
    usual = until(browser, lambda b: [label.text for label in find_all(b, "#usual label")])
    assert usual == ["drum, diameter", "drum, length", "drum, rotation rate", "particles, diameter", "fill fraction", "contact, friction"]
    for pointer, text in (("/drum/diameter", "126"), ("/drum/length", "18.9"), ("/drum/rotation_rate", "15"),
                          ("/particles/0/diameter", "3.78"), ("/fill_fraction", "35"), ("/contact/friction", "0.1")):
        type_into(browser, pointer, text)
    inputs = sent(browser)["inputs"]
    assert (inputs["drum"]["diameter"], inputs["particles"][0]["diameter"], inputs["fill_fraction"]) == (0.126, 0.00378, 0.35)
    assert abs(inputs["drum"]["rotation_rate"] - math.pi / 2) < 1e-12
    assert find(browser, "#input-drum-diameter ~ output").text == "0.126 m"
    Select(find(browser, "#input-drum-diameter ~ select")).select_by_value("cm")
    assert find(browser, "#input-drum-diameter").get_attribute("value") == "12.6" and sent(browser)["inputs"] == inputs
    assert find(browser, "#outline svg").is_displayed()
    # the curl that is shown makes the very job that the button makes
    line = find(browser, "#curl").text.replace("\\\n", " ").replace("curl", "curl -sS", 1)
    by_curl = json.loads(subprocess.run(shlex.split(line), capture_output=True, check=True).stdout)["jobID"]
    find(browser, "#label input").send_keys(HOSTILE[:60])
    until(browser, lambda b: find(b, "#submit").is_enabled() and (find(b, "#submit").click() or True))
    until(browser, lambda b: "new.html" not in b.current_url)
    by_hand = requests.get(f"{fake.url}/jobs?limit=1").json()["jobs"][0]
    assert by_hand["label"] == {"project": HOSTILE[:60]} and by_hand["jobID"] != by_curl
    specs = [requests.get(f"{fake.url}/jobs/{job}/spec").json()["inputs"] for job in (by_curl, by_hand["jobID"])]
    assert [spec | {"seed": 0} for spec in specs][0] == specs[1] | {"seed": 0}
    # from that job again, with three values and two repeats
    browser.get(f"{fake.url}/web/new.html?from={by_hand['jobID']}")
    until(browser, lambda b: find(b, "#input-contact-friction").get_attribute("value") == "0.1")
    type_into(browser, "/contact/friction", "0.1 to 0.5 in 3")
    repeats = find(browser, "#repeats")
    repeats.clear()
    repeats.send_keys("2")
    until(browser, lambda b: find(b, "#submit").text == "Submit 6 tests")
    assert sent(browser)["vary"] == {"/inputs/contact/friction": [0.1, 0.3, 0.5]}
    until(browser, lambda b: find(b, "#submit").is_enabled() and (find(b, "#submit").click() or True))
    until(browser, lambda b: "studies.html" in b.current_url)
    study = browser.current_url.partition("#")[2]
    assert requests.get(f"{fake.url}/studies/{study}").json()["jobs"] == 6


def test_every_example_fills_the_form_and_is_sent_as_it_is(fake, browser):
    for name in ("granudrum", "table1"):
        given = requests.get(f"{fake.url}/examples/{name}").json()
        browser.get(f"{fake.url}/web/new.html?example={name}")
        until(browser, lambda b: find(b, "#json").get_attribute("textContent"))
        test, wanted = (document.get("base", document) for document in (sent(browser), given))
        assert test["inputs"] == wanted["inputs"]
        assert sent(browser).get("cases") == given.get("cases") and sent(browser).get("repeats") == given.get("repeats")
    # warnings and problems, lists within a list, are elements and not the words for such
    made = """const done = arguments[0]; import('/web/dom.js').then(({ h, replaceIfChanged }) => { const box = h('div');
              replaceIfChanged(box, 1, () => [h('p'), [h('p'), [h('p')]]]); done(box.childElementCount + box.textContent); })"""
    assert browser.execute_async_script(made) == "3"
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 320, "height": 640, "deviceScaleFactor": 2, "mobile": True})
    browser.get(f"{fake.url}/web/new.html?example=orifice")
    until(browser, lambda b: find_all(b, "#usual .field"))
    assert not scrolls_sideways(browser)
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
