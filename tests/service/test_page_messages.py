"""What the page says where there is something to say: of jobs that wait, of addresses and tokens that are none, and how much
it asks the daemon for."""
import re
import sqlite3

from test_page import find, until
from test_page_studies import submit

WORKERS = 2


def update_job(daemon, job, **columns):
    with sqlite3.connect(daemon.data / "reposed.sqlite") as database:
        database.execute(f"UPDATE job SET {','.join(f'{name}=?' for name in columns)} WHERE id=?", (*columns.values(), job))


def test_what_a_waiting_job_has_to_say_is_shown(fake, browser):
    for _ in range(WORKERS):
        fake.submit(fake="slow", seconds="60")
    waiting, usual = fake.submit(), fake.submit()
    update_job(fake, waiting, message="the disk is full: it goes on when there is room")
    browser.get(f"{fake.url}/?open={waiting}")
    until(browser, lambda b: "the disk is full" in find(b, f"#job-{waiting} .state").text)
    until(browser, lambda b: "the disk is full" in find(b, f"#detail-{waiting}").text)
    state = find(browser, f"#job-{usual} .state").text  # that it waits, its state says, and in what place
    assert re.fullmatch(r"accepted(\n\d+\. in line.*)?", state), state


def test_an_address_of_nothing_says_so_and_shows_a_way_on(fake, browser):
    for address in ["/?cursor=nonsense", "/?q=" + "%C3%A4" * 101, "/web/studies.html#20990101-000000-00000000",
                    "/web/studies.html#%E0%A4%A"]:
        browser.get("about:blank")
        browser.get(fake.url + address)
        until(browser, lambda b: "nothing to show at this address" in find(b, "#trouble").text)
        assert find(browser, "#trouble a").get_attribute("href") == f"{fake.url}/"
        assert "Trying again" not in find(browser, "#trouble").text
    browser.get_log("browser")  # the browser's own line of each 400 and 404


def test_a_search_may_have_a_hundred_characters_of_any_script(fake):
    assert fake.get("/jobs", params={"q": "ä" * 100}).status_code == 200
    answer = fake.get("/jobs", params={"q": "ä" * 101})
    assert answer.status_code == 400 and "101 characters" in answer.json()["detail"]


def test_a_wrong_token_and_one_that_no_header_takes_are_told(daemon_with_token, browser):
    browser.get(daemon_with_token.url)
    field = until(browser, lambda b: find(b, "#token-value") if find(b, "#token").is_displayed() else None)
    for value, said in [("wrong", "does not take this token"), ("schlüssel-€", "this is none")]:
        field.clear()
        field.send_keys(value)
        find(browser, "#token button").click()
        until(browser, lambda b, said=said: said in find(b, "#token-problem").text)
    field.clear()
    field.send_keys("a-token-of-this-test")
    find(browser, "#token button").click()
    until(browser, lambda b: not find(b, "#token").is_displayed())


def test_a_large_study_is_asked_for_in_parts_and_once(fake):
    cases = [{"name": f"{k}", "inputs": {"contact": {"friction": 0.1 + k / 100}}} for k in range(12)]
    study = submit(fake, name="many", cases=cases)
    some = fake.get(f"/studies/{study}/results", params={"limit": 5})
    assert [case["case"] for case in some.json()["cases"]] == [f"{k}" for k in range(5)]
    assert fake.get(f"/studies/{study}/results", params={"limit": 0}).status_code == 400
    fake.get(f"/studies/{study}", params={"wait": 60})
    whole = fake.get(f"/studies/{study}/results")
    assert len(whole.json()["cases"]) == 12
    again = fake.get(f"/studies/{study}/results", headers={"If-None-Match": whole.headers["ETag"]})
    assert again.status_code == 304 and again.content == b""
    assert fake.get(f"/studies/{study}/results", params={"limit": 5}, headers={"If-None-Match": whole.headers["ETag"]}).status_code == 200
