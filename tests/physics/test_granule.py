"""One particle on the wall, process `granule`, against the stepped solutions of equations.md and the paper's own numbers."""
import json
import math
import subprocess

from conftest import BUILD

SECTION = "One particle on the wall"
# least omega^2 R/g with contact all the way round, found by stepping through time, to four digits
LEAST = {0.05: 4.207, 0.1: 3.632, 0.2: 2.861, 0.3: 2.377, 0.4: 2.053, 0.5: 1.826, 0.6: 1.662, 0.7: 1.540, 0.8: 1.447, 0.9: 1.376, 1.0: 1.319}


def granule(folder, **inputs):
    (folder / "spec.json").write_text(json.dumps({"process": "granule", "inputs": inputs}))
    subprocess.run([BUILD / "repose", "run", folder / "spec.json", "--out", folder / "job"], check=True, capture_output=True)
    return json.loads((folder / "job/result.json").read_text())["granule"]


def keeps_contact(mu, omega2, step=2e-4):
    """One revolution and a half from the bottom, turning with the wall, by small steps: u' = T - cos, N = u^2 - sin."""
    wall = math.sqrt(omega2)
    theta, u = -math.pi / 2, wall
    while theta < 2.5 * math.pi:
        n = u * u - math.sin(theta)
        if n < 0 or u <= 0:
            return False
        pull = math.cos(theta)
        if abs(u - wall) < mu * step * max(n, 1) and abs(pull) <= mu * n:
            u = wall
        else:
            u += step * ((mu * n if u < wall else -mu * n) - pull)
        theta += step * u
    return True


def test_the_least_rates_are_those_found_by_stepping(record, tmp_path):
    for mu, least in LEAST.items():
        (tmp_path / str(mu)).mkdir()
        seen = granule(tmp_path / str(mu), friction=mu)
        record(f"least omega^2 R/g, mu = {mu}", seen["minimum_omega2"], least, 6e-4, "stepped through time by another program, four digits")
        if mu in (0.1, 0.5, 1.0):
            low, high = 1.0, 5.0
            while high - low > 1e-4:
                middle = (low + high) / 2
                low, high = (low, middle) if keeps_contact(mu, middle) else (middle, high)
            record(f"least omega^2 R/g, mu = {mu}, stepped here", seen["minimum_omega2"], high, 3e-3,
                   "Euler's steps of 2e-4 and a bisection to 1e-4")


def test_slip_at_full_friction_is_an_eighth_of_a_radian_at_most(record, tmp_path):
    seen = granule(tmp_path, friction=1.0)
    record.between("slip at the least rate, mu = 1", seen["slip_per_revolution"], 0.10, 0.125, "the paper: as much as 1/8; stepping: 0.108 to 0.110", "rad a revolution")
