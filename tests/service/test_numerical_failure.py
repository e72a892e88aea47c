"""A run that physics can't carry stops with what, where, when and a likely cause; the daemon passes it on."""
from conftest import SPEC


def test_a_bed_too_soft_for_its_weight_fails_with_particle_step_and_cause(daemon):
    # Soft enough that the bed's own weight presses spheres by more than half a radius, and just within what is accepted.
    soft = {**SPEC, "drum": {"diameter": 0.126, "length": 0.0189, "rotation_rate": 1.57},
            "particles": [{"diameter": 0.00378}], "fill_fraction": 0.5,
            "contact": {"friction": 0.1, "stiffness": 20}}
    job = daemon.submit(soft)
    status = daemon.ended(job)
    assert status["status"] == "failed"
    for part in ("overlap", "particle", "step", "m,", "stiffness"):
        assert part in status["message"], status["message"]
    answer = daemon.get(f"/jobs/{job}/results")
    assert answer.status_code == 404 and "overlap" in answer.json()["detail"]
    assert status["attempt"] == 1  # the same again would fail the same: it is not tried again


def test_softer_than_any_run_can_be_is_refused_at_once(daemon):
    answer = daemon.post({**SPEC, "contact": {"stiffness": 0.01}})
    assert answer.status_code == 400
    errors = {e["pointer"]: e["detail"] for e in answer.json()["errors"]}
    assert "N/m" in errors["/inputs/contact/stiffness"]
