"""Flows through an orifice: claimed errors against the scatter of seeds, Beverloo's law, and the same flow by another code."""
import json
import math
import re
import shutil
import subprocess
import sys

import h5py
import numpy
import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "tests/reproduce"))
from sections_flow import exponent  # noqa: E402

SECTION = "Flow through an orifice"
LIGGGHTS = shutil.which("liggghts")
GRAIN, DENSITY = 0.002, 2500
MASS = DENSITY * math.pi / 6 * GRAIN**3
VESSEL, OPENING = 0.02, 0.01
E, NU, RESTITUTION, FRICTION = 5e6, 0.3, 0.5, 0.4
STEP = 2e-5  # s, of the other code


def flow(seed=1, count=2500, **contact):
    return {"process": "orifice", "inputs": {
        "vessel": {"diameter": VESSEL}, "orifice": {"diameter": OPENING}, "particles": [{"diameter": GRAIN, "density": DENSITY}],
        "particle_count": count, "contact": {"law": "hertz-mindlin", "youngs_modulus": E, "poissons_ratio": NU, "restitution": RESTITUTION,
                                             "friction": FRICTION, **contact},
        "wall": {"friction": FRICTION}, "duration": {"at_most_seconds": 1.4}, "snapshots": {"interval": 0}, "seed": seed}}


@pytest.mark.minutes
def test_claimed_errors_of_flows_are_their_scatter(record, drums):
    """Eight beds that differ in their seeds: sum of (rate - mean)^2/error^2, which is chi-square of 7."""
    found = drums({seed: flow(seed) for seed in range(1, 9)})
    rates = [one["flow"]["mass_rate"] for one in found.values()]
    errors = [one["flow"]["mass_rate_standard_error"] for one in found.values()]
    middle = sum(rates) / len(rates)
    record.between("mass rates of 8 seeds: chi-square of what they claim", sum(((r - middle) / e) ** 2 for r, e in zip(rates, errors)),
                   0.6, 24.3, "7 degrees of freedom, 999 of 1000 on either side")
    record.between("mass rates of 8 seeds: claimed error over the rate", sum(errors) / len(errors) / middle, 0.001, 0.05,
                   "a claim that says something")


@pytest.mark.long
def test_the_flow_grows_by_beverloos_power_of_the_opening(record, drums):
    """The study beside the examples, one seed less."""
    study = json.loads((ROOT / "api/studies/beverloo.json").read_text())
    specs = {}
    for case in study["cases"]:
        for seed in (1, 2):
            inputs = study["base"]["inputs"] | case["inputs"] | {"seed": seed}
            specs[inputs["orifice"]["diameter"], seed] = {"process": "orifice", "inputs": inputs}
    found = drums(specs)
    widths = sorted({width for width, _ in specs})
    rates = []
    for width in widths:
        flows = [found[width, seed]["flow"] for seed in (1, 2)]
        rates.append((sum(one["mass_rate"] for one in flows) / 2, math.hypot(*(one["mass_rate_standard_error"] for one in flows)) / 2))
    slope, error = exponent(widths, rates, study["base"]["inputs"]["particles"][0]["diameter"])
    record("exponent of the mass rate over D - 1.4 d", slope, 2.5, 3 * error, "Beverloo's law; three errors of the line through five openings")
    record.between("its error", error, 0, 0.15, "small enough to tell 5/2 from 2 and 3")


# ---- beside another code ----

def floor_with_hole(path):
    """A ring of triangles about the axis, out to beyond the wall."""
    sides, lines = 90, ["solid floor"]
    around = [(math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides)) for k in range(sides)]
    for (ax, ay), (bx, by) in zip(around, around[1:] + around[:1]):
        inner, outer = OPENING / 2, 0.6 * VESSEL
        a, b, c, d = ((inner * ax, inner * ay), (outer * ax, outer * ay), (outer * bx, outer * by), (inner * bx, inner * by))
        for triangle in ((a, b, c), (a, c, d)):
            lines += ["facet normal 0 0 1", "outer loop", *(f"vertex {x:.9g} {y:.9g} 0" for x, y in triangle), "endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid floor", ""]))


