"""`repose plan` on materials that are made up, so that the answer is known in closed form."""
import json
import math
import random
import re
import subprocess

import numpy as np
import pytest

from conftest import ready_calibration
from plan_loop import FRICTION, REPOSE, ROLLING, calibrate, made_up, plan, request_of, run_of

# Two tests that tell both frictions apart.
LINEAR = [lambda m, r: 20 + 20 * m + 10 * r, lambda m, r: 25 + 5 * m + 40 * r]


def test_a_linear_material_is_found_with_the_errors_of_least_squares():
    answer, runs, _ = calibrate(request_of([30, 35]), made_up(LINEAR))
    assert answer["status"] == "identified" and answer["islands"] == 1
    # Flat priors: the covariance is that of least squares, s^2 (A^T A)^-1, and the emulators' errors, below a third, add a tenth.
    slopes = np.array([[20.0, 10.0], [5.0, 40.0]])
    errors = 0.6 * np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
    for name, truth, error in zip((FRICTION, ROLLING), (0.4, 0.2), errors):
        found = answer["credible"][name]
        assert 0.9 * error < found["standard_deviation"] < 1.25 * error
        assert abs(found["median"] - truth) < 1.5 * error
        assert found["95"][0] < found["68"][0] < found["median"] < found["68"][1] < found["95"][1]
    assert answer["best"]["chi_square"] < 0.1
    covariance = np.array(answer["covariance"])
    assert covariance[0, 1] < 0 and covariance[0, 1] == covariance[1, 0]
    # Five sets were run afresh, and are as foretold.
    assert len(answer["family"]) == 5 and [run["stage"] for run in runs].count("verify") == 10
    z = [result["z"] for one in answer["family"] for result in one["results"]]
    assert sum(value * value for value in z) < 25  # chi square of 10 beyond it: 1 in 200
    assert len({case["number"] for case in runs}) == len(runs) and answer["cost"]["jobs"] == len(runs)
    assert answer["cost"]["sphere_steps"] == 2e7 * len(runs) and answer["cost"]["processor_seconds"] == 5.0 * len(runs)
    for target in answer["emulators"]:
        assert target["error"] < 0.2 and target["leave_one_out"]["95"] > 0.8
        assert 0.1 < target["bed_to_bed"] < 0.6  # 0.3 is true; seen in 16 runs


def test_a_curved_ridge_comes_out_whole_and_is_called_one():
    answer, _, _ = calibrate(request_of([20 + 60 * 0.09]), made_up([lambda m, r: 20 + 60 * m * r]))
    assert answer["status"] == "ridge"
    assert any("can be traded" in sentence and "more friction with less rolling friction" in sentence for sentence in answer["words"])
    assert [one["identified"] for one in answer["directions"]] == [True, False]
    samples = np.array(answer["samples"])
    product = samples[:, 0] * samples[:, 1]
    assert len(samples) == 1000 and abs(product.mean() - 0.09) < 0.005 and 0.008 < product.std() < 0.014  # 0.6 / 60 is 0.01
    # Along the ridge friction lies anywhere between 0.09 / 0.5 and 1, with a density of 1 over itself: the median is their geometric mean.
    assert samples[:, 0].min() < 0.2 and samples[:, 0].max() > 0.97
    assert np.median(samples[:, 0]) == pytest.approx(math.sqrt(0.18 * 1.0), rel=0.1)


def test_two_islands_are_both_found_and_weigh_the_same():
    parabola = [lambda m, r: 20 + 80 * (m - 0.525) ** 2 + 20 * r, lambda m, r: 20 + 60 * r]
    answer, _, _ = calibrate(request_of([parabola[0](0.2, 0.2), parabola[1](0.2, 0.2)]), made_up(parabola))
    assert answer["status"] == "ridge" and answer["islands"] == 2
    assert any("2 sets of values" in sentence for sentence in answer["words"])
    friction = np.array(answer["samples"])[:, 0]
    assert 0.35 < (friction < 0.525).mean() < 0.65
    assert not ((friction > 0.35) & (friction < 0.7)).any()
    assert np.median(friction[friction < 0.5]) == pytest.approx(0.2, abs=0.03)
    assert np.median(friction[friction > 0.5]) == pytest.approx(0.85, abs=0.03)


