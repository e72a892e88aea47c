"""Rolling friction: one sphere on the wall against closed forms, and what it does to a drum's angle."""
import math

import pytest
from conftest import drum, program

SECTION = "Rolling friction"
LAWS = {"walton-braun": 0, "spring-dashpot": 1, "hertz-mindlin": 2}
G, MU_R = 9.81, 0.1


@pytest.mark.parametrize("name", LAWS)
def test_a_rolling_sphere_is_slowed_by_five_sevenths_of_mu_r_g(record, build, name):
    """m a = F and I a/R = mu_r R m g - F R, rolling along the axis, in which the wall is flat."""
    v_0, a = 0.06, 5 / 7 * MU_R * G
    seen = program("roll", build, law=LAWS[name], rolling_friction=MU_R, v_z=v_0, spin=v_0 / 0.002, every=10,
                   samples=int(1.3 * v_0 / a / 1e-4))
    half = len(seen["time"]) // 3
    record(f"deceleration over 5/7 mu_r g, {name}", (v_0 - seen["v_z"][half]) / (a * seen["time"][half]), 1, 2e-3,
           "closed form; the lever R - alpha/2 and the way until the springs yield, 1e-3")
    record(f"way until it rests over v^2/(2 a), {name}", seen["z"][-1] / (v_0**2 / (2 * a)), 1, 2e-3, "closed form; likewise")


@pytest.mark.parametrize("name", LAWS)
def test_a_sphere_on_a_slope_goes_above_mu_r(record, build, name):
    """From rest on the wall of the resting drum, R* = R."""
    for share in (0.95, 1.2, 2):
        angle = math.atan(share * MU_R)
        seen = program("roll", build, law=LAWS[name], rolling_friction=MU_R, angle=angle, every=5000, samples=1)
        way, t = (angle - seen["angle"][0]) * 0.098, seen["time"][0]
        expected = max(0, 5 / 7 * G * (math.sin(angle) - MU_R * math.cos(angle))) * t * t / 2
        record(f"slope of {share} mu_r: way after 0.05 s, {name}", way * 1e6, expected * 1e6, 8 + 0.02 * expected * 1e6,
               "5/7 g (sin - mu_r cos) t^2/2; the springs are slack at first, which makes a speed of 1.5e-4 m/s, and the drum's "
               "curvature takes 1.5 %", "um")


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
