"""The report on the paper: its numbers against numbers worked out by hand, its studies against what the programs take,
and the whole of it, interrupted and continued, on studies of a second."""
import json
import math
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import BUILD, SPEC

ROOT = Path(__file__).resolve().parents[2]
REPRODUCE = ROOT / "tests/reproduce"
sys.path.insert(0, str(REPRODUCE))
import comparing  # noqa: E402
import investigating  # noqa: E402
import markdown  # noqa: E402
import measures  # noqa: E402
import sections_flow  # noqa: E402
from book import Book  # noqa: E402
from report import SECTIONS, report  # noqa: E402

PAPER = json.loads((REPRODUCE / "paper.json").read_text())["rows"]
STUDIES = {path.stem: json.loads(path.read_text()) for path in (ROOT / "api/studies").glob("*.json")}


def a_run(case, angle, error=0.1, regime="rolling", seed=1, **derived):
    return {"job": "j", "case": case, "seed": seed, "status": "successful", "message": "", "process": "drum", "snapshots": [],
            "inputs": {"drum": {"diameter": 0.1, "rotation_rate": 1.5, "length": 0.02}, "contact": {"friction": 0.1, "law": "walton-braun"},
                       "particles": [{"shape": "sphere", "diameter": 0.004}]},
            "results": {"repose": {"angle_deg": angle, "standard_error_deg": error, "minimum_deg": angle - 2, "maximum_deg": angle + 2,
                                   "steady": True, "other_methods": {"chord": angle + 1}, "other_methods_standard_error_deg": {"chord": error}},
                        "regime": {"name": regime, "omega2_inner": 0.01, "evidence": {}}, "run": {"particles": 10, "spheres": 10, "steps": 100,
                        "stiffness": 1000.0, "maximum_overlap": 0.01, "wall_seconds": 1.0}}, "derived": derived}


# --- Beverloo's law ---

def test_the_law_is_found_in_flows_that_follow_it():
    widths, grain, bulk = [0.0095, 0.0105, 0.0115, 0.0125, 0.014], 0.002, 1400.0
    rates = [(0.6 * bulk * math.sqrt(9.81) * (width - 1.4 * grain)**2.5, 1e-4) for width in widths]
    assert sections_flow.exponent(widths, rates, grain)[0] == pytest.approx(2.5, rel=1e-9)
    assert sections_flow.constants(widths, rates, grain, bulk) == pytest.approx((0.6, 1.4), rel=1e-9)


def test_the_error_of_the_exponent_is_its_scatter():
    """Of two flows alone: the quotient of the difference of logarithms, whose error is that of the difference."""
    slope, error = sections_flow.exponent([0.0095, 0.0125], [(1.0, 0.01), (2.0, 0.02)], 0.002)
    apart = math.log(0.0097 / 0.0067)
    assert slope == pytest.approx(math.log(2.0) / apart) and error == pytest.approx(math.sqrt(2) * 0.01 / apart)


# --- means and z ---

def test_a_mean_has_the_larger_of_the_error_among_runs_and_the_one_they_claim():
    runs = [a_run("c", angle) for angle in (24, 25, 26)]
    here = comparing.mean(runs, "results.repose.angle_deg")
    assert here.value == 25 and here.count == 3
    assert here.error == pytest.approx(1 / math.sqrt(3))  # standard deviation 1, three runs
    claimed = comparing.mean([a_run("c", angle, error=3) for angle in (24, 25, 26)], "results.repose.angle_deg")
    assert claimed.error == pytest.approx(math.sqrt(3 * 9) / 3)
    alone = comparing.mean(runs[:1], "results.repose.angle_deg")
    assert (alone.value, alone.error) == (24, 0.1)
    assert comparing.mean(runs[:1], "results.repose.other_methods.chord").error == 0.1
    assert comparing.mean(runs, "results.packing.solid_fraction") is None


ROW = {"case": "c", "what": "angle", "paper": "23", "value": 23, "spread": 1, "measure": "results.repose.angle_deg"}


