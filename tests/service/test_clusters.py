"""Rigid clusters through the daemon: accepted, told apart, refused with the sphere at fault."""

INPUTS = {"drum": {"diameter": 0.1, "length": 0.02, "rotation_rate": 3.0}, "duration": {"seconds": 0.1}, "seed": 1}


def cluster(*spheres, **more):
    return INPUTS | {"particles": [{"shape": {"spheres": [{"position": place, "diameter": d} for place, d in spheres]}, **more}]}


def test_a_cluster_without_a_diameter_of_its_own_is_known_by_its_largest_sphere(fake):
    job = fake.submit(cluster(([0, 0, 0], 0.003), ([0.002, 0, 0], 0.0025)))
    assert fake.ended(job)["status"] == "successful"
    spec = fake.get(f"/jobs/{job}/spec").json()
    assert "diameter" not in spec["inputs"]["particles"][0]
    assert [s["diameter"] for s in spec["inputs"]["particles"][0]["shape"]["spheres"]] == [0.003, 0.0025]
    rows = fake.get("/query", params={"sql": "select diameter from run_summary"}).json()["rows"]
    assert rows == [[0.003]]


def test_particles_of_a_fill_are_counted_by_the_volume_of_the_union(fake):
    """Two spheres of one diameter whose centres are half of it apart: 27/16 of one's volume."""
    job = fake.submit(cluster(([0, 0, 0], 0.003), ([0.0015, 0, 0], 0.003)))
    alone = fake.submit(INPUTS | {"particles": [{"diameter": 0.003}]})
    for each in (job, alone):
        fake.ended(each)
    (joined,), (single,) = fake.get("/query", params={"sql": "select particles from drum_input order by particles"}).json()["rows"]
    assert abs(single / joined - 27 / 16) < 0.001  # some 4000 of them, to half a particle


def test_spheres_that_make_no_body_are_refused_before_anything_is_kept(fake):
    answer = fake.post(cluster(([0, 0, 0], 0.003), ([0.0031, 0, 0], 0.003)))
    assert answer.status_code == 400
    assert [e["pointer"] for e in answer.json()["errors"]] == ["/inputs/particles/0/shape/spheres/1"]
    assert "one body" in answer.json()["errors"][0]["detail"]
    assert fake.get("/jobs").json()["jobs"] == []
