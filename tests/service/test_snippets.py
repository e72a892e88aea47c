"""The lines that a calibration writes for other programs, in those of them that are installed: two spheres collide."""
import os
import re
import shutil
import subprocess

import pytest
from plan_loop import FRICTION, ROLLING, calibrate, made_up, request_of

# {before}: what the program calls things; {lines}: the snippet. Two spheres meet head on at 0.1 m/s.
COLLISION = """units si
atom_style {style}
atom_modify map array
{before}
boundary f f f
region box block -0.02 0.02 -0.02 0.02 -0.02 0.02 {units}
create_box 1 box
create_atoms 1 single -0.0021 0 0 {units}
create_atoms 1 single 0.0021 0 0 {units}
set atom 1 diameter 0.004 density 2500 vx 0.05 vy 0 vz 0
set atom 2 diameter 0.004 density 2500 vx -0.05 vy 0 vz 0
neighbor 0.001 bin
{lines}
fix motion all nve/sphere
thermo_style custom step
run 0
run {steps}
variable one equal vx[1]
variable other equal vx[2]
print "velocities ${{one}} ${{other}}"
"""
PROGRAMS = {"lammps": ("lmp", {"style": "sphere", "units": "", "before": "newton on\ncomm_modify vel yes"}),
            "liggghts": ("liggghts", {"style": "granular", "units": "units box",
                                      "before": "newton off\ncommunicate single vel yes"})}


@pytest.fixture(scope="module", params=["walton-braun", "spring-dashpot", "hertz-mindlin"])
def snippets(request):
    asked = request_of([30, 35], stop={"jobs": 5})
    asked["base"]["inputs"]["contact"] = {"law": request.param, "restitution": 0.8, "friction": 0.4}
    asked["parameters"] = {ROLLING: {"range": [0.1, 0.5]}}
    model = made_up([lambda m, r: 20 + 10 * r, lambda m, r: 25 + 40 * r])
    answer, _, _ = calibrate(asked, lambda case: model(case | {"parameters": case["parameters"] | {FRICTION: 0.4}}))
    return answer["snippets"]


@pytest.mark.parametrize("name", PROGRAMS)
def test_spheres_of_a_snippet_part_with_the_restitution_asked_for(snippets, name, tmp_path):
    program, words = PROGRAMS[name]
    if not shutil.which(program):
        pytest.skip(f"{program} is not installed")
    lines = snippets[name]["text"]
    step = float(re.search(r"timestep (\S+)", lines)[1]) / 20  # so that the last step of a contact counts for little
    lines = re.sub(r"timestep \S+", f"timestep {step:g}", lines)
    (tmp_path / "in").write_text(COLLISION.format(lines=lines, steps=round(0.02 / step), **words))
    done = subprocess.run([program, "-in", "in", "-log", "none"], capture_output=True, text=True, cwd=tmp_path, timeout=120,
                          env=os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"})
    assert done.returncode == 0, done.stdout[-800:] + done.stderr[-800:]
    one, other = map(float, re.search(r"velocities (\S+) (\S+)", done.stdout).groups())
    # A hundredth: a twentieth of the step is not none, and one program's damping is a polynomial.
    assert -one == pytest.approx(0.04, rel=0.01) and other == pytest.approx(0.04, rel=0.01)
