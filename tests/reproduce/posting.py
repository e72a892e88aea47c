"""Posts studies, but none that the daemon has already, and waits for them with a line of progress now and then."""
import copy
import json
import subprocess
import time

from service import ENDED, ROOT, processors

LINE_EVERY = 60.0  # seconds, where nothing has changed


def source():
    """Which state of the program is about to run, for the studies' labels."""
    done = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else "unknown"


def as_posted(document, version):
    posted = copy.deepcopy(document)
    posted["base"].setdefault("label", {})["source"] = version
    return posted


def plain(document):
    """Without what we or the daemon add to a study: the program's version, and the number of threads."""
    bare = copy.deepcopy(document)
    label = bare["base"].get("label", {})
    label.pop("source", None)
    if not label:
        bare["base"].pop("label", None)
    bare["base"]["inputs"].pop("threads", None)
    return json.dumps(bare, sort_keys=True)


def find(service, document):
    """The newest study of the same document of which nothing failed or was cancelled."""
    for info in service.studies():
        if info["name"] == document["name"] and not info["counts"]["failed"] and not info["counts"]["dismissed"] \
                and plain(service.get(f"/studies/{info['studyID']}/spec")) == plain(document):
            return info
    return None


def post(service, document, tell=print):
    """Id of the study, new or known."""
    known = find(service, document)
    if known:
        tell(f"{document['name']}: known, {known['counts']['successful']} of {known['jobs']} runs are done")
        return known["studyID"]
    study = service.post_study(as_posted(document, source()))
    tell(f"{document['name']}: posted, {service.get(f'/studies/{study}')['jobs']} runs")
    return study


def progress_line(info):
    done = sum(info["counts"][status] for status in ENDED)
    failed = f", {info['counts']['failed']} failed" if info["counts"]["failed"] else ""
    return f"{info['name']}: {done} of {info['jobs']} runs, {info['progress']:.0f} %{failed}"


def left(service, studies):
    """Minutes until all of them have ended, as it was estimated when they were posted."""
    infos = [service.get(f"/studies/{study}") for study in studies]
    seconds = sum(info["estimated_seconds"] * (1.0 - info["progress"] / 100.0) for info in infos if info["status"] not in ENDED)
    return seconds / (service.workers or processors()) / 60.0


def wait(service, study, studies, tell=print):
    """How the study ended. studies: all that are under way, for the time that is left."""
    said, when = None, 0.0
    while True:
        info = service.get(f"/studies/{study}?wait={0 if said is None else 5}")
        done = sum(info["counts"][status] for status in ENDED)
        if done != said or time.monotonic() - when > LINE_EVERY:
            tell(f"{time.strftime('%H:%M:%S')} {progress_line(info)}; about {left(service, studies):.0f} min left in all")
            said, when = done, time.monotonic()
        if info["status"] in ENDED:
            return info
