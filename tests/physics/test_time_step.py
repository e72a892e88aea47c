"""What the number of time steps in a collision does to beds: the default beside steps of a third of its length."""
import math
import statistics

import pytest
from conftest import drum

SECTION = "Time step"
SEEDS = range(1, 7)
FINE = {"steps_per_contact": 42}
ROLLS_HARD, HITS_SOFTLY, CHANGES_WITH_SPEED = {"rolling_friction": 0.1}, {"restitution": 0.3}, {"restitution": 0.6, "unloading": "variable"}
TWO_SIZES = [{"shape": "sphere", "diameter": 0.003}, {"shape": "sphere", "diameter": 0.005}]
CASES = {  # friction, rad/s, contact, other inputs
    "mu 0.2, rough wall": (0.2, math.pi / 2, {}, {"wall": {"friction": 1.0}}),
    "mu 0.5": (0.5, math.pi / 2, {}, {}),
    "mu 0.5, mu_r 0.1": (0.5, math.pi / 2, ROLLS_HARD, {}),
    "mu 0.3, e 0.3": (0.3, math.pi / 2, HITS_SOFTLY, {}),
    "mu 0.3, e that falls with speed": (0.3, math.pi / 2, CHANGES_WITH_SPEED, {}),
    "mu 0.3, two sizes": (0.3, math.pi / 2, {}, {"particles": TWO_SIZES}),
    "mu 0.3, cascading": (0.3, 2 * math.pi, {}, {}),
}


def small(case, seed, contact):
    friction, rate, of_case, inputs = CASES[case]
    return drum(friction, rate, diameter=0.06, length=0.016, grain=0.004, revolutions=3, seed=seed, contact=of_case | contact, **inputs)


@pytest.mark.long
@pytest.mark.parametrize("case", CASES)
def test_a_third_of_the_step_makes_the_same_bed(record, drums, case):
    """Means over six beds each; each row's tolerance is three standard errors of the difference."""
    results = drums({(steps, seed): small(case, seed, contact) for steps, contact in (("as it is", {}), ("fine", FINE)) for seed in SEEDS})
    for name, unit, most, value in (("angle", "degrees", 0.8, lambda r: r["repose"]["angle_deg"]),
                                    ("angle of the centre of mass", "degrees", 0.8, lambda r: r["repose"]["other_methods"]["center-of-mass"]),
                                    ("solid fraction", "", 0.01, lambda r: r["packing"]["solid_fraction"]),
                                    ("torque number", "", 0.01, lambda r: r["drive"]["torque_number"])):
        beds = {steps: [value(results[steps, seed]) for seed in SEEDS] for steps in ("as it is", "fine")}
        error = math.sqrt(sum(statistics.variance(of) / len(SEEDS) for of in beds.values()))
        record(f"{case}: {name} by the default step", statistics.mean(beds["as it is"]), statistics.mean(beds["fine"]), 3 * error,
               "42 steps a contact; three standard errors of six beds each", unit)
        record.between(f"{case}: standard error of that difference of {name}", error, 0, most / 3, "so that a difference would be seen", unit)
