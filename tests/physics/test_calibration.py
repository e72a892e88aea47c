"""Calibrations of materials whose parameters are known: how often the answer's regions hold them."""
import math
import random
import sys
from pathlib import Path

import pytest

SECTION = "Calibrations"
sys.path.append(str(Path(__file__).parents[1] / "service"))
from plan_loop import FRICTION, ROLLING, calibrate, made_up, request_of  # noqa: E402


@pytest.mark.minutes
def test_regions_hold_the_truth_as_often_as_they_say(record):
    dice = random.Random(5)
    tests = [lambda m, r: 18 + 22 * math.sqrt(m) + 12 * r, lambda m, r: 24 + 6 * m + 30 * r / (0.2 + r)]
    held = {"68": 0, "95": 0}
    for _ in range(24):
        truth = dice.uniform(0.15, 0.9), dice.uniform(0.05, 0.45)
        values = [test(*truth) + dice.gauss(0, 0.6) for test in tests]
        request = request_of(values, stop={"jobs": 60}, seed=dice.randrange(2 ** 50))
        answer, _, _ = calibrate(request, made_up(tests))
        for region in held:
            for name, value in zip((FRICTION, ROLLING), truth):
                low, high = answer["credible"][name][region]
                held[region] += low <= value <= high
    record.between("24 made-up materials, two parameters each: truths of 48 in the 68 % regions", held["68"], 23, 42,
                   "68 % are 33, give or take 20 in 100")
    record.between("the same in the 95 % regions", held["95"], 41, 48, "95 % are 46; 17 of 20 are 41")
