"""What programs draw of a run: thinned samples, fields as a document, and answers that are not sent again to who has them."""
import csv
import io

import h5py
import numpy
import pytest
import requests
from conftest import SPEC, run_daemon


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """A daemon with a job that has ended."""
    running = run_daemon(tmp_path_factory.mktemp("plots"))
    daemon = next(running)
    job = daemon.submit(SPEC)
    assert daemon.ended(job)["status"] == "successful"
    yield daemon, job
    running.close()


@pytest.mark.parametrize("columns, points", [(["angle_deg"], 4), (["angle_deg"], 7), (["angle_deg", "torque"], 6), ([], 2)])
def test_thinned_samples_have_the_least_and_the_largest_of_each_stretch(served, columns, points):
    daemon, job = served
    every = daemon.get(f"/jobs/{job}/samples").json()["samples"]
    names = columns or [name for name in every[0]["values"] if name != "time"]
    halves, n = points // 2, len(every)
    assert n > 2 * points
    wanted = {0, n - 1}
    for s in range(halves):
        stretch = range(s * n // halves, (s + 1) * n // halves)
        for name in names:
            known = [i for i in stretch if every[i]["values"][name] is not None]
            if known:
                wanted |= {min(known, key=lambda i: every[i]["values"][name]), max(known, key=lambda i: every[i]["values"][name])}
    query = f"/jobs/{job}/samples?points={points}" + (f"&columns={','.join(columns)}" if columns else "")
    answer = daemon.get(query).json()
    assert answer["of"] == n
    assert answer["samples"] == [{**every[i], "values": {name: every[i]["values"][name] for name in names}} for i in sorted(wanted)]
    rows = list(csv.DictReader(io.StringIO(daemon.get(f"{query}&f=csv").text)))
    assert [int(row["number"]) for row in rows] == [every[i]["number"] for i in sorted(wanted)] and set(names) <= set(rows[0])
    assert [float(row[names[0]]) for row in rows] == [sample["values"][names[0]] for sample in answer["samples"]]


def test_columns_alone_thin_nothing_and_what_there_is_not_is_said(served):
    daemon, job = served
    every = daemon.get(f"/jobs/{job}/samples").json()["samples"]
    some = daemon.get(f"/jobs/{job}/samples?columns=angle_deg").json()["samples"]
    assert [sample["values"] for sample in some] == [{"angle_deg": sample["values"]["angle_deg"]} for sample in every]
    unknown = daemon.get(f"/jobs/{job}/samples?columns=angle_deg,colour")
    assert unknown.status_code == 400 and '"colour"' in unknown.json()["detail"]
    for bad in ("points=1", "points=x", "points=10001", "columns=" + 70 * "a"):
        assert daemon.get(f"/jobs/{job}/samples?{bad}").status_code == 400, bad


def test_fields_as_a_document_are_those_of_the_file(served):
    daemon, job = served
    answer = daemon.get(f"/jobs/{job}/fields.json")
    assert answer.status_code == 200 and answer.headers["Content-Encoding"] == "gzip"
    document = answer.json()
    with h5py.File(daemon.data / "jobs" / job / "fields.hdf") as file:
        assert document["cell_size"] == pytest.approx(file["fields"].attrs["size"]) and document["frames"] == file["fields"].attrs["frames"]
        assert set(document["fields"]) == set(file["fields"])
        for name, field in document["fields"].items():
            values = file["fields"][name][:]
            assert values.shape == (document["rows"], document["columns"], field["components"])[: values.ndim]
            told = numpy.array([numpy.nan if value is None else value for value in field["values"]])
            assert numpy.allclose(told, values.ravel(), rtol=5e-4, equal_nan=True), name
    assert document["first_cell"] == pytest.approx([-0.5 * SPEC["drum"]["diameter"] + 0.5 * document["cell_size"]] * 2)


def test_who_has_an_answer_already_is_not_sent_it_again(served):
    daemon, job = served
    for path in ("/jobs", "/jobs?limit=1&f=csv", f"/jobs/{job}", f"/jobs/{job}/results", f"/jobs/{job}/samples", f"/jobs/{job}/samples?points=4",
                 f"/jobs/{job}/snapshots", "/studies", "/processes/drum", f"/jobs/{job}/spec"):
        first = daemon.get(path)
        assert first.status_code == 200 and first.headers["Cache-Control"] == "private, no-cache", path
        again = daemon.get(path, headers={"If-None-Match": first.headers["ETag"]})
        assert again.status_code == 304 and again.content == b"" and again.headers["ETag"] == first.headers["ETag"], path
        plain = daemon.get(path, headers={"Accept-Encoding": "identity"})
        assert plain.content == first.content and plain.headers["ETag"] == first.headers["ETag"].removeprefix("W/"), path
    tag = daemon.get("/jobs").headers["ETag"]
    assert requests.post(f"{daemon.url}/jobs/{job}/pin", timeout=30).status_code == 200
    changed = daemon.get("/jobs", headers={"If-None-Match": tag})
    assert changed.status_code == 200 and changed.json()["jobs"][0]["pinned"] and changed.headers["ETag"] != tag
    assert daemon.get("/jobs?limit=x", headers={"If-None-Match": "*"}).status_code == 400
