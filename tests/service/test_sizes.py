"""Runs of spheres whose sizes are distributed: what they tell of them, in every process, and what starts from them."""
import math
from statistics import NormalDist

import h5py
import numpy
import pytest
import worker_runs as worker

MASS = {"type": "lognormal", "by": "mass", "median": 0.003, "geometric_deviation": 1.15, "minimum": 0.0022, "maximum": 0.004}
LEFT = NormalDist(math.log(0.003), math.log(1.15))


def quantile(share):
    """In closed form: the share of what is left of the distribution after it is cut."""
    low, high = LEFT.cdf(math.log(0.0022)), LEFT.cdf(math.log(0.004))
    return math.exp(LEFT.inv_cdf(low + share * (high - low)))


def bed(**changes):
    inputs = {"drum": {"diameter": 0.05, "length": 0.014}, "particles": [{"size_distribution": MASS}], "particle_count": 220,
              "contact": {"maximum_overlap": 0.05}, "duration": {"seconds": 0.06}, "snapshots": {"interval": 0}, **changes}
    return worker.small(**inputs)


def run(folder, name, spec):
    code, _, errors = worker.run(worker.write_spec(folder, spec, name + ".json"), folder / name, cwd=folder)
    assert code == 0, errors
    return worker.result(folder / name)


def diameters(path):
    with h5py.File(path) as file:
        return 2 * file["VTKHDF/PointData/radius"][:].astype(float)


def last_snapshot(folder):
    return sorted(folder.glob("snapshots/*.hdf"))[-1]


def test_a_run_has_the_sizes_asked_for_and_says_so(tmp_path):
    sizes = run(tmp_path, "first", bed())["run"]["sizes"]
    for name, share in (("d10", 0.1), ("d50", 0.5), ("d90", 0.9)):
        assert sizes[name] == pytest.approx(quantile(share), rel=2e-3)
    assert sizes["cut_off_below"] == pytest.approx(LEFT.cdf(math.log(0.0022)), rel=1e-9)
    assert sizes["cut_off_above"] == pytest.approx(1 - LEFT.cdf(math.log(0.004)), rel=1e-9)
    drawn = numpy.sort(diameters(last_snapshot(tmp_path / "first")))
    assert len(set(drawn)) == len(drawn) == 220
    assert sizes["sauter_mean"] == pytest.approx((drawn**3).sum() / (drawn**2).sum(), rel=1e-6)
    assert [sizes["smallest"], sizes["largest"]] == pytest.approx([drawn[0], drawn[-1]], rel=1e-6)
    # and a run from its snapshot has the same spheres, though its seed would draw them in another order
    start = {"file": str(last_snapshot(tmp_path / "first").relative_to(tmp_path))}
    again = bed(seed=8, start=start, duration={"seconds": 0.01})
    del again["inputs"]["particle_count"]
    assert run(tmp_path, "second", again)["run"]["sizes"] == pytest.approx(sizes, rel=1e-6)
    first, second = (diameters(last_snapshot(tmp_path / name)) for name in ("first", "second"))
    assert (first == second).all()


def test_a_tube_takes_them_too(tmp_path):
    spec = {"process": "heap", "inputs": {
        "tube": {"diameter": 0.03, "lift_speed": 0.1}, "plate": {"diameter": 0.06}, "particles": [{"size_distribution": MASS}],
        "particle_count": 150, "contact": {"maximum_overlap": 0.05}, "duration": {"at_most_seconds": 0.05},
        "snapshots": {"interval": 0}, "seed": 1}}
    assert run(tmp_path, "heap", spec)["run"]["sizes"]["d50"] == pytest.approx(quantile(0.5), rel=2e-3)


def test_a_stream_lets_them_in_whatever_their_size(tmp_path):
    spec = {"process": "fill", "inputs": {
        "cylinder": {"diameter": 0.03, "height": 0.06}, "stream": {"diameter": 0.015, "impact_speed": 2.0},
        "particles": [{"size_distribution": MASS}], "particle_count": 300, "contact": {"maximum_overlap": 0.05},
        "duration": {"settling_seconds": 0.01}, "snapshots": {"interval": 0}, "seed": 1}}
    assert run(tmp_path, "fill", spec)["run"]["sizes"]["number_d50"] < quantile(0.5)
    d = diameters(last_snapshot(tmp_path / "fill"))  # in the order in which they came in
    assert len(d) == 300 and abs(d[:150].mean() - d[150:].mean()) < 4 * d.std() * math.sqrt(2 / 150)
