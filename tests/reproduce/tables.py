"""The tables that every study has: the paper beside the runs, and what was run."""
from collecting import cases_of, runs_of
from comparing import Mean, find, judge, mean
from markdown import number, table, with_error, z_text


def verdicts(collected, rows):
    return [judge(row, runs_of(collected, row["case"]) if collected else []) for row in rows]


def here_text(verdict):
    """Says so where only some runs have that number."""
    few = isinstance(verdict.here, Mean) and verdict.here.count < verdict.runs
    return with_error(verdict.here) + (f" ({verdict.here.count} of {verdict.runs} runs)" if few else "")


def agreement(verdict):
    return {None: "not run", True: "yes", False: "**no**"}[verdict.agrees]


def paper_table(judged):
    """paper | here +- standard error | z"""
    return table(["case", "what", "paper", "here", "z", "agrees"],
                 [[verdict.row["case"], verdict.row["what"], spread_text(verdict.row), here_text(verdict), z_text(verdict.z),
                   agreement(verdict)] for verdict in judged])


def spread_text(row):
    return f"{row['paper']} (± {row['spread']:g})" if "spread" in row else row["paper"]


def total(runs, path):
    return sum(value for value in (find(run, path) for run in runs) if isinstance(value, (int, float)))


def span(runs, path, scale=1.0, digits=2):
    """"12", or "9 to 12" where the runs differ."""
    values = [scale * value for value in (find(run, path) for run in runs) if isinstance(value, (int, float))]
    if not values:
        return ""
    low, high = number(min(values), digits), number(max(values), digits)
    return low if low == high else f"{low} to {high}"


def run_row(collected, case):
    runs = runs_of(collected, case)
    return [case, f"{len(runs)} of {sum(run['case'] == case for run in collected['runs'])}", span(runs, "results.run.particles", digits=6),
            span(runs, "results.run.steps", digits=3), span(runs, "results.run.stiffness", digits=3),
            span(runs, "results.run.maximum_overlap", 100.0), span(runs, "results.run.wall_seconds", digits=3)]


def runs_table(collected):
    """Inputs that matter are in the study's file; this is what they came to."""
    return table(["case", "runs", "particles", "steps", "K1, N/m", "largest overlap, %", "wall time of a run, s"],
                 [run_row(collected, case) for case in cases_of(collected)])


def angle_table(collected, cases, paper=None):
    """An angle by every definition: it is not said which the paper used."""
    methods = ["center-of-mass", "chord", "theil-sen", "upper-chord", "lower-chord"]
    rows = []
    for case in cases:
        runs = runs_of(collected, case)
        angles = [mean(runs, "results.repose.angle_deg")] + [mean(runs, f"results.repose.other_methods.{name}") for name in methods]
        rows.append([case, (paper or {}).get(case, ""), *("" if angle is None else with_error(angle) for angle in angles)])
    return table(["case", "paper", "surface-fit", *methods], rows)


UNIMPORTANT = ("seed", "threads", "snapshots", "samples")


def leaves(value, name=""):
    """("drum/diameter", 0.126), ... for each number and word in it."""
    if isinstance(value, (dict, list)):
        members = value.items() if isinstance(value, dict) else enumerate(value)
        return [leaf for key, member in members if key not in UNIMPORTANT for leaf in leaves(member, f"{name}/{key}" if name else str(key))]
    return [(name, f"{value:.5g}" if isinstance(value, float) else str(value))]


def base_text(collected):
    """What all cases share, but for what a case says otherwise: the units are SI."""
    return ", ".join(f"{name} {value}" for name, value in leaves(collected["document"]["base"]["inputs"]))


def failures(collected):
    return [f"{run['case']}, seed {run['seed']}: {run['status']}, {run['message']}" for run in collected["runs"]
            if run["status"] != "successful"]
