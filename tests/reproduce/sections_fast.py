"""What is said of centrifuging drums and of the single particle."""
import math

import pictures
import plots
from collecting import cases_of, runs_of
from comparing import find, mean
from markdown import listed, number, table, with_error

ANGLE = "results.repose.angle_deg"


def figure5(book, collected):
    runs = runs_of(collected, "Omega_i = 1")
    if not runs:
        return []
    drawn = pictures.drum(book.snapshots(runs[0]), runs[0], book.pictures, "figure5", with_angle=False)
    evidence = "results.regime.evidence"
    facts = [("share of particles in flight", mean(runs, f"{evidence}.airborne_fraction")),
             ("share of the wall with particles against it", mean(runs, f"{evidence}.wall_coverage")),
             ("slip on the wall", mean(runs, f"{evidence}.wall_slip"))]
    return [drawn, table(["", "over the measuring window"], [[name, with_error(one)] for name, one in facts if one])]


def figure7(book, collected):
    runs = runs_of(collected, "Omega_i^2 = 2.2")
    if not runs:
        return []
    drawn = " ".join(pictures.drum(book.snapshots(runs[0]), runs[0], book.pictures, f"figure7-{name}", at(runs[0], turns), with_angle=False)
                     for name, turns in (("a", 5.5), ("b", 14.0)))
    series = {f"seed {run['seed']}": [[r, 100 * share] for r, share in run["derived"]["loose"]] for run in runs if "loose" in run["derived"]}
    said = [drawn.strip()]
    if series:
        said.append(plots.lines(book.pictures, "figure7-loose", "Loose particles over revolutions", series, "revolutions", "loose particles, %"))
        rows = [[run["seed"], cleared(run, "cleared_1_percent"), cleared(run, "cleared_1_in_1000")] for run in runs]
        said.append("Loose is what is more than two diameters nearer the axis than the inner surface of a bed spread evenly. Revolutions from which on")
        said.append(table(["seed", "at most 1 % are loose", "at most 1 in 1000"], rows))
    lag = mean(runs, "results.regime.evidence.surface_lag")
    if lag:
        said.append(f"The inner surface slips by {with_error(lag)} rad a revolution.")
    return said


def at(run, turns):
    """Number of the snapshot nearest to so many revolutions: they are evenly spaced."""
    total = run["inputs"]["drum"]["rotation_rate"] * find(run, "results.run.simulated_seconds") / (2 * math.pi)
    last = len(run["snapshots"]) - 1
    return max(0, min(last, round(turns / total * last))) if total else -1


def cleared(run, name):
    value = run["derived"].get(name)
    return "not within the run" if value is None else number(value)


# --- Figure 8 ---

def friction_of(run):
    return run["inputs"].get("friction") or run["inputs"]["contact"]["friction"]


def figure8(book, collected):
    """Single particles beside the paper's fits; the map with beds, where these were run."""
    runs = [run for case in cases_of(collected) for run in runs_of(collected, case)]
    rows, off = [], {"sliding_eq34": [], "sliding_eq36": []}
    for run in runs:
        granule = run["results"]["granule"]
        here, fits = granule["minimum_omega2"], granule["fits"]
        for name in off:
            off[name].append((friction_of(run), fits[name] / here - 1.0))
        rows.append([f"{friction_of(run):g}", number(here, 5), *(f"{fits[name]:.4f} ({100 * (fits[name] / here - 1):+.1f} %)" for name in off),
                     number(fits["stationary_eq33"], 5), number(granule["slip_per_revolution"])])
    if not rows:
        return []
    heads = ["friction", "least Omega² here", "paper's fit, Eqn 34", "Eqns 36-37", "no slip at all, Eqn 33", "slip there, rad a revolution"]
    return [table(heads, rows), fit_words(off), slip_words(runs), the_map(book, runs)]


def fit_words(off):
    size = {name: math.sqrt(sum(d * d for mu, d in values if mu >= 0.2) / max(1, sum(mu >= 0.2 for mu, _ in values)))
            for name, values in off.items()}
    lowest = {name: min(values) for name, values in off.items()}
    mu = lowest["sliding_eq34"][0]
    alike = "as the paper says of them" if max(size.values()) < 0.03 else "worse than the paper lets expect"
    return (f"From friction 0.2 on the fits are off by {100 * size['sliding_eq34']:.1f} % (Eqn 34) and {100 * size['sliding_eq36']:.1f} % (Eqns 36-37), "
            f"root mean square: {alike}. At friction {mu:g}, the last point on the right of the paper's figure, they are off by "
            f"{100 * lowest['sliding_eq34'][1]:+.1f} % and {100 * lowest['sliding_eq36'][1]:+.1f} %.")


