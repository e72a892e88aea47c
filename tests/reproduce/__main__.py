"""Runs the studies of the paper on a daemon of its own and writes the report.

    python3 tests/reproduce [STUDY ...] [--build DIR] [--data DIR] [--studies DIR] [--report FILE] [--only-report]

The data folder is kept: an interrupted reproduction continues, and studies that have ended are not run again. To begin
afresh, remove it.
"""
import argparse
import json
import sys
import time
from pathlib import Path

import collecting
import investigating
import posting
from book import Book
from report import report
from service import ROOT, Refused, Service, processors

# The paper's order, and what takes long last; a study that is not named here comes behind them.
ORDER = ["figure8", "table1", "figure1", "figure2", "figure3", "figure4", "rotation-rate", "wall-friction", "figure5", "figure7",
         "figure8-beds", "size-scaling", "force-models", "heap", "beverloo", "materials-cohesion",
         "materials-cohesion-heap", "materials-sizes", "materials-rolling", "materials-map-drum", "materials-map-flow", "axial"]


def say(text):
    print(text, flush=True)


def study_files(folder):
    """Name without suffix: path, in order."""
    found = {path.stem: path for path in folder.glob("*.json")}
    names = [name for name in ORDER if name in found] + sorted(set(found) - set(ORDER))
    return {name: found[name] for name in names}


def named(name, files):
    """The study of that name; where there is none, all whose names begin with it: materials-cohesion and others by materials."""
    return [name] if name in files else [study for study in files if study.startswith(f"{name}-")]


def arguments():
    parser = argparse.ArgumentParser(prog="reproduce", description=__doc__.splitlines()[0])
    parser.add_argument("wanted", nargs="*", metavar="STUDY", help="names of files in the studies' folder; default: all")
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--data", type=Path, default=ROOT / "data/reproduce")
    parser.add_argument("--studies", type=Path, default=ROOT / "api/studies")
    parser.add_argument("--report", type=Path, help="default: REPORT.md in the studies' folder, or in the data folder while studies are missing")
    parser.add_argument("--workers", type=int)
    parser.add_argument("--only-report", action="store_true", help="write it from what was collected before, running nothing")
    given = parser.parse_args()
    files = study_files(given.studies)
    unknown = [name for name in given.wanted if not named(name, files)]
    if unknown:
        parser.error(f"no such study: {', '.join(unknown)}; there are {', '.join(files)}")
    wanted = {study for name in given.wanted for study in named(name, files)}
    given.files = {name: path for name, path in files.items() if not given.wanted or name in wanted}
    return given


class Collection:
    """Results on disk, by study and by investigated case."""

    def __init__(self, folder):
        self.folder = folder / "collected"

    def keep(self, collected, case=None):
        name = collected["file"] if case is None else f"{collected['file']}--{case}".replace("/", "_")
        collecting.save({"case": case, "collected": collected}, self.folder / f"{name}.json")

    def read(self, files):
        """files: {name: path}. What was collected from a study that reads otherwise now is left out."""
        studies, investigations = {}, {}
        for path in sorted(self.folder.glob("*.json")):
            kept = json.loads(path.read_text())
            file = kept["collected"]["file"]
            if kept["case"] is not None:
                investigations[file, kept["case"]] = kept["collected"]
            elif file in files and posting.plain(kept["collected"]["document"]) == posting.plain(json.loads(files[file].read_text())):
                studies[file] = kept["collected"]
        return studies, {key: collected for key, collected in investigations.items() if key[0] in studies}


def run_all(service, files, collection, rows_of):
    """Posts all, waits for each, then looks into the rows that disagree."""
    posted = {name: posting.post(service, json.loads(path.read_text()), say) for name, path in files.items()}
    further = []
    for name, study in posted.items():
        posting.wait(service, study, posted.values(), say)
        collected = collecting.collect(service, name, study)
        collection.keep(collected)
        for case in investigating.disagreeing(collected, rows_of(name)):
            further.append((name, case, posting.post(service, investigating.document_for(collected, case, rows_of(name)), say)))
    for name, case, study in further:
        posting.wait(service, study, [entry[2] for entry in further], say)
        collection.keep(collecting.collect(service, name, study), case)


def machine():
    text = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    model = next((line.split(":", 1)[1].strip() for line in text.splitlines() if line.startswith("model name")), "unknown processor")
    return f"Written on {time.strftime('%-d %B %Y')}; {processors()} processors, {model}."


def write_report(given, collection):
    """The report beside the studies is of all of them: a part goes elsewhere, so as not to take its place."""
    everything = study_files(given.studies)
    studies, investigations = collection.read(everything)
    place = given.report or (given.studies if len(studies) == len(everything) else given.data) / "REPORT.md"
    book = Book(studies, investigations, place.parent / "pictures", given.data, list(everything))
    place.write_text(report(book, machine()))
    say(f"{place}: written from {len(studies)} of {len(everything)} studies")


def main():
    given = arguments()
    collection = Collection(given.data)
    if not given.only_report:
        rows = Book({}, {}, given.data)
        try:
            with Service(given.build, given.data, given.workers) as service:
                say(f"daemon at {service.url}, data in {given.data}")
                run_all(service, given.files, collection, rows.rows)
        except KeyboardInterrupt:
            say("interrupted; what is done is kept, and the same command goes on from there")
            return 1
        except Refused as problem:
            say(str(problem))
            return 1
    write_report(given, collection)
    return 0


if __name__ == "__main__":
    sys.exit(main())