def test_a_target_out_of_reach_is_named_with_how_near_it_comes():
    answer, _, _ = calibrate(request_of([70, 35]), made_up(LINEAR))
    assert answer["status"] == "unreachable"
    assert [one["reached"] for one in answer["reach"]] == [False, True]
    assert answer["reach"][0]["nearest"] == pytest.approx(45, abs=1.0)  # 20 + 20 * 1 + 10 * 0.5
    assert any('"drum 0"' in sentence and "nearest" in sentence for sentence in answer["words"])


def test_targets_that_contradict_each_other_are_told_by_chi_square():
    same = LINEAR[0]
    answer, _, _ = calibrate(request_of([30, 30, 40]), made_up([same, same, same]))
    assert answer["status"] == "unreachable" and all(one["reached"] for one in answer["reach"])
    # Two at 30 and one at 40, errors of 0.6: the mean is off by 3.33, 3.33 and 6.67; the emulators' errors take a little away.
    assert 120 < answer["best"]["chi_square"] < (2 * 3.333 ** 2 + 6.667 ** 2) / 0.36 + 5
    assert any("contradict" in sentence for sentence in answer["words"])


def test_fresh_runs_that_refute_the_emulators_are_said_to():
    """Where the sets are verified, the tests give what they gave nowhere before."""
    def model(case):
        shift = 5 if case["stage"] == "verify" else 0
        return made_up([lambda m, r: LINEAR[0](m, r) + shift, LINEAR[1]])(case)
    answer, _, _ = calibrate(request_of([30, 35]), model)
    assert answer["status"] == "unfinished" and any("not to be trusted" in sentence for sentence in answer["words"])
    assert all(set_["results"][0]["z"] > 4 for set_ in answer["family"])


def test_one_fresh_run_that_is_far_off_refutes_nothing_but_is_told():
    odd = []

    def model(case):
        results = made_up(LINEAR)(case)
        if case["stage"] == "verify" and not odd:
            odd.append(case)
            results["repose"]["angle_deg"] += 5
        return results
    answer, _, _ = calibrate(request_of([30, 35]), model)
    assert answer["status"] == "identified" and any("One of the fresh runs" in sentence for sentence in answer["words"])


def test_it_ends_where_parameters_are_known_as_well_as_was_asked():
    model = made_up(LINEAR, scatter=1.0, own=1.0)
    _, whole, _ = calibrate(request_of([30, 35], stop={"jobs": 64}), model)
    asked = {FRICTION: 0.08, ROLLING: 0.04}
    answer, short, _ = calibrate(request_of([30, 35], stop={"jobs": 64, "standard_error": asked}), model)
    assert len(short) < len(whole) - 10
    assert all(answer["credible"][name]["standard_deviation"] <= error for name, error in asked.items())