def test_z_counts_both_spreads():
    verdict = comparing.judge(ROW, [a_run("c", angle) for angle in (24, 25, 26)])
    # t = 2/sqrt(1 + 1/3) = 1.732 with 2 (1 + 1/3)^2/(1/3)^2 = 32 degrees of freedom, of which tables have 10 % at 1.694
    assert 1.645 < verdict.z < 1.732 and verdict.agrees is True
    claimed = comparing.judge(ROW, [a_run("c", angle, error=3) for angle in (24, 25, 26)])
    assert claimed.z == pytest.approx(2 / math.sqrt(1 + 3))  # errors that runs claim are taken as they are
    assert comparing.judge(ROW, [a_run("c", 26.2)]).agrees is False  # 3.2/sqrt(1.01)
    assert comparing.judge(ROW, []).agrees is None
    missing = comparing.judge(ROW | {"measure": "results.packing.solid_fraction"}, [a_run("c", 23)])
    assert missing.agrees is False and missing.here == "none in 1 run"


def test_bounds_and_words_are_judged():
    grows = ROW | {"above": 0, "measure": "derived.change"}
    del grows["value"], grows["spread"]
    runs = [a_run("c", 23, change=one) for one in (0.9, 1.0, 1.1)]
    # t = sqrt(300) with 2 degrees of freedom: 1 - t/sqrt(2 + t^2) = 0.332 %
    assert comparing.judge(grows, runs).z == pytest.approx(2.94, abs=0.01)
    assert comparing.judge(grows, runs).agrees is True
    assert comparing.judge(grows, runs + runs).agrees is True
    assert comparing.judge(grows, [a_run("c", 23, change=one) for one in (-0.9, 1.0, 1.1)]).agrees is False  # 0.4 +- 0.65
    lost = grows | {"above": 5, "less": "results.repose.angle_deg", "measure": "derived.change"}
    assert comparing.judge(lost, [a_run("c", 4, change=one) for one in (18.4, 18.5, 18.6)]).agrees is True
    assert comparing.judge(lost, [a_run("c", 14, change=one) for one in (18.4, 18.5, 18.6)]).agrees is False
    flat = {"case": "c", "what": "slope", "paper": "nearly flat", "within": 5, "measure": "results.repose.angle_deg"}
    assert [comparing.judge(flat, [a_run("c", angle)]).agrees for angle in (-15.1, -5.1, -4.9, 4.9, 5.1)] == [False, False, True, True, False]
    regime = {"case": "c", "what": "regime", "paper": "slumping", "words": ["slumping"], "measure": "results.regime.name"}
    mixed = comparing.judge(regime, [a_run("c", 1, regime="slumping"), a_run("c", 1, regime="rolling")])
    assert mixed.agrees is False and mixed.here == "rolling 1, slumping 1"
    assert comparing.judge(regime, [a_run("c", 1, regime="slumping")]).agrees is True


@pytest.mark.parametrize("t, freedom, z", [(2.920, 2, 1.645), (9.925, 2, 2.576), (63.657, 1, 2.576), (3.169, 10, 2.576), (2.228, 10, 1.960),
                                           (-4.604, 4, -2.576), (5.0, math.inf, 5.0), (0.0, 2, 0.0)])
def test_few_runs_make_a_deviate_less_improbable(t, freedom, z):
    """Two-sided points of Student's distribution, as tables have them for 10, 5 and 1 %."""
    assert comparing.deviate(t, freedom) == pytest.approx(z, abs=0.002)


@pytest.mark.parametrize("value, error, text", [(22.8372, 0.14, "22.84 ± 0.14"), (22.8372, 1.4, "22.8 ± 1.4"), (0.01234, 0.0005, "0.01234 ± 0.00050"),
                                                (250.3, 12, "250 ± 12"), (22.83, None, "22.83")])
def test_an_error_has_two_digits_and_its_value_the_same_place(value, error, text):
    assert markdown.with_error(comparing.Mean(value, error, 3)) == text


# --- measures ---

def snapshot_of(positions, radii):
    return {"position": np.array(positions, float), "radius": np.array(radii, float), "time": 0.0}


