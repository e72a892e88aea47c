"""Means over runs with their errors, and how far they are from what the paper says.

t = (here - paper)/sqrt(error here^2 + spread of the paper^2). The error here is the standard error over the runs, or
what the runs themselves say of their angles where that is larger. An error from three numbers is often far too small by
chance, so t follows Student's distribution with as many degrees of freedom as the errors have (Welch 1947); z is the
normal deviate that is as improbable.
"""
import math

AGREES = 3.0  # spreads
BEYOND = 2.0  # spreads, where the paper says only above or below


class Mean:
    """freedom: degrees of freedom of the error; infinite where runs said it themselves."""

    def __init__(self, value, error, count, freedom=math.inf):
        self.value, self.error, self.count, self.freedom = value, error, count, freedom


def find(run, path):
    """run["results"]["repose"]["angle_deg"] for "results.repose.angle_deg"; None where it leads nowhere or is null."""
    for name in path.split("."):
        run = run.get(name) if isinstance(run, dict) else None
    return run


def error_path(path):
    """Where a run says its own error of that number; None: nowhere."""
    place, _, name = path.rpartition(".")
    if name in ("angle_deg",):
        return f"{place}.standard_error_deg"
    if place.endswith("other_methods"):
        return f"{place}_standard_error_deg.{name}"
    if name == "minimum_omega2":
        return f"{place}.error"
    if name.endswith("_deg"):
        return f"{place}.{name[:-4]}_standard_error_deg"
    return f"{path}_standard_error"


def mean(runs, path):
    """None where no run has that number."""
    values = [value for value in (find(run, path) for run in runs) if isinstance(value, (int, float)) and not isinstance(value, bool)]
    if not values:
        return None
    own = [error for error in (find(run, error_path(path)) for run in runs) if isinstance(error, (int, float))]
    n, middle = len(values), sum(values) / len(values)
    among = math.sqrt(sum((value - middle) ** 2 for value in values) / (n - 1) / n) if n > 1 else None
    told = math.sqrt(sum(error**2 for error in own)) / n if len(own) == n else None
    if among is not None and (told is None or among > told):
        return Mean(middle, among, n, n - 1)
    return Mean(middle, told, n)


def improbability(t, freedom):
    """How often a number of Student's distribution is further from zero than t."""
    if freedom > 300:
        return math.erfc(abs(t) / math.sqrt(2.0))
    scale = 2.0 / math.sqrt(math.pi) * math.exp(math.lgamma((freedom + 1) / 2) - math.lgamma(freedom / 2))
    start, parts = math.atan(abs(t) / math.sqrt(freedom)), 1000
    width = (math.pi / 2 - start) / parts
    # the middle rule, of the density in theta = atan(t/sqrt(freedom)): cos^(freedom - 1)
    return scale * width * sum(math.cos(start + (k + 0.5) * width) ** (freedom - 1) for k in range(parts))


def deviate(t, freedom):
    """The normal deviate as improbable as t, on t's side."""
    wanted, low, high = improbability(t, freedom), 0.0, 37.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if math.erfc(middle / math.sqrt(2.0)) > wanted else (low, middle)
    return math.copysign(low, t)


def combined_freedom(one, other):
    """Welch's, for the sum of two squared errors given as (error, degrees of freedom)."""
    parts = sum(error**4 / freedom for error, freedom in (one, other) if error)
    return (one[0] ** 2 + other[0] ** 2) ** 2 / parts if parts > 0.0 else math.inf


def z_of(here, value, spread=0.0):
    """None where neither side has a spread."""
    error, spread = here.error or 0.0, spread or 0.0
    both = math.hypot(error, spread)
    return deviate((here.value - value) / both, combined_freedom((error, here.freedom), (spread, math.inf))) if both > 0.0 else None


def difference(one, other):
    a, b = one.error or 0.0, other.error or 0.0
    return Mean(one.value - other.value, math.hypot(a, b), min(one.count, other.count), combined_freedom((a, one.freedom), (b, other.freedom)))


def furthest_apart(means):
    """(z, name, name) of the two of {name: Mean} that differ most for their errors; None for fewer than two."""
    names, worst = list(means), None
    for i, one in enumerate(names):
        for other in names[i + 1:]:
            z = z_of(difference(means[one], means[other]), 0.0)
            if z is not None and (worst is None or abs(z) > abs(worst[0])):
                worst = (z, one, other)
    return worst


class Verdict:
    """A row of the paper beside the runs: here is a Mean or a text, z may be None, agrees None where nothing was run."""

    def __init__(self, row, here, z, agrees, runs=0):
        self.row, self.here, self.z, self.agrees, self.runs = row, here, z, agrees, runs


def judge(row, runs):
    """row: an entry of paper.json."""
    if not runs:
        return Verdict(row, None, None, None)
    if "words" in row:
        said = [find(run, row["measure"]) for run in runs]
        names = sorted({str(name) for name in said})
        text = ", ".join(name if len(names) == 1 else f"{name} {said.count(name)}" for name in names)
        return Verdict(row, text, None, all(name in row["words"] for name in said))
    here = mean(runs, row["measure"])
    if here is not None and "less" in row:
        other = mean(runs, row["less"])
        here = difference(here, other) if other else None
    if here is None:
        return Verdict(row, f"none in {len(runs)} run{'s' if len(runs) > 1 else ''}", None, False)
    if "value" in row:
        z = z_of(here, row["value"], row.get("spread"))
        return Verdict(row, here, z, here.value == row["value"] if z is None else abs(z) <= AGREES, len(runs))
    if "within" in row:
        return Verdict(row, here, None, abs(here.value) < row["within"], len(runs))
    bound, sign = (row["above"], 1.0) if "above" in row else (row["below"], -1.0)
    z = z_of(here, bound, row.get("spread"))
    return Verdict(row, here, z, sign * (here.value - bound) > 0.0 if z is None else sign * z > BEYOND, len(runs))
