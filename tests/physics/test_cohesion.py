"""Cohesion: the areas of sjkr and sjkr2 beside LIGGGHTS', which has them under these names, and what cohesion does to a drum."""
import math
import re
import shutil
import subprocess

import pytest
from conftest import drum

SECTION = "Cohesion"
E, NU, R, DENSITY = 1e7, 0.3, 0.002, 3e4
LIGGGHTS = shutil.which("liggghts")


def script(style, overlap, wall):
    """Two spheres, or one and a plane, at rest with that overlap; prints the force on the last before and after a step of 1 ns."""
    atoms = [R - overlap] if wall else [0, 2 * R - overlap]
    properties = {"youngsModulus peratomtype": E, "poissonsRatio peratomtype": NU, "coefficientRestitution peratomtypepair 1": 0.9,
                  "coefficientFriction peratomtypepair 1": 0.5, "cohesionEnergyDensity peratomtypepair 1": DENSITY}
    model = f"model hertz tangential history cohesion {style}"
    return "\n".join([
        "atom_style granular", "atom_modify map array", "boundary f f f", "newton off", "communicate single vel yes", "units si",
        "region reg block -0.05 0.05 -0.05 0.05 -0.05 0.05 units box", "create_box 1 reg", "neighbor 0.001 bin", "neigh_modify delay 0",
        *(f"fix m{k} all property/global {name} {value}" for k, (name, value) in enumerate(properties.items())),
        f"pair_style gran {model}", "pair_coeff * *", "timestep 1e-9",
        *(f"create_atoms 1 single 0 0 {z:.15g}" for z in atoms), f"set group all diameter {2 * R} density 2500",
        *([f"fix w all wall/gran {model} primitive type 1 zplane 0"] if wall else []),
        "fix i all nve/sphere", f"variable f equal fz[{len(atoms)}]", "thermo_style custom step v_f",
        "thermo_modify format float %.15g norm no", "thermo 1", "run 1", ""])


def force_of_liggghts(folder, style, overlap, wall):
    (folder / "in").write_text(script(style, overlap, wall))
    done = subprocess.run([LIGGGHTS, "-in", "in"], cwd=folder, capture_output=True, text=True, timeout=60)
    found = re.search(r"^ +0 +(-?[\d.e+-]+) *$", done.stdout, re.M)
    assert found, done.stdout + done.stderr
    return float(found.group(1))


def closed_form(style, overlap, wall):
    """As core/NUMERICS.md has it; tests/unit/core/test_cohesion.c holds the core against the same."""
    radius = R if wall else R / 2
    area = {("sjkr", False): math.pi / 4 * overlap * (4 * R - overlap), ("sjkr", True): math.pi * overlap * (2 * R - overlap),
            ("sjkr2", False): 2 * math.pi * R * overlap, ("sjkr2", True): 2 * math.pi * R * overlap}[style, wall]
    return 4 / 3 * E / (2 * (1 - NU**2)) * math.sqrt(radius) * overlap**1.5 - DENSITY * area


@pytest.mark.skipif(not LIGGGHTS, reason="liggghts, the other code, is not installed (Debian's package of that name)")
@pytest.mark.parametrize("wall", [False, True], ids=["two spheres", "a sphere and a plane"])
def test_both_areas_are_those_of_liggghts(record, tmp_path, wall):
    for style in ("sjkr", "sjkr2"):
        for overlap in (1e-6, 2e-5):
            other = force_of_liggghts(tmp_path, style, overlap, wall)
            record(f"force of {style} at {overlap * 1e6:.0f} um, {'sphere and plane' if wall else 'two spheres'}",
                   closed_form(style, overlap, wall) * 1e3, other * 1e3, 1e-8 * 1e3 * abs(other) + 1e-11,
                   "LIGGGHTS, Hertz at rest; places have 15 digits", "mN")


@pytest.mark.minutes
def test_a_drum_s_surface_gets_steeper_and_swings_more_the_more_its_particles_cohere(record, drums):
    def cohesive(bond):
        cohesion = {"cohesion": {"law": "constant", "bond_number": bond}}
        return drum(0.3, 2, diameter=0.06, length=0.012, grain=0.003, revolutions=1, contact=cohesion, wall=cohesion)
    results = drums({bond: cohesive(bond) for bond in (0, 2, 8)})
    angle = [results[bond]["repose"]["angle_deg"] for bond in (0, 2, 8)]
    swing = [results[bond]["repose"]["interface_fluctuation"] for bond in (0, 2, 8)]
    record.between("angle at a Bond number of 8 less that without cohesion", angle[2] - angle[0], 5, 40,
                   "cohesion that bears eight weights holds a surface that friction alone does not", "degrees")
    record.between("the same at 2", angle[1] - angle[0], 0.5, angle[2] - angle[0], "likewise, and less")
    record.between("interface fluctuation at a Bond number of 8 over that without", swing[2] / swing[0], 2, 30,
                   "such beds avalanche in lumps")
    tension = [results[bond]["packing"]["tension_share"] for bond in (0, 2, 8)]
    record.same("contacts in tension without cohesion", tension[0], None, "nothing pulls")
    record.between("share of contacts in tension at a Bond number of 8", tension[2], tension[1], 0.6,
                   "more than at 2, whose pulls more contacts outweigh; what is pressed holds up what hangs")
    record.same("Bond number that the run tells", round(results[8]["run"]["bond_number"], 9), 8, "as asked for")