def test_loose_particles_are_those_two_diameters_inside_the_inner_surface():
    inputs = {"drum": {"diameter": 0.2, "rotation_rate": 2 * math.pi}}
    # half full: the inner surface is at 0.0707 m; two diameters of 4 mm less is 0.0627 m
    inside, outside = [0.062, 0, 0], [0, -0.0635, 0.1]
    frames = [snapshot_of([inside] * k + [outside] * (10 - k), [0.002] * 10) | {"time": float(time)} for time, k in enumerate((10, 4, 1, 0, 0))]
    found = measures.loose_history(frames, inputs, 0.5)
    assert [share for _, share in found["loose"]] == [1.0, 0.4, 0.1, 0.0, 0.0]
    assert [turn for turn, _ in found["loose"]] == pytest.approx([0, 1, 2, 3, 4])
    assert found["cleared_1_percent"] == pytest.approx(3)
    assert measures.revolution_cleared([[0, 0.5], [1, 0.0], [2, 0.5]], 0.01) is None
    assert measures.revolution_cleared([[0, 0.0], [1, 0.0]], 0.01) == 0


def test_slices_along_the_axis_are_held_against_chance():
    length, count = 0.12, 10  # slices of three diameters of 4 mm
    z = np.repeat((np.arange(count) + 0.5) / count - 0.5, 40) * length
    position = np.column_stack([0 * z, 0 * z, z])
    one_each = measures.axial_profile(snapshot_of(position, np.where(np.arange(len(z)) % 2, 0.002, 0.002 * 0.9999e0 * 0.99)), length)
    # every slice has exactly the mean: chi squared 0 with 9 degrees of freedom
    assert one_each["axial_excess"] == pytest.approx(-9 / math.sqrt(18)) and set(one_each["axial_share"]) == {0.5}
    apart = measures.axial_profile(snapshot_of(position, np.where(z > 0, 0.002, 0.00199 * 0.99)), length)
    # shares 0 and 1: chi squared 400 x 0.25/0.25
    assert apart["axial_excess"] == pytest.approx((400 - 9) / math.sqrt(18))
    assert apart["axial_ends"] == 0 and measures.axial_profile(
        snapshot_of(position, np.where(abs(z) > 0.048, 0.002, 0.0019)), length)["axial_ends"] == pytest.approx(0.8)
    # at random: 200 mixtures have excess 0 +- 1, so their mean 0 +- 0.07
    random = np.random.default_rng(1)
    excess = [measures.axial_profile(snapshot_of(position, np.where(random.permutation(len(z)) % 2, 0.002, 0.0019)), length)["axial_excess"]
              for _ in range(200)]
    assert abs(np.mean(excess)) < 4 * 0.07 and 0.7 < np.std(excess) < 1.4


def test_the_radial_history_is_the_first_and_the_last_sample():
    samples = [{"radial_index": value, "time": 0, "center_of_mass_deg": 1} for value in (None, -0.02, 0.01, 0.05)]
    assert measures.radial_history(samples) == pytest.approx({"radial_start": -0.02, "radial_end": 0.05, "radial_change": 0.07})


# --- the studies and the paper's rows ---