def script(places, seconds, cohesion):
    top, step = places[:, 2].max() + 0.01, STEP
    properties = {"youngsModulus peratomtype": E, "poissonsRatio peratomtype": NU,
                  "coefficientRestitution peratomtypepair 1": RESTITUTION, "coefficientFriction peratomtypepair 1": FRICTION}
    if cohesion:
        properties["cohesionEnergyDensity peratomtypepair 1"] = cohesion["energy_density"]
    model = "model hertz tangential history" + (f" cohesion {cohesion['law']}" if cohesion else "")
    wide = VESSEL
    return "\n".join([
        "atom_style granular", "atom_modify map array", "boundary f f f", "newton off", "communicate single vel yes", "units si",
        f"region box block -{wide} {wide} -{wide} {wide} -0.03 {top:.9g} units box", "create_box 1 box", "neighbor 0.001 bin",
        "neigh_modify delay 0", *(f"fix m{k} all property/global {name} {value}" for k, (name, value) in enumerate(properties.items())),
        f"pair_style gran {model}", "pair_coeff * *", f"timestep {step}", "fix g all gravity 9.81 vector 0 0 -1",
        *(f"create_atoms 1 single {x:.15g} {y:.15g} {z:.15g}" for x, y, z in places),
        f"set group all diameter {GRAIN} density {DENSITY}",
        "fix floor all mesh/surface file floor.stl type 1",
        f"fix f all wall/gran {model} mesh n_meshes 1 meshes floor",
        f"fix w all wall/gran {model} primitive type 1 zcylinder {VESSEL / 2} 0 0",
        "fix i all nve/sphere", f"region above block INF INF INF INF -{GRAIN} INF units box", "variable n equal count(all,above)",
        "thermo_style custom step v_n", "thermo_modify format float %.15g norm no lost ignore", f"thermo {round(0.02 / step)}",
        f"run {round(seconds / step)}", ""])


def passages_by_liggghts(folder, places, seconds, cohesion):
    """[(time, how many have left)]"""
    floor_with_hole(folder / "floor.stl")
    (folder / "in").write_text(script(places, seconds, cohesion))
    done = subprocess.run([LIGGGHTS, "-in", "in"], cwd=folder, capture_output=True, text=True, errors="replace", timeout=3000)
    seen = [(int(step) * STEP, len(places) - int(float(n))) for step, n in re.findall(r"^ +(\d+) +(\d+) *$", done.stdout, re.M)]
    assert len(seen) > 10, done.stdout[-2000:] + done.stderr
    return seen


def rate_between(seen, start, end):
    """Particles a second by the line between the two, of a count over time."""
    times, counts = zip(*seen)
    return (numpy.interp(end, times, counts) - numpy.interp(start, times, counts)) / (end - start)


@pytest.mark.long
@pytest.mark.skipif(not LIGGGHTS, reason="liggghts, the other code, is not installed (Debian's package of that name)")
@pytest.mark.parametrize("cohesion", [None, {"law": "sjkr", "energy_density": 2000}, {"law": "sjkr2", "energy_density": 2000}],
                         ids=["without cohesion", "sjkr", "sjkr2"])
def test_a_flow_is_that_of_liggghts(record, drums, tmp_path, cohesion):
    """From the places of our own bed at rest, with the same materials; the time is that in which both flow steadily."""
    spec = flow(**({"cohesion": cohesion} if cohesion else {}))
    spec["inputs"]["snapshots"] = {"interval": 10}
    if cohesion:
        spec["inputs"]["wall"]["cohesion"] = cohesion
    ours = drums({"ours": spec})["ours"]
    with h5py.File(ours["folder"] / "snapshots/000000.hdf") as file:
        places = file["VTKHDF/Points"][:].astype(float)
    start, end = ours["flow"]["steady_start"], ours["flow"]["steady_end"]
    theirs = passages_by_liggghts(tmp_path, places, end, cohesion)
    name = f"flow {cohesion['law'] if cohesion else 'without cohesion'}, particles a second, "
    error = ours["flow"]["number_rate_standard_error"]
    record(name + "steady part", ours["flow"]["number_rate"], rate_between(theirs, start, end), 3 * math.sqrt(2) * error,
           "LIGGGHTS, from the same places; both have the error that ours claims, three of their difference", "1/s")
