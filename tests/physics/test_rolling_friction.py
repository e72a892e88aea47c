"""Rolling friction: one sphere on the wall against closed forms and another code, and what it does to a drum's angle."""
import math
import re
import shutil
import subprocess

import pytest
from conftest import drum, program

SECTION = "Rolling friction"
LAWS = {"walton-braun": 0, "spring-dashpot": 1, "hertz-mindlin": 2}
ROLLING_LAWS = {"epsd": 0, "epsd-damped": 1, "constant": 2}
G, MU_R = 9.81, 0.1
LIGGGHTS = shutil.which("liggghts")


def named(name, rolling):
    return name if rolling == "epsd" else f"{name}, {rolling}"


@pytest.mark.parametrize("rolling", ROLLING_LAWS)
@pytest.mark.parametrize("name", LAWS)
def test_a_rolling_sphere_is_slowed_by_five_sevenths_of_mu_r_g(record, build, name, rolling):
    """m a = F and I a/R = mu_r R m g - F R, rolling along the axis, in which the wall is flat."""
    v_0, a = 0.06, 5 / 7 * MU_R * G
    seen = program("roll", build, law=LAWS[name], rolling_friction=MU_R, rolling_law=ROLLING_LAWS[rolling], rolling_damping=0.3, v_z=v_0,
                   spin=v_0 / 0.002, every=10, samples=int(1.3 * v_0 / a / 1e-4))
    name = named(name, rolling)
    half = len(seen["time"]) // 3
    record(f"deceleration over 5/7 mu_r g, {name}", (v_0 - seen["v_z"][half]) / (a * seen["time"][half]), 1, 2e-3,
           "closed form; the lever R - alpha/2 and the way until the springs yield, 1e-3")
    record(f"way until it rests over v^2/(2 a), {name}", seen["z"][-1] / (v_0**2 / (2 * a)), 1, 2e-3, "closed form; likewise")


@pytest.mark.parametrize("rolling", ROLLING_LAWS)
@pytest.mark.parametrize("law", LAWS)
def test_a_sphere_on_a_slope_goes_above_mu_r(record, build, law, rolling):
    """From rest on the wall of the resting drum, R* = R."""
    name = named(law, rolling)
    for share in (0.95, 1.2, 2):
        angle = math.atan(share * MU_R)
        seen = program("roll", build, law=LAWS[law], rolling_friction=MU_R, rolling_law=ROLLING_LAWS[rolling], rolling_damping=0.3,
                       angle=angle, every=5000, samples=1)
        way, t = (angle - seen["angle"][0]) * 0.098, seen["time"][0]
        expected = max(0, 5 / 7 * G * (math.sin(angle) - MU_R * math.cos(angle))) * t * t / 2
        record(f"slope of {share} mu_r: way after 0.05 s, {name}", way * 1e6, expected * 1e6, 8 + 0.02 * expected * 1e6,
               "5/7 g (sin - mu_r cos) t^2/2; the springs are slack at first, which makes a speed of 1.5e-4 m/s, and the drum's "
               "curvature takes 1.5 %", "um")


def rolled_by_liggghts(folder, style, v_0, twist, steps):
    """A sphere of 4 mm that rolls along x on a plane, with a spin about the normal, too: its speed after these steps of 10 us."""
    e, nu, radius, density = 5e7, 0.3, 0.002, 2500
    weight = 4 / 3 * math.pi * radius**3 * density * G
    overlap = (3 * weight / (4 * e / (2 * (1 - nu**2)) * math.sqrt(radius))) ** (2 / 3)
    model = f"model hertz tangential history rolling_friction {style}"
    properties = {"youngsModulus peratomtype": e, "poissonsRatio peratomtype": nu, "coefficientRestitution peratomtypepair 1": 0.8,
                  "coefficientFriction peratomtypepair 1": 0.5, "coefficientRollingFriction peratomtypepair 1": MU_R}
    (folder / "in").write_text("\n".join([
        "atom_style granular", "atom_modify map array", "boundary f f f", "newton off", "communicate single vel yes", "units si",
        "region reg block -0.05 0.05 -0.05 0.05 -0.05 0.05 units box", "create_box 1 reg", "neighbor 0.001 bin", "neigh_modify delay 0",
        *(f"fix m{k} all property/global {name} {value}" for k, (name, value) in enumerate(properties.items())),
        f"pair_style gran {model}", "pair_coeff * *", "timestep 1e-5", f"fix g all gravity {G} vector 0 0 -1",
        f"create_atoms 1 single 0 0 {radius - overlap:.15g}", f"set group all diameter {2 * radius} density {density}",
        f"velocity all set {v_0} 0 0 units box", f"set group all omegay {v_0 / radius} omegaz {twist}",
        f"fix w all wall/gran {model} primitive type 1 zplane 0", "fix i all nve/sphere", "variable v equal vx[1]",
        "thermo_style custom step v_v", "thermo_modify format float %.15g norm no", f"thermo {steps}", f"run {steps}", ""]))
    done = subprocess.run([LIGGGHTS, "-in", "in"], cwd=folder, capture_output=True, text=True, timeout=60)
    found = re.search(rf"^ +{steps} +(-?[\d.e+-]+) *$", done.stdout, re.M)
    assert found, done.stdout + done.stderr
    return float(found.group(1))


@pytest.mark.skipif(not LIGGGHTS, reason="liggghts, the other code, is not installed (Debian's package of that name)")
@pytest.mark.parametrize("twist", [0, 60])
@pytest.mark.parametrize("style,rolling", [("cdt", "constant"), ("epsd2", "epsd")])
def test_a_rolling_sphere_is_slowed_as_by_liggghts(record, build, tmp_path, style, rolling, twist):
    v_0, steps = 0.06, 3000
    other = rolled_by_liggghts(tmp_path, style, v_0, twist, steps)
    seen = program("roll", build, law=LAWS["hertz-mindlin"], rolling_friction=MU_R, rolling_law=ROLLING_LAWS[rolling], v_z=v_0,
                   spin=v_0 / 0.002, twist=twist, every=steps, samples=1)
    record(f"speed lost in {steps / 100:.0f} ms by {style}, {twist} rad/s about the normal", (v_0 - seen["v_z"][0]) * 1e3, (v_0 - other) * 1e3,
           2e-3 * (v_0 - other) * 1e3, "LIGGGHTS; the start of friction's springs, which differ, and the lever R - alpha/2, 1e-3 each", "mm/s")


@pytest.mark.long
def test_a_drum_stands_steeper_the_more_its_particles_resist_rolling(record, drums):
    """A small drum, at the friction at which spheres that roll freely stand no steeper for more of it."""
    results = drums({mu_r: drum(0.5, math.pi, diameter=0.06, length=0.016, grain=0.004, revolutions=1, contact={"rolling_friction": mu_r})
                     for mu_r in (0, 0.1, 0.3)})
    angle = {mu_r: r["repose"]["angle_deg"] for mu_r, r in results.items()}
    error = {mu_r: r["repose"]["standard_error_deg"] for mu_r, r in results.items()}
    for low, high in ((0, 0.1), (0.1, 0.3)):
        spread = math.hypot(error[low], error[high])
        record.between(f"mu 0.5: angle at mu_r {high} less that at mu_r {low}, in standard errors", (angle[high] - angle[low]) / spread, 3, 50,
                       "it grows (Wensrich & Katterfeld 2012): by three standard errors of the difference at the least")