def check(folder, document):
    (folder / "study.json").write_text(json.dumps(document))
    done = subprocess.run([BUILD / "repose", "check", folder / "study.json"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("name", sorted(PAPER))
def test_every_row_of_the_paper_names_a_case_of_its_study(tmp_path, name):
    cases = {case["case"] for case in check(tmp_path, STUDIES[name])["cases"]}
    assert {row["case"] for row in PAPER[name]} <= cases
    for row in PAPER[name]:
        assert sum(kind in row for kind in ("value", "within", "words", "above", "below")) == 1 and row["paper"] and row["place"]
        assert "value" not in row or row["spread"] > 0


def test_every_study_has_a_section_of_its_own():
    assert set(STUDIES) == set(SECTIONS)


def test_table_1_has_its_nine_rows_thrice():
    rows = [row for row in PAPER["table1"] if "value" in row]
    assert [row["paper"] for row in rows] == ["10", "13", "13", "23", "25", "25", "31", "35", "28", "35-39"]
    assert STUDIES["table1"]["repeats"] == 3


def test_what_is_unsaid_is_varied_about_a_row_that_disagrees(tmp_path):
    runs = [a_run("mu 0.02, pi/2 rad/s", angle) for angle in (6, 6.1)] + [a_run("mu 0.1, pi/2 rad/s", 23)]
    collected = {"file": "table1", "document": STUDIES["table1"], "runs": runs}
    assert investigating.disagreeing(collected, PAPER["table1"]) == ["mu 0.02, pi/2 rad/s"]
    document = investigating.document_for(collected, "mu 0.02, pi/2 rad/s", PAPER["table1"])
    assert document["base"]["inputs"]["contact"]["friction"] == 0.02
    names = [case["case"] for case in check(tmp_path, document)["cases"]]
    assert "wall lined with glued spheres" in names and len(names) == len(set(names)) >= 6


def test_a_regime_that_disagrees_is_tried_with_other_walls(tmp_path):
    case = "pi/8 rad/s"
    collected = {"file": "rotation-rate", "document": STUDIES["rotation-rate"], "runs": [a_run(case, 23)]}
    assert investigating.disagreeing(collected, PAPER["rotation-rate"]) == [case]
    document = investigating.document_for(collected, case, PAPER["rotation-rate"])
    assert [entry["case"] for entry in check(tmp_path, document)["cases"]] == ["wall lined with glued spheres", "wall friction 0.25", "wall friction 1"]


# --- the report on canned results ---

def canned(**changed):
    runs = [a_run("mu 0.1, pi/2 rad/s", angle, seed=seed) for seed, angle in enumerate((24, 25, 26))]
    runs += [a_run("mu 0.02, pi/2 rad/s", 7.0, regime="slumping") | {"case": "mu 0.02, pi/2 rad/s"}]
    runs += [a_run("mu 0.2, pi/2 rad/s", 0) | {"status": "failed", "results": {}, "message": "a sphere left the drum"}]
    return {"file": "table1", "document": STUDIES["table1"], "seconds": 60.0, "status": "failed", "source": "abc", "runs": runs} | changed


def rows_of(text, first):
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith(f"| {first} |")]


def test_the_report_has_every_row_with_its_z(tmp_path):
    tried = canned(runs=[a_run("wall lined with glued spheres", 17), a_run("restitution 0.9", 8)])
    book = Book({"table1": canned()}, {("table1", "mu 0.02, pi/2 rad/s"): tried}, tmp_path / "pictures", None, ["table1", "figure3"])
    text = report(book, "a machine")
    summary = rows_of(text, "table1")
    assert len([row for row in summary if len(row) == 7]) == len(PAPER["table1"])
    at_0_1 = next(row for row in summary if row[1] == "mu 0.1, pi/2 rad/s")
    assert at_0_1[2:] == ["angle of repose", "23", "25.00 ± 0.58", "+1.7", "yes"]
    assert next(row for row in summary if row[1:3] == ["mu 0.02, pi/2 rad/s", "angle of repose"])[4:] == ["7.00 ± 0.10", "-6.0", "**no**"]
    assert next(row for row in summary if row[1] == "mu 1, pi/2 rad/s")[4:] == ["not run", "", "not run"]
    # figure 3 was not run, and is not left out
    assert len(rows_of(text, "figure3")) == len(PAPER["figure3"]) + 1 and "## figure3\n\nNot run." in text
    assert "mu 0.2, pi/2 rad/s, seed 1: failed, a sphere left the drum" in text
    # 17 is 4 above 13 where 7 was 6 below
    assert rows_of(text, "wall lined with glued spheres")[0] == ["wall lined with glued spheres", "17.00 ± 0.10", "+4.0", "rolling"]
    assert "The paper's value lies between the study's and that of wall lined with glued spheres." in text


def material_runs(file, results):
    """results: of a friction, a rolling friction and a seed."""
    pairs = [(mu, mu_r, seed) for mu in (0.2, 0.4, 0.6) for mu_r in (0.05, 0.1, 0.2) for seed in (1, 2)]
    runs = [a_run("c", 0, seed=seed) | {"inputs": {"contact": {"friction": mu, "rolling_friction": mu_r}}, "results": results(mu, mu_r, seed)}
            for mu, mu_r, seed in pairs]
    return canned(file=file, document=STUDIES[file], runs=runs)


def test_the_map_of_materials_says_what_the_flow_tells_where_the_drum_tells_nothing(tmp_path):
    """Planes that are given: 20 degrees a unit of friction, 40 of rolling friction; 10 and 5 g/s less."""
    drum = material_runs("materials-map-drum", lambda mu, mu_r, seed: {"repose": {"angle_deg": 10 + 20 * mu + 40 * mu_r + 0.1 * (-1) ** seed}})
    flow = material_runs("materials-map-flow",
                         lambda mu, mu_r, seed: {"flow": {"mass_rate": 0.05 - 0.01 * mu - 0.005 * mu_r + 1e-4 * (-1) ** seed * (1 if mu == 0.4 else 2)}})
    text = report(Book({"materials-map-drum": drum, "materials-map-flow": flow}, {}, tmp_path / "pictures"), "a machine")
    assert "+2.00 ± 0.00 degrees for 0.1 more of friction and by +4.00 ± 0.00" in text and "-1.00 ± 0.00 and -0.50 ± 0.00 g/s" in text
    assert "0.1 more of friction goes with -0.050 of rolling friction, and the flow changes by -0.75 g/s" in text
    assert rows_of(text, "0.4")[0][:3] == ["0.4", "0.05", "20.00 ± 0.10"]


# --- the whole of it ---

def tiny(folder, seconds=0.3, repeats=2):
    studies = folder / "studies"
    studies.mkdir(exist_ok=True)
    drum = SPEC | {"particles": [{"diameter": 0.003}, {"diameter": 0.004}], "duration": {"seconds": seconds}}
    (studies / "figure3.json").write_text(json.dumps({"name": "tiny", "base": {"inputs": drum}, "repeats": repeats,
                                                      "cases": [{"name": "one revolution", "label": {"paper": "x"}}]}))
    (studies / "figure8.json").write_text(json.dumps({"name": "grains", "base": {"process": "granule", "inputs": {"friction": 0.5}},
                                                      "vary": {"/inputs/friction": [0.5, 1.0]}}))
    return [sys.executable, str(REPRODUCE), "--build", str(BUILD), "--data", str(folder / "data"), "--studies", str(studies)]


def test_the_report_comes_from_runs_and_nothing_is_run_twice(tmp_path):
    command = tiny(tmp_path)
    first = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert first.returncode == 0, first.stdout + first.stderr
    text = (tmp_path / "studies/REPORT.md").read_text()
    radial = next(row for row in rows_of(text, "figure3") if row[2] == "growth of the radial index")
    changes = []
    for folder in (tmp_path / "data/jobs").iterdir():
        events = [json.loads(line) for line in (folder / "events.ndjson").read_text().splitlines()] if "drum" in (folder / "spec.json").read_text() else []
        series = [event["values"]["radial_index"] for event in events if event["event"] == "sample"]
        changes += [series[-1] - series[0]] if series else []
    assert len(changes) == 2
    assert float(radial[4].split()[0]) == pytest.approx(np.mean(changes), abs=1e-3)
    assert (tmp_path / "studies/pictures/figure3-end.png").stat().st_size > 1000 and "| 0.5 | 1.8263 |" in text
    again = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert again.returncode == 0 and "tiny: known, 2 of 2 runs are done" in again.stdout and "posted" not in again.stdout
    assert len(list((tmp_path / "data/jobs").iterdir())) == 4


def test_an_interrupted_reproduction_goes_on(tmp_path):
    command = tiny(tmp_path, seconds=2.0, repeats=3)
    process = subprocess.Popen([*command, "figure3"], stdout=subprocess.PIPE, text=True, start_new_session=True)
    for line in process.stdout:
        if "tiny: 0 of 3" in line or "tiny: 1 of 3" in line:
            break
    os.killpg(process.pid, signal.SIGINT)
    assert process.wait(60) == 1
    jobs = sorted(path.name for path in (tmp_path / "data/jobs").iterdir())
    assert not (tmp_path / "studies/REPORT.md").exists()
    again = subprocess.run([*command, "figure3"], capture_output=True, text=True, timeout=120)
    assert again.returncode == 0 and "tiny: known" in again.stdout, again.stdout + again.stderr
    assert set(jobs) <= {path.name for path in (tmp_path / "data/jobs").iterdir()} and len(list((tmp_path / "data/jobs").iterdir())) == 3
    # a report of a part does not take the place of the whole one
    assert "3 of 3" in (tmp_path / "data/REPORT.md").read_text() and not (tmp_path / "studies/REPORT.md").exists()


def test_a_study_that_does_not_exist_is_named():
    done = subprocess.run([sys.executable, REPRODUCE, "figure33"], capture_output=True, text=True)
    assert done.returncode == 2 and "no such study: figure33; there are" in done.stderr
