"""The list of jobs as an instrument: what runs first, sorted, narrowed, with columns of one's own, many jobs at once."""
import requests
from conftest import SPEC
from selenium.webdriver.common.by import By
from test_page import find, find_all, jobs_shown, until


def cells(browser, name):
    at = [head.text for head in find_all(browser, "#heads th")].index(name)
    return [row.find_elements(By.TAG_NAME, "td")[at].text for row in find_all(browser, "tr.job")]


def test_a_list_is_sorted_narrowed_and_changed_many_at_once(fake, browser):
    ended = [fake.ended(fake.submit(SPEC | {"seed": seed, "contact": {"friction": friction}}, project=f"p{seed}"))["jobID"]
             for seed, friction in ((11, 0.5), (12, 0.1), (13, 0.3))]
    slow = [fake.submit(fake="slow", seconds="60", project=name) for name in ("one", "two", "three", "four")]
    for job in slow[:2]:
        fake.until(job, lambda status: status["status"] == "running")
    browser.get(fake.url)
    until(browser, lambda b: jobs_shown(b) == slow + ended[::-1])  # running, then waiting in their turn, then what has ended
    places = until(browser, lambda b: [find(b, f"#job-{job} .place").text for job in slow[2:]])
    assert [place[:12] for place in places] == ["1. in line, ", "2. in line, "] and "expected" in places[0]
    until(browser, lambda b: b.execute_script("return document.querySelector(arguments[0]).naturalWidth", f"#job-{ended[0]} .thumb img") == 1)
    find(browser, "#narrow summary").click()
    until(browser, lambda b: find(b, "#filters").find_element(By.XPATH, ".//label[contains(., 'seed')]/input").click() or True)
    until(browser, lambda b: cells(b, "seed")[-3:] == ["13", "12", "11"])
    browser.find_element(By.XPATH, "//button[.='seed']").click()
    until(browser, lambda b: jobs_shown(b)[:3] == ended[::-1] or cells(b, "seed")[0] == "13")
    find(browser, "#f-column").find_element(By.CSS_SELECTOR, "option[value=friction]").click()
    find(browser, "#f-low").send_keys("0.2")
    find(browser, "#f-high").send_keys("0.4\n")
    until(browser, lambda b: ended[2] in jobs_shown(b) and not {ended[0], ended[1]} & set(jobs_shown(b)))
    address = browser.current_url
    assert "value.friction=0.2..0.4" in address and "sort=-seed" in address and "columns=seed" in address
    shown = jobs_shown(browser)
    browser.get("about:blank")
    browser.get(address)  # all of it is in the address
    until(browser, lambda b: jobs_shown(b) == shown and cells(b, "seed"))
    for chip in range(2):
        until(browser, lambda b: find(b, ".chip button").click() or True)
        until(browser, lambda b: len(find_all(b, ".chip")) == 1 - chip)
    until(browser, lambda b: jobs_shown(b) == slow + ended[::-1])
    for job in slow[1:] + ended[:1]:
        until(browser, lambda b: find(b, f"#job-{job} td.pick input").click() or True)
    assert until(browser, lambda b: find(b, "#selection strong").text) == "4 jobs selected"
    compare = find(browser, "#selection a").get_attribute("href")
    assert compare == f"{fake.url}/web/compare.html?ids={','.join(slow[1:] + ended[:1])}"
    browser.find_element(By.XPATH, "//div[@id='selection']//button[.='Cancel']").click()
    find(browser, "#confirm button[value=cancel]").click()
    until(browser, lambda b: find(b, f"#job-{slow[3]} .badge").text == "dismissed")
    states = {job["jobID"]: job["status"] for job in requests.get(f"{fake.url}/jobs").json()["jobs"]}
    assert states == {slow[0]: "running", **dict.fromkeys(slow[1:], "dismissed"), **dict.fromkeys(ended, "successful")}
