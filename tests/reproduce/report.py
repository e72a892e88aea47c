"""Writes the report: wholly from the book, in the order of the studies' files."""
import sections_fast
import sections_flow
import sections_materials
import sections_slow
import sections_standing
from collecting import cases_of, runs_of
from comparing import AGREES, BEYOND, judge
from markdown import duration, listed, number, table, with_error, z_text
from tables import agreement, base_text, failures, here_text, paper_table, runs_table, total, verdicts

SECTIONS = {
    "table1": sections_slow.table1, "figure3": sections_slow.figure3, "figure4": sections_slow.figure4, "axial": sections_slow.axial,
    "rotation-rate": sections_slow.rotation_rate, "wall-friction": sections_slow.wall_friction,
    "force-models": sections_slow.force_models, "size-scaling": sections_slow.size_scaling, "figure5": sections_fast.figure5,
    "figure1": sections_standing.figure1, "figure2": sections_standing.figure2, "heap": sections_standing.heap, "beverloo": sections_flow.beverloo,
    "materials-cohesion": sections_materials.cohesion, "materials-cohesion-heap": sections_materials.cohesion_heap,
    "materials-sizes": sections_materials.sizes, "materials-rolling": sections_materials.rolling,
    "materials-map-drum": sections_materials.drum_map, "materials-map-flow": sections_materials.flow_map,
    "figure7": sections_fast.figure7, "figure8": sections_fast.figure8, "figure8-beds": sections_fast.figure8_beds,
}

HEAD = """# The paper, run again

Walton & Braun (1993), *Simulation of rotary-drum and repose tests for frictional spheres and rigid sphere clusters*: every
table and figure that can be computed, from the studies in this folder. `make reproduce` runs them and writes this page; nothing
in it is written by hand but the paper's own values (`tests/reproduce/paper.json`). How each number is measured:
`core/NUMERICS.md`."""

HOW = f"""**z** is (here - paper)/sqrt(error here² + spread of the paper²), made smaller where the error is known from few runs: the normal deviate
as improbable as that quotient is by Student's distribution. The error here is the standard error over the runs of a case, or what the
runs say of themselves where that is larger. The paper gives no errors. Its angles are whole degrees, read by eye off a
moving surface: their spread (± in the tables) is taken as 1 degree, half a degree of which is rounding; a range as its middle and
half its width; what it calls "approximately" or "nearly" as good to a tenth. A row agrees within {AGREES:g} spreads; where the paper says no more
than "above" or "below", {BEYOND:g} spreads beyond it. Where a row does not agree, what the paper leaves unsaid is varied, one thing at a
time, below its table."""


def report(book, facts):
    """facts: lines about the machine and the program."""
    parts = [HEAD, facts, HOW, "## Summary", *summary(book)]
    for file in book.wanted:
        parts += section(book, file)
    return "\n\n".join(part for part in parts if part) + "\n"


# --- all rows at once ---

def summary(book):
    judged = [(file, verdict) for file in book.wanted for verdict in verdicts(book.study(file), book.rows(file))]
    counts = {state: sum(verdict.agrees is state for _, verdict in judged) for state in (True, False, None)}
    said = f"{len(judged)} rows of the paper: {counts[True]} agree, {counts[False]} do not, {counts[None]} were not run."
    rows = [[file, verdict.row["case"], verdict.row["what"], verdict.row["paper"], here_text(verdict), z_text(verdict.z),
             agreement(verdict)] for file, verdict in judged]
    cost = [[file, *cost_row(book.study(file))] for file in book.wanted]
    everything = [*book.studies.values(), *book.investigations.values()]
    cost += [[f"what is unsaid of {file}: {case}", *cost_row(tried)] for (file, case), tried in book.investigations.items()]
    return [said, table(["study", "case", "what", "paper", "here", "z", "agrees"], rows),
            f"What it took: {number(sum(map(work, everything)))} sphere-steps, "
            f"{duration(sum(total(one['runs'], 'results.run.wall_seconds') for one in everything))} of one processor.",
            table(["study", "runs", "sphere-steps", "processor time", "from first start to last end", "program"], cost)]


def work(collected):
    return sum((find_run(run, "steps") or 0) * (find_run(run, "spheres") or find_run(run, "particles") or 0) for run in collected["runs"])


def find_run(run, name):
    return (run["results"].get("run") or {}).get(name)


def cost_row(collected):
    if not collected:
        return ["not run", "", "", "", ""]
    done = sum(run["status"] == "successful" for run in collected["runs"])
    return [f"{done} of {len(collected['runs'])}", number(work(collected)) if work(collected) else "", duration(total(collected["runs"], "results.run.wall_seconds")),
            duration(collected["seconds"]), collected["source"]]


# --- one study ---

def section(book, file):
    collected = book.study(file)
    if not collected:
        return [f"## {file}", "Not run."]
    rows = verdicts(collected, book.rows(file))
    parts = [f"## {collected['document']['name']}", collected["document"].get("description", "")]
    if rows:
        parts.append(paper_table(rows))
    parts += SECTIONS.get(file, lambda *_: [])(book, collected)
    parts += investigations(book, file, collected)
    failed = failures(collected)
    parts += ["Runs without a result: " + listed(failed) + "."] if failed else []
    return [*parts, f"What was run (`{file}.json`), where a case does not say otherwise: {base_text(collected)}.", runs_table(collected)]


def investigations(book, file, collected):
    parts = []
    for case in cases_of(collected):
        tried = book.investigations.get((file, case))
        for row in book.rows(file) if tried else []:
            if row["case"] == case and {"value", "words"} & set(row) and judge(row, runs_of(collected, case)).agrees is False:
                parts += investigation(row, tried, runs_of(collected, case))
    return parts


def investigation(row, tried, as_studied):
    """The row under each variant, and which of them bring it to the paper's value."""
    before = judge(row, as_studied)
    judged = [(case, judge(row, runs_of(tried, case)), runs_of(tried, case)) for case in cases_of(tried)]
    rows = [["as in the study", with_error(before.here), z_text(before.z), regime_of(as_studied)]]
    rows += [[case, with_error(verdict.here), z_text(verdict.z), regime_of(runs)] for case, verdict, runs in judged]
    agrees = [case for case, verdict, _ in judged if verdict.agrees]
    said = (f"It agrees with {listed(agrees)}: what the paper leaves unsaid is enough to explain the difference." if agrees else
            "None of these changes that." if "words" in row else "None of these brings it within three spreads.")
    beyond = [case for case, verdict, _ in judged if not agrees and verdict.z is not None and verdict.z * before.z < 0]
    if beyond:
        said += f" The paper's value lies between the study's and that of {listed(beyond)}."
    return [f"**{row['case']}, {row['what']}** (paper {row['paper']}): what the paper leaves unsaid, varied.",
            table(["variant", "here", "z", "regime"], rows), said]


def regime_of(runs):
    return ", ".join(sorted({(run["results"].get("regime") or {}).get("name") or "" for run in runs}))
