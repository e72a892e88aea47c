"""Tables of particles and of sieves: files of `repose run`, and beds that are sent to the daemon."""
import json
import math
import subprocess
from pathlib import Path

import h5py
import requests
import worker_runs as worker
from conftest import SPEC

CSV = {"Content-Type": "text/csv"}


def lattice(diameter=0.004, spacing=0.0045, side=3):
    """Columns of spheres in the lower half of SPEC's drum, apart."""
    places = [((i - 1) * spacing, -0.014 + j * spacing, (k - 0.5) * spacing) for i in range(side) for j in range(side) for k in range(2)]
    return "x,y,z,diameter,vx\n" + "".join(f"{x:.6g},{y:.6g},{z:.6g},{diameter},0.01\n" for x, y, z in places), len(places)


def run(folder, spec, name="request.json"):
    path = worker.write_spec(folder, spec, name)
    return subprocess.run([worker.REPOSE, "run", str(path), "--out", str(folder / "out")], capture_output=True, text=True)


def starting(**start):
    inputs = {name: value for name, value in SPEC.items() if name != "fill_fraction"}
    return {"inputs": inputs | {"start": start, "duration": {"seconds": 0.02}}}


def test_a_run_starts_from_a_table_beside_its_specification(tmp_path):
    text, count = lattice()
    (tmp_path / "beds").mkdir()
    (tmp_path / "beds/bed.csv").write_text(text)
    done = run(tmp_path, starting(file="beds/bed.csv"))
    assert done.returncode == 0, done.stdout
    first = sorted((tmp_path / "out/snapshots").glob("*.hdf"))[0]
    with h5py.File(first) as file:
        points = file["VTKHDF/Points"][:]
        assert math.isclose(file["VTKHDF/PointData/velocity"][0][0], 0.01, rel_tol=1e-6)
    assert len(points) == count and abs(points[0][0] + 0.0045) < 1e-9
    assert worker.result(tmp_path / "out")["run"]["particles"] == count


def test_what_is_wrong_with_a_table_is_told_with_its_line(tmp_path):
    (tmp_path / "bed.csv").write_text("x,y,z,diameter\n0,0,0,0.004\n0.01,oops,0,0.004\n")
    done = run(tmp_path, starting(file="bed.csv"))
    assert done.returncode == 2
    assert json.loads(done.stdout)["errors"] == [{"pointer": "/inputs/start/file", "detail":
        'names "bed.csv", which in line 3, column y is "oops"; must be a number in [-20, 20] m'}]
    done = run(tmp_path, starting(file="none.csv"))
    assert "which can't be read: No such file" in done.stdout


def test_sieves_come_from_a_file(tmp_path):
    (tmp_path / "sieves.csv").write_text("size,share\n0.003,0.25\n0.004,0.75\n0.005,0\n")
    spec = {"inputs": SPEC | {"particles": [{"size_distribution": {"type": "table", "file": "sieves.csv"}}]}}
    spec["inputs"]["drum"] = {"diameter": 0.05, "length": 0.02, "rotation_rate": 6.0}
    path = worker.write_spec(tmp_path, spec)
    report = json.loads(subprocess.run([worker.REPOSE, "check", str(path)], capture_output=True, text=True).stdout)
    sizes = report["understood"]["sizes"][0]
    # half of the mass: a third of the way through the second sieve's three quarters
    assert math.isclose(sizes["d50"], 0.004 + 0.001 / 3, rel_tol=1e-4) and sizes["cut_off_below"] == 0
    assert report["spec"]["inputs"]["particles"][0]["size_distribution"]["shares"] == [0.25, 0.75]


def test_a_bed_is_sent_kept_and_started_from(daemon):
    text, count = lattice()
    sent = requests.post(daemon.url + "/beds", data=text, headers=CSV)
    assert sent.status_code == 201 and sent.json()["particles"] == count and sent.json()["bytes"] == len(text)
    bed = sent.json()["bedID"]
    assert sent.headers["Location"].endswith(f"/beds/{bed}")
    assert requests.get(daemon.url + f"/beds/{bed}").text == text
    assert [one["bedID"] for one in requests.get(daemon.url + "/beds").json()["beds"]] == [bed]
    posted = requests.post(daemon.url + "/processes/drum/execution", json=starting(bed=bed))
    assert posted.status_code == 201, posted.text
    spec = requests.get(daemon.url + f"/jobs/{posted.json()['jobID']}/spec").json()
    assert len(spec["inputs"]["start"]["particles"]) == count
    study = {"base": starting(bed=bed), "vary": {"/inputs/contact/friction": [0.1, 0.2]}}
    assert requests.post(daemon.url + "/studies", json=study).status_code == 201
    assert requests.delete(daemon.url + f"/beds/{bed}").status_code == 200
    assert requests.get(daemon.url + f"/beds/{bed}").status_code == 404
    daemon.stop()  # what started from it needs it no more
    daemon.start()
    assert daemon.ended(posted.json()["jobID"])["status"] == "successful"