def slip_words(runs):
    slips = [(run["results"]["granule"]["slip_per_revolution"], friction_of(run)) for run in runs]
    (least, rough), (most, smooth) = min(slips), max(slips)
    return (f"A particle at its boundary slips {number(least)} rad a revolution at friction {rough:g} and {number(most)} at friction "
            f"{smooth:g}; the paper: \"as much as 1/8 radian\".")


def angles_by_friction(book):
    """{friction: angle of repose in degrees}, from Table 1's rows of spheres at pi/2 rad/s."""
    angles = {}
    for run in (book.study("table1") or {"runs": []})["runs"]:
        inputs = run["inputs"]
        if run["status"] == "successful" and len(inputs["particles"]) == 1 and inputs["particles"][0]["shape"] == "sphere" \
                and inputs["drum"]["rotation_rate"] < 2.0:
            angles.setdefault(inputs["contact"]["friction"], []).append(run)
    return {friction: one.value for friction, one in ((f, mean(runs, ANGLE)) for f, runs in angles.items()) if one}


def papers_angle(book, friction):
    named = f"mu {friction:g}, pi/2 rad/s"
    return next((row["value"] for row in book.rows("table1") if row["case"] == named and "value" in row), None)


def steepness(book, friction):
    """1/sin of the angle of repose of such spheres: measured here, else the paper's of Table 1."""
    angle = angles_by_friction(book).get(friction, papers_angle(book, friction))
    return None if angle is None else 1.0 / math.sin(math.radians(angle))


def bed_points(book):
    points = []
    for run in (book.study("figure8-beds") or {"runs": []})["runs"]:
        x = steepness(book, friction_of(run)) if run["status"] == "successful" else None
        if x:
            points.append((x, run["results"]["regime"]["omega2_inner"], str(run["results"]["regime"]["name"]), friction_of(run), run))
    return points


def the_map(book, grains):
    singles = [(1.0 / math.sin(math.atan(friction_of(run))), run["results"]["granule"]["minimum_omega2"]) for run in grains]
    marks = [(1.0 / math.sin(math.radians(25.0)), 2.2, "the paper's Figure 7")]
    return plots.figure8(book.pictures, singles, [point[:3] for point in bed_points(book)], marks)


def figure8_beds(book, collected):
    """The map as a table, and each friction's boundaries beside the predictions."""
    points = bed_points(book)
    if not points:
        return []
    frictions = sorted({point[3] for point in points})
    rows, words = [], []
    for friction in frictions:
        mine = sorted(((point[1], point[2], point[4]) for point in points if point[3] == friction), key=lambda one: one[0])
        rows += [[f"{friction:g}", number(omega2), regime, number(find(run, "results.regime.evidence.fallen_fraction")),
                  number(find(run, "results.regime.evidence.surface_lag"))] for omega2, regime, run in mine]
        words.append(boundary_row(friction, steepness(book, friction), mine))
    heads = ["friction", "1/sin of its angle of repose", "Eqn 35", "Eqns 36-37", "raining ends here between", "Eqn 33", "stationary here from"]
    return [table(["friction", "Omega_i²", "regime", "fallen", "lag, rad a revolution"], rows), table(heads, words), side_words(points)]


def between(mine, names):
    """"2.2 and 2.6": the last rate whose regime is among names, and the next."""
    inside = [omega2 for omega2, regime, _ in mine if regime in names]
    if not inside:
        return "below all"
    above = [omega2 for omega2, _, _ in mine if omega2 > max(inside)]
    return f"{number(max(inside))} and {number(min(above))}" if above else f"above {number(max(inside))}"


def boundary_row(friction, x, mine):
    stationary = [omega2 for omega2, regime, _ in mine if regime == "centrifuging"]
    return [f"{friction:g}", number(x), number(float(plots.eq35(x))), number(float(plots.eq36(x))), between(mine, FALLING), number(x),
            number(min(stationary)) if stationary else "none of these"]


FALLING = ("slipping", "slumping", "avalanching", "rolling", "cascading", "cataracting", "raining")


def expected(x, omega2):
    """Regimes that the paper's boundaries name at that place of the map."""
    if omega2 > plots.eq33(x):
        return ("centrifuging",)
    return ("sliding",) if omega2 > plots.eq35(x) else FALLING


def side_words(points):
    right = [point for point in points if point[2] in expected(point[0], point[1])]
    wrong = [f"friction {p[3]:g} at {number(p[1])} ({p[2]})" for p in points if p not in right]
    said = f"{len(right)} of {len(points)} beds do what Eqns 33 and 35 say of their place on the map."
    return said + (f" Not so: {listed(wrong)}. Each started from rest." if wrong else "")
