"""Damping of latching springs makes heaps by Walton & Braun's law as high as by the other two, and leaves drums' angles."""
import math
from statistics import mean, stdev

import pytest
from conftest import drum

SECTION = "Heaps and drums by damped latching springs"
pytestmark = pytest.mark.long
LAWS = ("walton-braun", "spring-dashpot", "hertz-mindlin")


def heap(law, friction, seed):
    """1000 spheres of a tenth of the tube's diameter."""
    return {"process": "heap", "inputs": {
        "tube": {"diameter": 0.03, "lift_speed": 0.02}, "plate": {"diameter": 0.06, "rim_height": 0.0015},
        "particles": [{"diameter": 0.003}], "particle_count": 1000,
        "contact": {"friction": friction, "law": law, "maximum_overlap": 0.03}, "seed": seed, "snapshots": {"interval": 0}}}


def error_of_difference(a, b):
    return math.sqrt(stdev(a) ** 2 / len(a) + stdev(b) ** 2 / len(b))


@pytest.mark.parametrize("friction", [0.2, 0.5])
def test_heaps_by_three_laws_have_one_angle(record, drums, friction):
    results = drums({(law, seed): heap(law, friction, seed) for law in LAWS for seed in range(1, 11)})
    angles = {law: [results[law, seed]["repose"]["angle_deg"] for seed in range(1, 11)] for law in LAWS}
    for law in LAWS[1:]:
        error = error_of_difference(angles[LAWS[0]], angles[law])
        record.between(f"mu {friction}: standard error of walton-braun less {law}", error, 0, 0.6,
                       "single heaps scatter by 1 to 1.4; so that the row below can fail", "degrees")
        record(f"mu {friction}: ten heaps by walton-braun beside {law}", mean(angles[LAWS[0]]), mean(angles[law]), 2 * error,
               "the other law; two standard errors of the difference of means over ten seeds", "degrees")


def test_a_drum_keeps_its_angle(record, drums):
    """Without damping the law is the paper's, to the bit."""
    specs = {(damping, seed): drum(0.1, 1.5707963, length=0.0126, seed=seed, contact={"maximum_overlap": 0.03, "latch_damping": damping})
             for damping in (0, 0.3) for seed in range(1, 13)}
    results = drums(specs)
    angles = {damping: [results[damping, seed]["repose"]["angle_deg"] for seed in range(1, 13)] for damping in (0, 0.3)}
    error = error_of_difference(angles[0], angles[0.3])
    record.between("mu 0.1: standard error of damped less undamped", error, 0, 0.1, "twelve seeds each; so that the row below can fail", "degrees")
    of_one_run = math.sqrt(mean(r["repose"]["standard_error_deg"] ** 2 for r in results.values()))
    record("mu 0.1: twelve drums, damped beside undamped", mean(angles[0.3]), mean(angles[0]), 2 * of_one_run,
           "the paper's law; two standard errors of a single run, which is what the angle of a drum claims", "degrees")
