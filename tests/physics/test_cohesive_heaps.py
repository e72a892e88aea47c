"""Cohesive heaps beside those of another code, from the same beds in the same tube."""
import math
import shutil
import statistics
import subprocess

import h5py
import numpy
import pytest

SECTION = "Cohesion"
LIGGGHTS = shutil.which("liggghts")
GRAIN, DENSITY, E, NU, RESTITUTION, FRICTION = 0.004, 2500, 5e6, 0.3, 0.5, 0.5
TUBE, DISH, SPEED = 0.024, 0.056, 0.1  # m; m; m/s, of the tube
STEP, SECONDS = 3e-5, 0.8  # s, of the other code, and from when the tube rises
SEEDS = range(1, 4)


def heap(law, density, seed):
    """In a dish, whose rim nothing passes, so that all particles are in the heap."""
    cohesion = {"cohesion": {"law": law, "energy_density": density}} if law else {}
    return {"process": "heap", "inputs": {
        "tube": {"diameter": TUBE, "lift_speed": SPEED}, "plate": {"diameter": DISH, "rim_height": 0.014, "friction": FRICTION},
        "particles": [{"diameter": GRAIN, "density": DENSITY}], "particle_count": 250,
        "contact": {"law": "hertz-mindlin", "youngs_modulus": E, "poissons_ratio": NU, "restitution": RESTITUTION, "friction": FRICTION, **cohesion},
        "wall": {"friction": FRICTION, **cohesion}, "duration": {"at_most_seconds": 2}, "snapshots": {"interval": 10}, "seed": seed}}


def tube_of_triangles(path, height):
    sides, lines = 60, ["solid tube"]
    around = [(TUBE / 2 * math.cos(2 * math.pi * k / sides), TUBE / 2 * math.sin(2 * math.pi * k / sides)) for k in range(sides)]
    for a, b in zip(around, around[1:] + around[:1]):
        for triangle in (((*a, 0), (*b, 0), (*b, height)), ((*a, 0), (*b, height), (*a, height))):
            lines += ["facet normal 0 0 0", "outer loop", *(f"vertex {x:.9g} {y:.9g} {z:.9g}" for x, y, z in triangle), "endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid tube", ""]))


def script(places, law, density):
    top = places[:, 2].max() + GRAIN
    properties = {"youngsModulus peratomtype": E, "poissonsRatio peratomtype": NU,
                  "coefficientRestitution peratomtypepair 1": RESTITUTION, "coefficientFriction peratomtypepair 1": FRICTION}
    if law:
        properties["cohesionEnergyDensity peratomtypepair 1"] = density
    model = "model hertz tangential history" + (f" cohesion {law}" if law else "")
    half = 0.6 * DISH
    return "\n".join([
        "atom_style granular", "atom_modify map array", "boundary f f f", "newton off", "communicate single vel yes", "units si",
        f"region box block -{half} {half} -{half} {half} -0.01 {2 * top + SPEED * SECONDS:.9g} units box", "create_box 1 box", "neighbor 0.002 bin",
        "neigh_modify delay 0", *(f"fix m{k} all property/global {name} {value}" for k, (name, value) in enumerate(properties.items())),
        f"pair_style gran {model}", "pair_coeff * *", f"timestep {STEP}", "fix g all gravity 9.81 vector 0 0 -1",
        *(f"create_atoms 1 single {x:.15g} {y:.15g} {z:.15g}" for x, y, z in places), f"set group all diameter {GRAIN} density {DENSITY}",
        "fix tube all mesh/surface file tube.stl type 1", f"fix t all wall/gran {model} mesh n_meshes 1 meshes tube",
        f"fix p all wall/gran {model} primitive type 1 zplane 0", f"fix d all wall/gran {model} primitive type 1 zcylinder {DISH / 2} 0 0",
        f"fix rise all move/mesh mesh tube linear 0. 0. {SPEED}", "fix i all nve/sphere", "thermo 5000", f"run {round(SECONDS / STEP)}",
        "write_dump all custom heap.txt id x y z modify format \"%d %.9g %.9g %.9g\"", ""])


def heap_of_liggghts(folder, places, law, density):
    folder.mkdir()
    tube_of_triangles(folder / "tube.stl", places[:, 2].max() + GRAIN)
    (folder / "in").write_text(script(places, law, density))
    done = subprocess.run([LIGGGHTS, "-in", "in"], cwd=folder, capture_output=True, text=True, errors="replace", timeout=3000)
    assert (folder / "heap.txt").exists(), done.stdout[-2000:] + done.stderr
    text = (folder / "heap.txt").read_text()
    return numpy.array([line.split()[1:4] for line in text[text.index("ITEM: ATOMS"):].splitlines()[1:]], dtype=float)


def cone(places):
    """Degrees: the slope of the cone whose centre of mass is as high, and whose mass lies as far from its axis: h = 4 z, R2 = 10/3 r2.

    Of what lies on the plate: a particle may cling to the tube, which carries it away."""
    places = places[places[:, 2] < 6 * GRAIN]
    from_axis = places[:, :2] - places[:, :2].mean(axis=0)
    return math.degrees(math.atan(4 * places[:, 2].mean() / math.sqrt(10 / 3 * (from_axis**2).sum(axis=1).mean())))


def snapshot(result, which):
    with h5py.File(sorted((result["folder"] / "snapshots").glob("*.hdf"))[which]) as file:
        return file["VTKHDF/Points"][:].astype(float)


@pytest.mark.long
@pytest.mark.skipif(not LIGGGHTS, reason="liggghts, the other code, is not installed (Debian's package of that name)")
def test_cohesive_heaps_are_those_of_liggghts(record, drums, tmp_path):
    mean = {}
    for law, density in ((None, 0), ("sjkr", 7e4), ("sjkr2", 3.5e4)):
        found = drums({seed: heap(law, density, seed) for seed in SEEDS})
        ours = [cone(snapshot(found[seed], -1)) for seed in SEEDS]
        theirs = [cone(heap_of_liggghts(tmp_path / f"{law}-{seed}", snapshot(found[seed], 0), law, density)) for seed in SEEDS]
        error = math.sqrt((statistics.variance(ours) + statistics.variance(theirs)) / len(SEEDS))
        name = f"heap of 250, {law or 'without cohesion'}: "
        mean[law] = statistics.mean(ours)
        record(name + "slope of the cone of its moments", mean[law], statistics.mean(theirs), 3 * error,
               "LIGGGHTS, from the same beds in the tube; three standard errors of the difference of means over three", "degrees")
        record.between(name + "standard error of that difference", error, 0, 2.5, "so that a difference would be seen", "degrees")
    record.between("heap of 250: slope with sjkr less that without cohesion", mean["sjkr"] - mean[None], 0.3, 20, "cohesion makes heaps steeper; with more of it, they hang in the tube", "degrees")