def test_what_can_t_be_a_bed_is_refused_with_every_problem(daemon):
    refused = requests.post(daemon.url + "/beds", data="x,y,z,diameter\n0,0,z,0.004\n0,0,0,9\n0,0\n", headers=CSV)
    assert refused.status_code == 400
    assert [error["pointer"] for error in refused.json()["errors"]] == ["/lines/2/z", "/lines/3/diameter", "/lines/4"]
    assert requests.post(daemon.url + "/beds", json=[1]).status_code == 415
    assert requests.post(daemon.url + "/beds", data=b"x,y,z\n0,0,\x000\n", headers=CSV).status_code == 400
    assert requests.post(daemon.url + "/beds", data=b" " * ((16 << 20) + 1), headers=CSV).status_code == 413
    assert requests.get(daemon.url + "/beds").json()["beds"] == []
    missing = requests.post(daemon.url + "/processes/drum/execution", json=starting(bed="20200101-000000-00000000"))
    assert missing.json()["errors"] == [
        {"pointer": "/inputs/start/bed", "detail": 'is "20200101-000000-00000000"; there is no such bed: /beds lists them'}]
    a_file = requests.post(daemon.url + "/processes/drum/execution", json=starting(file="/etc/passwd.csv"))
    assert a_file.json()["errors"][0]["detail"].startswith("is for `repose run` alone")


def test_the_mean_interface_is_a_result_and_rows_of_sql(daemon):
    job = daemon.submit(SPEC | {"duration": {"seconds": 1.0}})
    assert daemon.ended(job)["status"] == "successful"
    repose = requests.get(f"{daemon.url}/jobs/{job}/results").json()["repose"]
    interface = repose["interface"]
    assert repose["dynamic_cohesive_index"] == repose["interface_fluctuation"]
    x, height = interface["x"], interface["height"]
    assert len(x) == len(height) == len(interface["standard_error"]) > 4 and x == sorted(x)
    slope = (height[-1] - height[0]) / (x[-1] - x[0])
    assert abs(math.degrees(math.atan(slope)) - repose["angle_deg"]) < 15
    sql = "SELECT x, height, standard_error FROM interface JOIN job ON job.number=interface.job WHERE job.id='%s' ORDER BY point" % job
    rows = requests.get(daemon.url + "/query", params={"sql": sql}).json()["rows"]
    assert [[row[0], row[1], row[2]] for row in rows] == [list(row) for row in zip(x, height, interface["standard_error"])]


def test_two_materials_in_steel_start_from_tens_of_thousands_of_given_particles(tmp_path):
    """What Dosta et al. (2024) compare codes by: each pair of M1, M2 and steel has a friction and a restitution of its own."""
    spacing, places = 0.0042, []
    reach = int(0.1 / spacing)
    for k in range(30):
        places += [(i * spacing, j * spacing, (k - 14.5) * spacing) for i in range(-reach, reach + 1) for j in range(-reach, reach + 1)
                   if math.hypot(i * spacing, j * spacing) < 0.0975]
    places = places[:38000]
    assert len(places) == 38000
    (tmp_path / "bed.csv").write_text("x,y,z,species\n" + "".join(
        f"{x:.6f},{y:.6f},{z:.6f},{n % 2}\n" for n, (x, y, z) in enumerate(places)))
    pairs = [("M1", "M1", 0.3, 0.5), ("M1", "M2", 0.2, 0.45), ("M2", "M2", 0.4, 0.4), ("M1", "steel", 0.2, 0.4), ("M2", "steel", 0.2, 0.4)]
    spec = {"inputs": {
        "drum": {"diameter": 0.2, "length": 0.14, "ends": "walls", "rotation_rate": 2.0},
        "materials": {"M1": {"density": 2500, "youngs_modulus": 1e9, "poissons_ratio": 0.2},
                      "M2": {"density": 2000, "youngs_modulus": 0.5e9, "poissons_ratio": 0.2},
                      "steel": {"density": 7200, "youngs_modulus": 210e9, "poissons_ratio": 0.2}},
        "particles": [{"diameter": 0.004, "material": "M1"}, {"diameter": 0.004, "material": "M2"}],
        "wall": {"material": "steel"}, "contact": {"law": "hertz-mindlin"},
        "pairs": [{"between": [a, b], "friction": mu, "restitution": e} for a, b, mu, e in pairs],
        "start": {"file": "bed.csv"}, "duration": {"seconds": 5.0}, "seed": 1}}
    done = subprocess.run([worker.REPOSE, "check", str(worker.write_spec(tmp_path, spec))], capture_output=True, text=True)
    report = json.loads(done.stdout)
    assert "errors" not in report, report
    assert report["estimate"]["particles"] == 38000 and len(report["spec"]["inputs"]["pairs"]) == 5
    assert 1e-7 < report["estimate"]["time_step"] < 1e-5


def test_the_instruments_are_as_their_makers_state_and_can_be_run():
    folder = Path(worker.REPOSE).parents[1] / "api/examples/instruments"
    stated = {"granudrum": lambda i: (i["drum"]["diameter"], i["drum"]["length"], i["fill_fraction"]) == (0.084, 0.02, 0.5),
              "granuheap": lambda i: (i["tube"]["diameter"], i["tube"]["lift_speed"]) == (0.01, 0.01),
              "hall-flowmeter": lambda i: (i["orifice"]["diameter"], i["hopper"]["half_angle_deg"]) == (0.0025, 30),
              "cylinder-100ml": lambda i: 100e-6 < math.pi / 4 * i["cylinder"]["diameter"]**2 * i["cylinder"]["height"] < 150e-6}
    assert {path.stem for path in folder.glob("*.json")} >= set(stated)
    for name, holds in stated.items():
        report = json.loads(subprocess.run([worker.REPOSE, "check", str(folder / f"{name}.json")], capture_output=True, text=True).stdout)
        assert "errors" not in report and holds(report["spec"]["inputs"]), (name, report)