def test_where_a_result_is_missing_no_more_runs_are_made():
    def model(case):
        results = made_up(LINEAR, scatter=1.0)(case)
        if case["parameters"][FRICTION] > 0.3:
            results["repose"]["angle_deg"] = None
        return results
    _, runs, _ = calibrate(request_of([30, 35], stop={"jobs": 70}), model)
    missing, refined = 0, [run for run in runs if run["stage"] == "refine"]
    for place, run in enumerate(refined):
        earlier = [other for other in runs[:32 + 2 * (place // 2)] if other["test"] == run["test"]]
        nearest = min(earlier, key=lambda other: math.hypot((other["parameters"][FRICTION] - run["parameters"][FRICTION]) / 0.95,
                                                            (other["parameters"][ROLLING] - run["parameters"][ROLLING]) / 0.5))
        assert nearest["results"]["repose"]["angle_deg"] is not None
        missing += run["results"]["repose"]["angle_deg"] is None
    assert missing  # the values sought are where there is no result: the planner has looked


def test_a_parameter_without_effect_is_said_to_have_none():
    answer, _, _ = calibrate(request_of([30]), made_up([lambda m, r: 20 + 20 * m]))
    assert answer["status"] == "ridge"
    assert answer["words"].count("No target depends on rolling friction within its range.") == 1
    assert answer["credible"][FRICTION]["median"] == pytest.approx(0.5, abs=0.04)
    low, high = answer["credible"][ROLLING]["95"]
    assert low < 0.03 and high > 0.47
    indices = answer["sensitivity"][0]
    assert indices["total"][FRICTION] > 0.97 and indices["total"][ROLLING] < 0.03


def test_a_target_that_nothing_moves_is_said_to_say_nothing():
    answer, _, _ = calibrate(request_of([30]), made_up([lambda m, r: 30]))
    assert answer["status"] == "ridge"
    assert any("says little" in sentence for sentence in answer["words"])


@pytest.mark.parametrize("jobs", [1, 2, 5, 11])
def test_a_small_budget_is_kept_and_the_answer_is_unfinished(jobs):
    answer, runs, _ = calibrate(request_of([30, 35], stop={"jobs": jobs}), made_up(LINEAR))
    assert answer["status"] == "unfinished" and len(runs) <= max(jobs, 2)
    assert answer["words"]


def test_runs_that_fail_leave_the_rest_as_good():
    def model(case):
        return None if case["parameters"][FRICTION] > 0.6 else made_up(LINEAR)(case)
    answer, runs, _ = calibrate(request_of([30, 35]), model)
    assert answer["status"] == "identified"
    assert answer["credible"][FRICTION]["median"] == pytest.approx(0.4, abs=0.05)
    failed = sum(run["status"] == "failed" for run in runs)
    assert failed > 0 and answer["cost"]["failed"] == failed
    assert any("failed" in sentence for sentence in answer["words"])


def test_runs_that_all_fail_end_with_an_answer():
    answer, runs, _ = calibrate(request_of([30, 35]), lambda case: None)
    assert answer["status"] == "unfinished" and "best" not in answer and answer["cost"]["failed"] == len(runs)


def test_results_that_are_null_count_as_missing():
    def model(case):
        results = made_up(LINEAR)(case)
        if case["parameters"][ROLLING] > 0.4:
            results["repose"]["angle_deg"] = None
        return results
    answer, _, _ = calibrate(request_of([30, 35]), model)
    assert answer["status"] == "identified" and answer["cost"]["failed"] == 0


def test_the_same_runs_give_the_same_bytes_in_any_order():
    request = request_of([30, 35])
    _, runs, text = calibrate(request, made_up(LINEAR))
    shuffled = runs[:]
    random.Random(3).shuffle(shuffled)
    assert plan({"request": request, "runs": shuffled, "workers": 2})[1] == text
    half = runs[:36]
    assert plan({"request": request, "runs": half})[1] == plan({"request": request, "runs": half[::-1]})[1]


def test_another_seed_takes_other_points_and_other_beds():
    def start(seed):
        return json.loads(plan({"request": request_of([30, 35], seed=seed)})[1])["cases"]
    one, other = start(1), start(2)
    assert [case["parameters"] for case in one] != [case["parameters"] for case in other]
    seeds = [case["request"]["inputs"]["seed"] for case in one + other]
    assert len(set(seeds)) == len(seeds)


def test_a_plan_waits_for_runs_that_are_under_way():
    request = request_of([30, 35])
    cases = json.loads(plan({"request": request})[1])["cases"]
    runs = [run_of(case, made_up(LINEAR)(case)) for case in cases[:-1]] + [run_of(cases[-1], None, "running")]
    said = json.loads(plan({"request": request, "runs": runs})[1])
    assert said["state"] == "waits" and said["cases"] == [] and said["progress"]["waiting"] == 1


def test_a_batch_has_a_job_for_each_worker():
    request = request_of([30, 35], error=0.25)
    cases = json.loads(plan({"request": request})[1])["cases"]
    runs = [run_of(case, made_up(LINEAR)(case)) for case in cases]
    for workers in (1, 3):
        said = json.loads(plan({"request": request, "runs": runs, "workers": workers})[1])
        assert said["stage"] == "refine" and len(said["cases"]) == workers


def test_a_logarithmic_range_is_sampled_in_its_logarithm():
    request = request_of([30])
    request["parameters"] = {FRICTION: {"range": [0.01, 1.0], "scale": "log"}}
    cases = json.loads(plan({"request": request})[1])["cases"]
    values = [case["parameters"][FRICTION] for case in cases]
    assert sum(value < 0.1 for value in values) in (len(values) // 2 - 1, len(values) // 2, len(values) // 2 + 1)

    def model(case):
        return made_up([lambda m, _: 30 + 5 * math.log(m / 0.1)])({**case, "parameters": {**case["parameters"], ROLLING: 0}})
    answer, _, _ = calibrate(request, model)
    assert answer["status"] == "identified" and answer["credible"][FRICTION]["median"] == pytest.approx(0.1, rel=0.1)


def test_targets_of_one_test_share_its_runs():
    request = request_of([30, 35])
    request["targets"].append({"inputs": {"drum": {"rotation_rate": 2.0}}, "result": "/repose/other_methods/chord", "value": 33,
                               "standard_error": 1})
    cases = json.loads(plan({"request": request})[1])["cases"]
    assert {case["test"] for case in cases} == {0, 1}
    assert all(case["request"]["inputs"]["drum"]["rotation_rate"] == 1.0 + case["test"] for case in cases)
    # A drum turns until its angle is known twice as well as the best of its targets.
    assert all(case["request"]["inputs"]["duration"] == {"until_standard_error_deg": 0.3} for case in cases)


def test_a_heap_beside_a_drum_takes_what_the_base_has_for_both():
    request = request_of([30])
    request["base"]["inputs"]["fill_fraction"] = 0.4
    request["targets"].append({"process": "heap", "inputs": {"tube": {"diameter": 0.03}, "particle_count": 300},
                               "result": "/repose/angle_deg", "value": 33, "standard_error": 1.5})
    code, text = plan({"request": request})
    assert code == 0, text
    heap = next(case["request"] for case in json.loads(text)["cases"] if case["test"] == 1)
    assert heap["process"] == "heap" and "drum" not in heap["inputs"] and "fill_fraction" not in heap["inputs"]
    assert heap["inputs"]["particles"] == [{"diameter": 0.004}] and set(heap["inputs"]["contact"]) == {"friction", "rolling_friction"}


def test_three_and_four_parameters_are_found_with_the_errors_of_least_squares():
    names = [FRICTION, ROLLING, "/inputs/contact/restitution", "/inputs/wall/friction"]
    ranges = [(0.05, 1.0), (0.0, 0.5), (0.3, 0.9), (0.1, 1.1)]
    truth = [0.4, 0.2, 0.7, 0.5]
    for count, slopes in ((3, [[20, 10, 0], [5, 40, 5], [0, 10, 30]]), (4, [[20, 10, 0, 0], [5, 40, 5, 0], [0, 10, 30, 5], [5, 0, 5, 20]])):
        def function(row, values):
            return 20 + sum(slope * value for slope, value in zip(row, values))

        def model(case):
            values = [case["parameters"][name] for name in names[:count]]
            return made_up([lambda m, r: function(slopes[case["test"]], values)] * 4, scatter=0.1, own=0.1)(case | {
                "parameters": {FRICTION: 0, ROLLING: 0}})
        request = request_of([function(row, truth) for row in slopes], stop={"jobs": 250})
        request["parameters"] = {name: {"range": list(ends)} for name, ends in zip(names[:count], ranges)}
        answer, _, _ = calibrate(request, model)
        assert answer["status"] == "identified" and len(answer["family"]) == 2 * count + 1
        errors = 0.6 * np.sqrt(np.diag(np.linalg.inv(np.array(slopes).T @ np.array(slopes))))
        for name, value, error in zip(names, truth, errors):
            assert 0.85 * error < answer["credible"][name]["standard_deviation"] < 1.25 * error
            assert abs(answer["credible"][name]["median"] - value) < 1.5 * error


def test_a_curve_is_fitted_point_by_point():
    """Heaps whose height falls from 20 mm by a slope that follows friction, and rises all over with rolling friction."""
    def model(case):
        m, r = case["parameters"][FRICTION], case["parameters"][ROLLING]
        dice = random.Random(case["request"]["inputs"]["seed"])
        radius = [0.002 * k for k in range(1, 12)]
        height = [0.010 + 0.01 * r + 0.5 * m * (0.024 - at) + dice.gauss(0, 5e-5) for at in radius]
        return {"surface": {"profile": {"radius": radius, "height": height, "standard_error": [1e-4] * len(radius)}}}
    request = request_of([])
    request["base"] = {"process": "heap", "inputs": {"tube": {"diameter": 0.03}, "particles": [{"diameter": 0.003}]}}
    points = [[at, 0.010 + 0.01 * 0.2 + 0.5 * 0.4 * (0.024 - at), 2e-4] for at in (0.003, 0.008, 0.013, 0.018, 0.0215)]
    request["targets"] = [{"curve": "profile", "points": points}]
    answer, _, _ = calibrate(request, model)
    assert answer["status"] == "identified" and len(answer["best"]["targets"]) == 5
    # Least squares again: 0.5 (0.024 - r) and 0.01 for each point, errors of 0.2 mm.
    slopes = np.array([[0.5 * (0.024 - at), 0.01] for at, _, _ in points])
    errors = 2e-4 * np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
    for name, value, error in zip((FRICTION, ROLLING), (0.4, 0.2), errors):
        assert 0.85 * error < answer["credible"][name]["standard_deviation"] < 1.3 * error
        assert abs(answer["credible"][name]["median"] - value) < error


def test_hold_outs_are_predicted_from_the_posterior():
    request = request_of([30, 35])
    request["hold_out"] = [
        {"inputs": {"drum": {"rotation_rate": 2.0}}, "result": "/repose/minimum_deg", "value": 24.0, "standard_error": 0.5},
        {"inputs": {"drum": {"rotation_rate": 9.0}}, "result": "/repose/angle_deg", "value": 46.0, "standard_error": 0.5},
        {"inputs": {"drum": {"rotation_rate": 9.0}}, "result": "/repose/other_methods/chord", "value": 60.0, "standard_error": 0.5}]

    def model(case):
        m, r = case["parameters"][FRICTION], case["parameters"][ROLLING]
        results = made_up([*LINEAR, lambda m, r: 30 + 20 * m + 40 * r])(case)
        results["repose"] |= {"minimum_deg": 20 + 10 * m, "other_methods": {"chord": 40 + 10 * m + 5 * r}}
        return results
    answer, runs, _ = calibrate(request, model)
    assert {run["test"] for run in runs if run["stage"] != "verify"} == {0, 1}
    assert {run["test"] for run in runs if run["stage"] == "verify"} == {0, 1, 2}
    of_known_runs, of_own_runs, far_off = answer["validation"]
    assert of_known_runs["predicted_by"].startswith("the emulator") and of_own_runs["predicted_by"].startswith("the runs")
    assert of_known_runs["predicted"] == pytest.approx(24, abs=0.5) and of_own_runs["predicted"] == pytest.approx(46, abs=1.5)
    assert abs(of_known_runs["z"]) < 1.5 and abs(of_own_runs["z"]) < 2 and far_off["z"] < -10


def test_of_two_tests_that_might_be_next_the_one_that_tells_more_is_first():
    request = request_of([20 + 60 * 0.09])
    request["next_tests"] = [
        {"name": "the same again", "inputs": {"drum": {"rotation_rate": 5.0}}, "result": "/repose/angle_deg", "standard_error": 0.6},
        {"name": "friction alone", "inputs": {"drum": {"rotation_rate": 6.0}}, "result": "/repose/angle_deg", "standard_error": 0.6}]
    tests = [lambda m, r: 20 + 60 * m * r, lambda m, r: 22 + 60 * m * r, lambda m, r: 20 + 20 * m]
    answer, runs, _ = calibrate(request, made_up(tests))
    assert answer["status"] == "ridge"
    first, second = answer["next_test"]
    assert first["name"] == "friction alone" and first["inputs"]["drum"]["rotation_rate"] == 6.0 and first["estimated_seconds"] == 5.0
    # It tells friction to 0.6 / 20 of some 0.23 along the ridge, and the emulator of five runs takes its part of that.
    assert 0.5 < first["would_shrink"] < 0.9 and second["would_shrink"] < 0.3
    request["targets"].append(request["next_tests"].pop() | {"value": 26.0})
    answer, _, _ = calibrate(request, made_up([tests[0], tests[2], tests[1]]))
    assert answer["status"] == "identified"


def test_a_flow_is_proposed_where_two_frictions_can_be_traded_and_settles_it():
    """And not run where they can't."""
    flow = lambda m, r: {"flow": {"mass_rate": 0.25 - 0.25 * m, "mass_rate_standard_error": 0.002}}  # noqa: E731

    def model(angles):
        return lambda case: made_up(angles)(case) if case["request"]["process"] == "drum" else \
            made_up([lambda m, r: 0] * 3)(case) | flow(case["parameters"][FRICTION], case["parameters"][ROLLING])
    request = request_of([20 + 60 * 0.09])
    del request["next_tests"]
    ridge = [lambda m, r: 20 + 60 * m * r]
    answer, runs, _ = calibrate(request, model(ridge))
    proposed = answer["next_test"][0]
    assert answer["status"] == "ridge" and proposed["process"] == "orifice" and proposed["would_shrink"] > 0.5
    # Beverloo's law for a slot of 18 mm and spheres of 4 mm and 2500 kg/m3, by hand: 1.03 * 1500 * 3.13 * 0.024 * 0.0124^1.5 = 0.16 kg/s.
    assert proposed["standard_error"] == pytest.approx(0.03 * 0.16, rel=0.05)
    assert [run["stage"] for run in runs if run["test"] == 1] == ["verify"] * 5
    measured = {key: proposed[key] for key in ("process", "inputs", "result", "standard_error")} | {"value": 0.175}
    answer, _, _ = calibrate(request | {"targets": [*request["targets"], measured]}, model(ridge))
    assert answer["status"] == "identified" and answer["credible"][FRICTION]["median"] == pytest.approx(0.3, abs=0.04)
    request = request_of([30, 35])
    del request["next_tests"]
    answer, runs, _ = calibrate(request, model(LINEAR))
    assert answer["status"] == "identified" and answer["next_test"] == [] and {run["test"] for run in runs} == {0, 1}


def test_the_interface_of_a_drum_is_fitted_point_by_point():
    """Its heights follow friction at one end and rolling friction at the other."""
    def model(case):
        m, r = case["parameters"][FRICTION], case["parameters"][ROLLING]
        dice = random.Random(case["request"]["inputs"]["seed"])
        assert case["request"]["inputs"].get("duration") is None  # no angle is a target
        x = [-0.02 + 0.004 * k for k in range(11)]
        height = [0.01 * m * (at - 0.02) / 0.04 + 0.02 * r * (at + 0.02) / 0.04 + dice.gauss(0, 2e-5) for at in x]
        return {"repose": {"interface": {"x": x, "height": height, "standard_error": [2e-5] * len(x)}}}
    request = request_of([])
    points = [[at, 0.01 * 0.4 * (at - 0.02) / 0.04 + 0.02 * 0.2 * (at + 0.02) / 0.04, 1e-4] for at in (-0.019, -0.01, 0.0, 0.01, 0.019)]
    request["targets"] = [{"curve": "interface", "points": points}]
    answer, _, _ = calibrate(request, model)
    assert answer["status"] == "identified" and len(answer["best"]["targets"]) == 5
    slopes = np.array([[0.01 * (at - 0.02) / 0.04, 0.02 * (at + 0.02) / 0.04] for at, _, _ in points])
    errors = 1e-4 * np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
    for name, value, error in zip((FRICTION, ROLLING), (0.4, 0.2), errors):
        assert 0.85 * error < answer["credible"][name]["standard_deviation"] < 1.3 * error
        assert abs(answer["credible"][name]["median"] - value) < error


def test_the_material_is_written_for_people_and_for_other_programs():
    request = request_of([30, 35])
    request["base"]["inputs"]["contact"] = {"law": "spring-dashpot", "stiffness": 1000.0, "restitution": 0.8, "tangential_stiffness_ratio": 0.5}
    request["parameters"] = {ROLLING: {"range": [0.0, 0.5]}}
    request["base"]["inputs"]["contact"]["friction"] = 0.4
    model = made_up(LINEAR)
    answer, _, _ = calibrate(request, lambda case: model(case | {"parameters": case["parameters"] | {FRICTION: 0.4}}))
    rolling, card, snippets = answer["best"]["parameters"][ROLLING], answer["card"], answer["snippets"]
    assert card["contact"]["friction"] == 0.4 and card["contact"]["rolling_friction"] == rolling == card["found"][ROLLING]["value"]
    assert card["found"][ROLLING]["68"] == answer["credible"][ROLLING]["68"] and card["stiffness"] == 1000.0 and "drum" not in card
    assert [one["target"] for one in card["told_by"]] == ["drum 0", "drum 1"]

    def numbers_after(program, words):
        return [float(number) for number in re.findall(r"-?\d[\d.]*(?:e[-+]?\d+)?", snippets[program]["text"].split(words, 1)[1])]
    assert numbers_after("lammps", "rolling sds")[:3] == pytest.approx([500, 0, rolling])
    # A dashpot of m_eff gamma that leaves 0.8 of the velocity after half a period (any textbook's damped oscillator).
    mass, loss = 2500 * math.pi * 0.004 ** 3 / 6, -math.log(0.8)
    gamma = 2 * loss / math.sqrt(math.pi ** 2 + loss ** 2) * math.sqrt(1000 / (mass / 2))
    assert numbers_after("liggghts", "gamman peratomtypepair 1")[0] == pytest.approx(gamma, rel=1e-6)
    # k_n, damping; k_t, damping as here half the normal one's, mu; then k_roll, no dashpot, mu_r.
    assert numbers_after("lammps", "hooke")[:5] == pytest.approx([1000, gamma, 500, 0.5, 0.4], rel=1e-6)
    assert "rolling_friction epsd2" in snippets["liggghts"]["text"]
    assert numbers_after("mercurydpm", "setRollingFrictionCoefficient")[0] == pytest.approx(rolling / 2)
    assert numbers_after("yade", "young=")[0] == pytest.approx(1000 / 0.002) and numbers_after("yade", "etaRoll=")[0] == pytest.approx(rolling / 2)
    assert all(one["does_not_carry_over"] for one in snippets.values())
    assert any("no dashpot" in loss for loss in snippets["yade"]["does_not_carry_over"])


def refused(request):
    """Pointers, and the sentences at them."""
    code, text = plan({"request": request})
    assert code == 2, text
    return {error["pointer"]: error["detail"] for error in json.loads(text)["errors"]}


def test_a_request_is_refused_whole_with_every_problem():
    request = request_of([30, 35, 36])
    request["parameters"]["/inputs/contact/frition"] = {"range": [0, 1]}
    del request["targets"][0]["standard_error"]
    request["targets"][1]["result"] = "/repose/colour"
    request["targets"][2]["process"] = "hep"
    request["stop"] = {"jobs": 0, "secnds": 3}
    request |= {"name": 3, "label": {"lot": [7]}, "priority": 99}
    request["base"] = request["base"] | {"resources": {"partition": "gpu"}, "label": {"of": "another job"}}
    problems = refused(request)
    assert "/request/base/resources" in problems and "/request/base/label" not in problems
    assert {"/request/name", "/request/label/lot", "/request/priority"} <= set(problems)
    assert "/request/targets/0/standard_error" in problems and "/request/targets/1/result" in problems
    assert '"drum", "fill", "heap"' in problems["/request/targets/2/process"]
    assert "/request/stop/jobs" in problems and "/request/stop/secnds" in problems


@pytest.mark.parametrize("pointer, given, place, words", [
    (FRICTION, {"range": [0, 12]}, "/range", "12"),
    (FRICTION, {"range": [-1, 1]}, "/range", "-1"),
    (FRICTION, {"range": [0.5, 0.2]}, "/range", "must be more than the first"),
    (FRICTION, {"range": [0, 1], "scale": "log"}, "/range", "must begin above 0"),
    (FRICTION, {"range": [0, 1], "scale": "cubic"}, "/scale", "linear"),
    (FRICTION, {"range": [0.1]}, "/range", "two numbers"),
    (FRICTION, {"range": [0.1, 1], "prior": 3}, "/prior", ""),
    ("/inputs/contact/frition", {"range": [0, 1]}, "", "names no input"),
    ("/inputs/contact/law", {"range": [0, 1]}, "", "names no input"),
    ("/inputs/seed", {"range": [0, 1]}, "", "no property"),
    ("friction", {"range": [0, 1]}, "", "names no input"),
    ("/targets/7/inputs/drum/rotation_rate", {"range": [1, 2]}, "", "names no input"),
])
def test_a_parameter_that_cannot_be_varied_is_refused(pointer, given, place, words):
    request = request_of([30])
    request["parameters"] = {pointer: given}
    at = "/request/parameters/" + pointer.replace("/", "~1") + place
    problems = refused(request)
    assert list(problems) == [at] and words in problems[at]


def test_check_tells_what_a_calibration_takes(tmp_path):
    request = request_of([30, 35], name="two drums", stop={"jobs": 60})
    request["base"]["inputs"]["duration"] = {"seconds": 2}
    request["targets"][1]["inputs"]["duration"] = {"seconds": 4}
    def check():
        (tmp_path / "request.json").write_text(json.dumps(request))
        done = subprocess.run([str(REPOSE), "check", str(tmp_path / "request.json"), "--data", str(tmp_path)],
                              capture_output=True, text=True)
        return done.returncode, json.loads(done.stdout)
    ready_calibration()
    code, said = check()
    assert code == 0 and said["name"] == "two drums" and [test["targets"] for test in said["tests"]] == [["drum 0"], ["drum 1"]]
    assert said["estimate"]["jobs"] == 60 and said["estimate"]["wall_seconds"] > 0
    steps = said["estimate"]["steps"]
    request["stop"]["jobs"] = 120
    assert check()[1]["estimate"]["steps"] == pytest.approx(2 * steps, rel=1e-6)
    request["parameters"][FRICTION]["range"] = [0, 12]
    code, said = check()
    assert code == 2 and said["errors"][0]["pointer"].startswith("/parameters/")


def test_a_parameter_of_one_target_alone():
    request = request_of([30, 35])
    request["parameters"] = {FRICTION: {"range": [0.1, 0.9]}, "/targets/1/inputs/drum/rotation_rate": {"range": [1.5, 3.0]}}
    cases = json.loads(plan({"request": request})[1])["cases"]
    rates = [[case["request"]["inputs"]["drum"]["rotation_rate"] for case in cases if case["test"] == test] for test in (0, 1)]
    assert set(rates[0]) == {1.0} and len(set(rates[1])) > 10 and all(1.5 <= rate <= 3.0 for rate in rates[1])


@pytest.mark.parametrize("document", [{}, [], {"request": []}, {"request": {}}, {"request": {"base": 3}}, {"runs": []},
                                      {"request": request_of([30]), "runs": 3}, {"request": request_of([30]), "runs": [{}]},
                                      {"request": request_of([30]), "workers": 0}, {"request": request_of([30]), "more": 0}])
def test_what_is_no_calibration_is_refused(document):
    code, text = plan(document)
    assert code == 2 and json.loads(text)["errors"]
