"""Single precision in contacts changes no bed: ten small drums in single, ten in double."""
import math
from statistics import mean, stdev

import pytest
from conftest import drum

SECTION = "Drums: single and double precision"
SEEDS = range(1, 11)


@pytest.mark.long
def test_ten_drums_in_single_and_double_have_one_packing(record, drums):
    """Beds of one seed part ways within a second, so the twenty are independent. 600 spheres, mu 0.3, pi rad/s.
    Their angles scatter by three degrees, which would hide any difference that one could expect."""
    results = drums({(precision, seed): drum(0.3, math.pi, diameter=0.08, length=0.01134, seed=seed, precision=precision)
                     for precision in ("single", "double") for seed in SEEDS})
    assert all(result["run"]["precision"] == precision for (precision, _), result in results.items())
    of_precision = {precision: [results[precision, seed] for seed in SEEDS] for precision in ("single", "double")}
    for what, of in (("coordination number", lambda r: r["packing"]["coordination_number"]), ("solid fraction", lambda r: r["packing"]["solid_fraction"])):
        single, double = ([of(r) for r in of_precision[name]] for name in ("single", "double"))
        error = math.sqrt((stdev(single)**2 + stdev(double)**2) / len(SEEDS))
        record(f"ten drums of 600: {what}, single beside double", mean(single), mean(double), 2 * error, "double; two standard errors of the difference of means over ten seeds")
