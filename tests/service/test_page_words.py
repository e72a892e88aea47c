"""The words of the page: everything in results has some, and what a run cannot know is said in them."""
import re

from test_page import find, find_all, row_of, until
from test_page_studies import submit


def members(schema):
    """Every number, truth or word that a description of results promises."""
    for name, member in schema.get("properties", {}).items():
        if "properties" in member:
            yield from members(member)
        elif member.get("type") not in ("object", "array"):
            yield name, member


def test_every_result_has_words_and_none_stands_in_the_pages_own(fake):
    fake.ended(fake.submit())
    words = fake.get("/web/words.js").text + fake.get("/web/study_table.js").text
    for process in ("drum", "fill", "heap", "granule", "orifice"):
        outputs = fake.get(f"/processes/{process}").json()["outputs"]
        found = [member for output in outputs.values() for member in members(output["schema"])]
        assert len(found) > 15 and [name for name, member in found if not member.get("title")] == [], process
        found += list(fake.get("/jobs").json()["jobs"][0]["summary"].items())
        of_the_page = {name for name, _ in found if "_" in name and re.search(rf"\b{name}\b", words)}
        assert of_the_page == set(), process


def test_results_are_shown_by_the_labels_and_units_of_their_description(fake, browser):
    job = fake.submit()
    fake.ended(job)
    browser.get(f"{fake.url}/?open={job}")
    shown = facts(browser, job)
    assert shown["fluctuation of the interface"] == "100 µm" and shown["torque"] == "0.012 N m" and shown["hysteresis"] == "15.5°"
    assert shown["99 of 100 overlaps below"] == "0.4 % of the smallest diameter" and shown["particle steps a second"] == "820,000"
    assert shown["time step"] == "100 µs" and shown["seen from beginning to end"] == "12" and shown["steady"] == "yes"


def facts(browser, job):
    """What an opened job shows, but for its links, label and names of definitions, as {name: value}."""
    rows = until(browser, lambda b: find_all(b, f"#detail-{job} .results .facts div"))
    return {name.text: value.text for name, value in ((find(row, "dt"), find(row, "dd")) for row in rows)}


def test_a_run_too_short_to_tell_is_shown_in_words_and_its_small_numbers_are_no_zeros(fake, browser):
    job = fake.submit(results="of a moment")
    fake.ended(job)
    browser.get(f"{fake.url}/?open={job}")
    shown = facts(browser, job)
    assert shown["verdict"] == "too short to tell" and shown["ended"] == "after the time asked for"
    assert shown["drift at most"] == "1,400° a revolution" and shown["drift"] == shown["steady"] == "–"
    assert shown["revolutions measured"] == "0.0123" and shown["simulated"] == "0.012 s" and shown["measured to"] == "0.01 s"
    assert "rolling, not certain, too short to tell" in find(browser, f"#detail-{job} .answer").text
    row = row_of(browser, job)
    assert find(row, "td.regime").text == "rolling, not certain" and "too short to tell" in find(row, "td.angle").text
    assert not re.search(r"too-short|per revolution|at-most|_", find(browser, f"#detail-{job} .results").text)


def test_a_run_without_an_angle_says_so_in_the_list_and_opened(fake, browser):
    job = fake.submit(results="of too few")
    fake.ended(job)
    browser.get(f"{fake.url}/?open={job}")
    answer = until(browser, lambda b: find(b, f"#detail-{job} .answer").text)
    assert answer.splitlines() == ["no angle", "too few particles to tell"]
    row = row_of(browser, job)
    assert find(row, "td.angle").text.splitlines() == ["no angle", "too few particles to tell"] and find(row, "td.regime").text == "–"
    assert facts(browser, job)["verdict"] == "too few particles to tell"


def words_of_the_first_case(browser, daemon, study, runs):
    """{heading: text} of a study's table, once all its runs have ended."""
    browser.get("about:blank")
    browser.get(f"{daemon.url}/web/studies.html#{study}")
    until(browser, lambda b: f"{runs} of {runs}" in find(b, "#cases tbody").text)
    return dict(zip(*([cell.text for cell in find_all(browser, f"#cases {part} tr :is(th, td)")] for part in ("thead", "tbody"))))


def test_studies_tell_their_verdicts_in_words_also_where_there_is_no_angle(fake, browser):
    tiny = submit(fake, name="tiny", cases=[{"name": "tiny", "label": {"results": "of too few"}}], repeats=2)
    mixed = {"name": "mixed", "inputs": {"seed": 0}, "label": {"verdicts": "steady too-short drifting"}}
    mixed = submit(fake, name="mixed", cases=[mixed], repeats=3)
    shown = words_of_the_first_case(browser, fake, tiny, 2)
    assert shown["verdict"] == "too few particles to tell" and shown["angle of repose"] == "–" and "regime" not in shown
    shown = words_of_the_first_case(browser, fake, mixed, 3)
    assert sorted(shown["verdict"].split(", ")) == ["not steady 1", "steady 1", "too short to tell 1"]
    assert shown["regime"] == "rolling, not certain"
