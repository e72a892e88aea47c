"""Every place of the page for people who see, point or print otherwise: checked by axe-core, by keyboard alone, in forced colours, on
paper."""
import base64
import re
import shutil
import subprocess

import pytest
from accessibility import axe, violations
from conftest import SPEC
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys
from test_page import find, find_all, scrolls_sideways, until
from test_page_paper import A4
from test_page_studies import submit

PHONE = {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True}
AT = "return document.activeElement.matches(arguments[0])"


@pytest.fixture
def emulated(browser):
    """emulated(name=value, ...): features of media, as forced_colors="active"."""
    def emulate(**features):
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": name.replace("_", "-"), "value": value} for name, value in features.items()]})
    yield emulate
    emulate()
    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


@pytest.mark.torture
def test_no_place_keeps_anybody_from_using_it(fake, browser, emulated):
    """On a phone, in the dark: what is narrow or dim is found there first."""
    study = submit(fake, name="places", base={"inputs": SPEC, "label": {"angle": 20, "paper": "23"}}, vary={"/inputs/contact/friction": [0.1, 0.3]}, repeats=2)
    job = fake.submit()
    fake.ended(job)
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", PHONE)
    emulated(prefers_color_scheme="dark")
    places = {f"/?open={job}": f"#detail-{job} .plot .line", "/web/new.html?process=drum": "#problems .why", "/web/studies.html": "#rows tr",
              f"/web/studies.html#{study}": ".shared table", "/web/calibrations.html": "#empty :first-child"}
    for address, sign in places.items():
        browser.get("about:blank")
        browser.get(fake.url + address)
        until(browser, lambda b, sign=sign: find(b, sign).is_displayed())
        if address.startswith("/?"):
            find(browser, "#narrow summary").click()
            until(browser, lambda b: find(b, "td.pick input").click() or True)
            until(browser, lambda b: find(b, "#selection strong"))
        assert violations(browser) == [], address
        assert not scrolls_sideways(browser), address
        assert len(find_all(browser, "h1:not([hidden] *)")) == 1, address

    browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    emulated(forced_colors="active", prefers_contrast="more")
    browser.get(f"{fake.url}/?status=successful")
    until(browser, lambda b: find(b, "td.pick input").click() or True)
    until(browser, lambda b: find(b, "#selection strong"))
    borders = [link.value_of_css_property("border-top-color") for link in find_all(browser, ".filter")]
    current = find(browser, ".filter[aria-current]").value_of_css_property("border-top-color")
    assert borders.count(current) == 1
    chosen = [row.value_of_css_property("outline-style") for row in find_all(browser, "tr.job")]
    assert chosen.count("solid") == 1 and find(browser, "tr.job:has(.pick :checked)").value_of_css_property("outline-style") == "solid"
    if not axe():
        pytest.skip("npm can't fetch axe-core: the places were not checked by it")


def press(browser, *keys):
    ActionChains(browser).send_keys(*keys).perform()


def tab_to(browser, selector):
    """By the key Tab alone, from wherever the focus is."""
    until(browser, lambda b: find(b, selector))
    for _ in range(150):
        if browser.execute_script(AT, selector):
            return
        press(browser, Keys.TAB)
    raise AssertionError(f"no way to {selector}")


def test_all_can_be_done_by_keyboard(fake, browser):
    browser.get(fake.url)
    tab_to(browser, ".places a[href$='new.html']")
    press(browser, Keys.ENTER)
    for pointer, text in (("drum-diameter", "126"), ("drum-length", "18.9"), ("drum-rotation_rate", "15"), ("particles-0-diameter", "3.78")):
        tab_to(browser, f"#input-{pointer}")
        press(browser, text)
    until(browser, lambda b: find(b, "#submit").is_enabled())
    tab_to(browser, "#submit")
    press(browser, Keys.ENTER)
    until(browser, lambda b: "/web/job.html?id=" in b.current_url and find(b, ".badge").text == "successful")
    slider = until(browser, lambda b: (lambda bar: bar if float(bar.get_attribute("max")) > 1 else None)(find(b, ".transport .time")))
    tab_to(browser, ".transport .play")
    press(browser, Keys.SPACE)
    until(browser, lambda b: float(slider.get_attribute("value")) < 1.9)
    press(browser, Keys.SPACE)
    tab_to(browser, ".transport .time")
    press(browser, Keys.ARROW_LEFT, Keys.ARROW_LEFT)
    until(browser, lambda b: float(slider.get_attribute("value")) == 0)
    press(browser, Keys.ARROW_RIGHT)
    until(browser, lambda b: float(slider.get_attribute("value")) == pytest.approx(0.1))
    other = fake.submit()
    fake.ended(other)
    browser.execute_script("document.activeElement.blur(); scrollTo(0, 0)")
    browser.get(fake.url)
    for row in (f"#job-{other}", f"tr.job:not(#job-{other})"):
        tab_to(browser, f"{row} td.pick input")
        press(browser, Keys.SPACE)
    until(browser, lambda b: find(b, "#selection strong").text == "2 jobs selected")
    browser.execute_script("document.querySelector('.skip').focus()")
    tab_to(browser, "#selection a")
    press(browser, Keys.ENTER)
    until(browser, lambda b: "compare.html" in b.current_url and len(find_all(b, ".beds .bed")) == 2 and find_all(b, "#results tbody tr"))


def test_a_study_on_paper_has_every_row(fake, browser):
    """More of them than the screen's table has on a page."""
    cases = [{"name": f"case no. {k}", "inputs": {"contact": {"friction": 0.1 + k / 1000}}} for k in range(120)]
    study = submit(fake, name="long table", cases=cases)
    browser.get(f"{fake.url}/web/studies.html#{study}")
    until(browser, lambda b: len(find_all(b, "#cases tbody tr")) == 100)
    until(browser, lambda b: "of 120" in find(b, ".range").text and "read so far" not in find(b, ".range").text)
    pdf = base64.b64decode(browser.execute_cdp_cmd("Page.printToPDF", A4)["data"])
    assert 4 <= len(re.findall(rb"/Type\s*/Page\b", pdf)) <= 12
    if shutil.which("pdftotext"):
        text = subprocess.run(["pdftotext", "-raw", "-", "-"], input=pdf, capture_output=True, check=True).stdout.decode()
        words = " ".join(text.split())
        assert [k for k in range(120) if f"case no. {k} " not in words] == []
    until(browser, lambda b: len(find_all(b, "#cases tbody tr")) == 100)  # the screen has its pages again
