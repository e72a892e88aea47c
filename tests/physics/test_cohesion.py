"""Cohesion: the areas of sjkr and sjkr2 beside LIGGGHTS', which has them under these names, and what cohesion does to a drum."""
import math
import re
import shutil
import subprocess

import pytest
from conftest import drum, program

SECTION = "Cohesion"
E, NU, R, DENSITY = 1e7, 0.3, 0.002, 3e4
LIGGGHTS = shutil.which("liggghts")


def script(style, places, wall, steps, seen, *, friction=0.5, restitution=0.9, velocity=(0, 0, 0), time_step=1e-9):
    """Spheres on the z axis, of which the last has a velocity, and with `wall` a plane below; prints the numbers `seen` after so many steps."""
    properties = {"youngsModulus peratomtype": E, "poissonsRatio peratomtype": NU, "coefficientRestitution peratomtypepair 1": restitution,
                  "coefficientFriction peratomtypepair 1": friction, "cohesionEnergyDensity peratomtypepair 1": DENSITY}
    model, last = f"model hertz tangential history cohesion {style}", len(places)
    return "\n".join([
        "atom_style granular", "atom_modify map array", "boundary f f f", "newton off", "communicate single vel yes", "units si",
        "region reg block -0.05 0.05 -0.05 0.05 -0.05 0.05 units box", "create_box 1 reg", "neighbor 0.001 bin", "neigh_modify delay 0",
        *(f"fix m{k} all property/global {name} {value}" for k, (name, value) in enumerate(properties.items())),
        f"pair_style gran {model}", "pair_coeff * *", f"timestep {time_step}",
        *(f"create_atoms 1 single 0 0 {z:.15g}" for z in places), f"set group all diameter {2 * R} density 2500",
        f"group last id {last}", "velocity last set {:.15g} {:.15g} {:.15g} units box".format(*velocity),
        *([f"fix w all wall/gran {model} primitive type 1 zplane 0"] if wall else []),
        "fix i all nve/sphere", "compute spin last property/atom omegay", "compute spin_of_last last reduce sum c_spin",
        *(f"variable v{k} equal {what}" for k, what in enumerate(seen)),
        "thermo_style custom step c_spin_of_last " + " ".join(f"v_v{k}" for k in range(len(seen))),
        "thermo_modify format float %.15g norm no", f"thermo {max(1, steps)}", f"run {max(1, steps)}", ""])


def of_liggghts(folder, style, places, wall, steps, seen, **more):
    """Spin about y of the last sphere, then what `seen` asks for, after so many steps."""
    (folder / "in").write_text(script(style, places, wall, steps, seen, **more))
    done = subprocess.run([LIGGGHTS, "-in", "in"], cwd=folder, capture_output=True, text=True, errors="replace", timeout=60)
    found = re.search(rf"^ +{steps}((?: +-?[\d.e+-]+)+) *$", done.stdout, re.M)
    assert found, done.stdout + done.stderr
    return [float(number) for number in found.group(1).split()]


def force_of_liggghts(folder, style, overlap, wall):
    """On the last of two spheres, or on one before a plane, at rest with that overlap."""
    places = [R - overlap] if wall else [0, 2 * R - overlap]
    return of_liggghts(folder, style, places, wall, 0, [f"fz[{len(places)}]"])[1]


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


@pytest.mark.skipif(not LIGGGHTS, reason="liggghts, the other code, is not installed (Debian's package of that name)")
@pytest.mark.parametrize("style, wall", [("sjkr2", True), ("sjkr", False)], ids=["a sphere and a plane", "two spheres"])
def test_friction_with_cohesion_is_limited_as_in_liggghts(record, tmp_path, style, wall):
    """An elastic impact at a slant that slides throughout: what is lost along the surface is mu times the impulse of the limiting force,
    which is the spring's push, without the pull (in LIGGGHTS too, whose tangential_reduce is off where nothing is said)."""
    v_n, v_t, mu, step = 0.05, 0.1, 0.1, 2e-7
    law = {"sjkr": 2, "sjkr2": 3}[style]
    ours = program("impact", law=2, pair=int(not wall), radius=R, youngs_modulus=E, wall_youngs_modulus=E, restitution=1, friction=mu, v_n=v_n,
                   v_t=v_t, time_step=step, cohesion=law, energy_density=DENSITY)
    gap, steps = 2.5 * v_n * step, 8000
    spin, *v = of_liggghts(tmp_path, style, [R + gap] if wall else [0, 2 * R + gap], wall, steps,
                           ["vx[1]", "vz[1]"] if wall else ["vx[2]-vx[1]", "vz[2]-vz[1]"],
                           friction=mu, restitution=1, velocity=(v_t, 0, -v_n), time_step=step)
    name = f"slides throughout with {style}, {'sphere and plane' if wall else 'two spheres'}: "
    why = "LIGGGHTS, the same impact; the step is a five-thousandth of the contact, which the two may begin at another part of a step"
    record(name + "v_n", ours["v_n"], v[1], 1e-5 * v_n, why, "m/s")
    record(name + "v_t", ours["v_t"], v[0], 1e-5 * v_t, why, "m/s")
    record(name + "spin times r", abs(ours["spin"]) * R, abs(spin) * R, 1e-5 * v_t, why, "m/s")
    if wall:
        pushed = (v_t - ours["v_t"]) / mu / (2 * v_n)
        record.between(name + "impulse of the limit over that which turns the sphere back", pushed, 1.2, 3,
                       "1 were the limit mu times push less pull; it is mu times the push, which outweighs the pull's impulse, too")
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
