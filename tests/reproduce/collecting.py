"""A study's results as plain data, which the report is written from: one dict a study, one entry a run.

    {"file": "figure3", "document": {...}, "seconds": 63.0, "source": "...", "runs": [
        {"case": "one revolution", "seed": 1, "status": "successful", "message": "", "inputs": {...}, "results": {...},
         "derived": {...}, "job": "...", "snapshots": ["000000.hdf", ...]}]}
"""
import json
from datetime import datetime

from measures import derive


def snapshots_of(folder):
    return sorted(path.name for path in (folder / "snapshots").glob("*.hdf"))


def collect_run(service, job):
    spec = service.get(f"/jobs/{job['jobID']}/spec")
    run = {"job": job["jobID"], "case": job["label"]["case"], "seed": spec["inputs"].get("seed"), "status": job["status"],
           "message": job.get("message", ""), "process": job["processID"], "inputs": spec["inputs"], "results": {}, "derived": {},
           "snapshots": []}
    if job["status"] == "successful":
        folder = service.folder(job["jobID"])
        run["results"] = service.get(f"/jobs/{job['jobID']}/results")
        run["snapshots"] = snapshots_of(folder)
        run["derived"] = derive(run, service.samples(job["jobID"]), folder / "snapshots")
    return run


def seconds_between(info):
    """From the first start of a job to the last end; None before that."""
    if "started" not in info or "finished" not in info:
        return None
    first, last = (datetime.fromisoformat(info[name].replace("Z", "+00:00")) for name in ("started", "finished"))
    return (last - first).total_seconds()


def collect(service, file, study):
    info, jobs = service.get(f"/studies/{study}"), service.jobs(study)
    document = service.get(f"/studies/{study}/spec")
    return {"file": file, "document": document, "seconds": seconds_between(info), "status": info["status"],
            "source": document["base"].get("label", {}).get("source", "unknown"),
            "runs": [collect_run(service, job) for job in jobs]}


def save(collected, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(collected))


def cases_of(collected):
    """Names of the cases in the order of the study."""
    return list(dict.fromkeys(run["case"] for run in collected["runs"]))


def runs_of(collected, case):
    return [run for run in collected["runs"] if run["case"] == case and run["status"] == "successful"]
