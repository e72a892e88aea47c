"""What is said of flows through an orifice: Beverloo's law over orifice diameters."""
import math

from collecting import cases_of, runs_of
from comparing import mean
from markdown import number, table, with_error

RATE = "results.flow.mass_rate"
K = 1.4  # of spheres, by Beverloo et al.


def line(xs, ys, errors):
    """Least squares of y = a + b x, weighted by the errors: a, b and their errors."""
    weights = [1.0 / error**2 for error in errors]
    total, x, y = sum(weights), sum(w * x for w, x in zip(weights, xs)), sum(w * y for w, y in zip(weights, ys))
    xx, xy = sum(w * x * x for w, x in zip(weights, xs)), sum(w * x * y for w, x, y in zip(weights, xs, ys))
    spread = total * xx - x * x
    return (xx * y - x * xy) / spread, (total * xy - x * y) / spread, math.sqrt(xx / spread), math.sqrt(total / spread)


def exponent(widths, rates, grain, k=K):
    """Of W over D - k d, with its error. widths: m; rates: (kg/s, error)."""
    xs = [math.log(width - k * grain) for width in widths]
    _, slope, _, error = line(xs, [math.log(rate) for rate, _ in rates], [error / rate for rate, error in rates])
    return slope, error


def constants(widths, rates, grain, bulk, gravity=9.81):
    """C and k for an exponent of 5/2, from the line of W^(2/5) over D."""
    ys = [rate**0.4 for rate, _ in rates]
    offset, slope, *_ = line(widths, ys, [0.4 * error / rate * y for (rate, error), y in zip(rates, ys)])
    return slope**2.5 / (bulk * math.sqrt(gravity)), -offset / (slope * grain)


def beverloo(book, collected):
    rows, widths, rates, solids = [], [], [], []
    for case in cases_of(collected):
        runs = runs_of(collected, case)
        rate, solid = mean(runs, RATE), mean(runs, "results.packing.solid_fraction")
        rows.append([case, *(with_error(one) if one else "" for one in (rate, solid, mean(runs, "results.outlet.velocity")))])
        if rate and rate.error and solid:
            widths.append(runs[0]["inputs"]["orifice"]["diameter"])
            rates.append((rate.value, rate.error))
            solids.append(solid.value)
    said = [table(["case", "mass flow, kg/s", "solid fraction before", "velocity at the orifice, m/s"], rows)]
    if len(rates) > 2:
        particle = collected["runs"][0]["inputs"]["particles"][0]
        slope, error = exponent(widths, rates, particle["diameter"])
        c, k = constants(widths, rates, particle["diameter"], particle["density"] * sum(solids) / len(solids))
        said.append(f"Exponent of D - {K:g} d: {slope:.2f} ± {error:.2f}, where Beverloo's law has 2.5. With 2.5 given: C {number(c)}, k {number(k)}.")
    return said
