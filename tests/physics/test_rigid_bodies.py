"""Rigid clusters: mass and moments of the union, and a free one's tumbling against another integration."""
import math

import pytest
from conftest import drum, program

SECTION = "Rigid clusters"
SHAPES = {"dumbbell": 1, "tetrahedron": 2, "cube": 3}


def test_touching_spheres_have_the_sums_of_their_moments(record):
    by_hand = {"dumbbell": (2, (0.8, 2.8, 2.8)), "tetrahedron": (4, (5.6,) * 3), "cube": (8, (19.2,) * 3)}
    for name, (mass, moments) in by_hand.items():
        seen = program("tumble", shape=SHAPES[name])
        record(f"{name}, touching: mass", seen["mass"], mass, 1e-12, "sum by hand, exact but for rounding", "m")
        for axis, moment in enumerate(moments):
            record(f"{name}, touching: moment {axis + 1}", sorted(seen["inertia"])[axis], moment, 1e-11,
                   "theorem of parallel axes by hand, exact but for rounding", "m a^2")


def test_nothing_counts_twice_where_spheres_overlap(record):
    for name, mass, moment, digits in (("tetrahedron", 3.675, 4.06, 5e-4), ("cube", 7.33, 12.81, 5e-3)):
        seen = program("tumble", shape=SHAPES[name], spacing=0.8)
        why = "union of spheres 0.8 diameters apart by another program, to the digits given"
        record(f"{name}, centres 0.8 diameters apart: mass", seen["mass"], mass, digits, why, "m")
        for axis in range(3):
            record(f"{name}, centres 0.8 diameters apart: moment {axis + 1}", seen["inertia"][axis], moment, 5e-3, why, "m a^2")


# ---- torque-free tumbling ----

SPIN, DURATION = (60.0, 40.0, 30.0), 0.2


def rates(inertia, state):
    w, (e0, e1, e2, e3) = state[:3], state[3:]
    turn = [(inertia[(a + 1) % 3] - inertia[(a + 2) % 3]) * w[(a + 1) % 3] * w[(a + 2) % 3] / inertia[a] for a in range(3)]
    return [*turn, 0.5 * (-e1 * w[0] - e2 * w[1] - e3 * w[2]), 0.5 * (e0 * w[0] + e2 * w[2] - e3 * w[1]),
            0.5 * (e0 * w[1] + e3 * w[0] - e1 * w[2]), 0.5 * (e0 * w[2] + e1 * w[1] - e2 * w[0])]


def turned(inertia, start, steps=4000):
    """Euler's equations and the quaternion's by Runge-Kutta of fourth order: (omega dt)^4 leaves 1e-10."""
    h, s = DURATION / steps, [*SPIN, *start]
    for _ in range(steps):
        a = rates(inertia, s)
        b = rates(inertia, [x + h / 2 * d for x, d in zip(s, a)])
        c = rates(inertia, [x + h / 2 * d for x, d in zip(s, b)])
        d = rates(inertia, [x + h * d for x, d in zip(s, c)])
        s = [x + h / 6 * (p + 2 * q + 2 * r + t) for x, p, q, r, t in zip(s, a, b, c, d)]
    return s[3:]


def energy_and_momentum(inertia, spin):
    return 0.5 * sum(i * w * w for i, w in zip(inertia, spin)), math.sqrt(sum((i * w)**2 for i, w in zip(inertia, spin)))


def test_a_free_cluster_tumbles_as_by_another_integration(record, build):
    """Three unequal moments, some 2.5 turns; the angle between the two orientations at the end."""
    wrong = {}
    for steps in (1000, 2000, 4000):
        seen = program("tumble", build, steps=steps, time_step=DURATION / steps, spin_x=SPIN[0], spin_y=SPIN[1], spin_z=SPIN[2])
        reference = turned(seen["inertia"], seen["start"])
        wrong[steps] = 2 * math.acos(min(1, abs(sum(a * b for a, b in zip(seen["end"], reference)))))
        if steps == 1000:
            pair = zip(("energy", "angular momentum"), energy_and_momentum(seen["inertia"], seen["spin"]),
                       energy_and_momentum(seen["inertia"], SPIN))
            for quantity, now, then in pair:
                record(f"three moments, 16 rad in 1000 steps: {quantity} over the first", now / then, 1, 2e-5,
                       "conserved; (omega dt)^2/12 = 2e-5 of a second-order step")
    record("three moments, 16 rad in 1000 steps: orientation off", wrong[1000], 0, 16 * (80 * DURATION / 1000)**2 / 12 * 2,
           "Runge-Kutta of fourth order; the angle turned times (omega dt)^2/12, and the like for Euler's products", "rad")
    record.between("three moments: half the step, error over", wrong[1000] / wrong[2000], 3.8, 4.2, "second order: 4")
    record.between("three moments: a quarter of the step, error over", wrong[2000] / wrong[4000], 3.8, 4.2, "second order: 4")


# ---- a cluster of one ----

def test_a_cluster_of_one_is_a_sphere_in_a_whole_run(record, drums):
    """A diameter and density that are powers of two, so that no rounding differs. Wall slip alone is measured otherwise:
    below a chord that a bed of clusters has from its own solid fraction."""
    small = dict(diameter=0.04, length=0.015625, grain=0.00390625, seed=3, rate=6.0, revolutions=0.5)
    sphere, cluster = drum(0.3, **small), drum(0.3, **small)
    for spec in (sphere, cluster):
        spec["inputs"]["particles"][0]["density"] = 2048.0
        spec["inputs"]["contact"]["stiffness"] = 2000.0
    cluster["inputs"]["particles"][0] = {"shape": {"spheres": [{"position": [0, 0, 0], "diameter": 0.00390625}]}, "density": 2048.0}
    seen = drums({"sphere": sphere, "cluster": cluster})
    for name, here in (("repose", lambda r: r["repose"]), ("packing", lambda r: r["packing"]), ("regime", lambda r: r["regime"]["name"]),
                       ("largest overlap", lambda r: r["run"]["maximum_overlap"])):
        same = here(seen["cluster"]) == here(seen["sphere"])
        record.same(f"a drum of clusters of one sphere: {name}", "the same digits" if same else "other digits", "the same digits",
                    "a drum of spheres; same bits, since no rounding differs")
    different = sum(any(a[k] != b[k] for k in a if k != "wall_slip") for a, b in zip(seen["cluster"]["samples"], seen["sphere"]["samples"]))
    record("a drum of clusters of one sphere: samples that differ", different, 0, 0, "a drum of spheres; same bits")
    assert len(seen["sphere"]["samples"]) == len(seen["cluster"]["samples"]) > 8


@pytest.mark.minutes
def test_a_standing_bed_of_clusters_keeps_still(record, drums):
    """The slowest drum that can be asked for carries the bed along by 0.029 degrees in half a second: what else it does is
    its own."""
    spec = drum(0.3, 1e-3, diameter=0.06, length=0.021, grain=0.003, duration={"seconds": 1.0})
    spec["inputs"]["particles"][0]["shape"] = "tetrahedron"
    samples = drums({"bed": spec})["bed"]["samples"]
    angles = [s["center_of_mass_deg"] for s in samples if s["time"] > 0.5]
    record("a bed of tetrahedra in a drum at 0.001 rad/s: centre of mass over half a second", max(angles) - min(angles), 0.0286, 0.01,
           "the drum turns by 0.0286; a third of it for contacts that give", "degrees")
