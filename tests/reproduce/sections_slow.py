"""What is said of slow drums beyond their tables. Words are chosen by the numbers; nothing is said that was not run."""
import math

import pictures
import plots
from collecting import cases_of, runs_of
from comparing import AGREES, difference, find, furthest_apart, mean, z_of
from markdown import listed, number, table, with_error, z_text
from tables import angle_table

ANGLE = "results.repose.angle_deg"
DEFINITIONS = {"surface-fit": ANGLE, **{name: f"results.repose.other_methods.{name}" for name in ("center-of-mass", "chord", "theil-sen")}}


def regimes(runs):
    return listed(sorted({str(find(run, "results.regime.name")) for run in runs}))


# --- Table 1 ---

def nearest_definition(book, file):
    """Which definition of the angle is nearest to the paper over the rows that have an angle of repose."""
    worst = []
    for name, path in DEFINITIONS.items():
        path_of = [(row, mean(book.runs(file, row["case"]), path)) for row in book.rows(file) if row.get("measure") == ANGLE]
        zs = [z_of(here, row["value"], row["spread"]) for row, here in path_of if here]
        if zs:
            worst.append((math.sqrt(sum(z * z for z in zs) / len(zs)), name))
    if not worst:
        return ""
    ranking = ", ".join(f"{name} {size:.1f}" for size, name in sorted(worst))
    return f"The paper does not say how it measured angles. Root mean square of z by definition: {ranking}."


def unsteady_rows(book, collected):
    """What a bed without a steady angle does: a mean alone would hide it."""
    told = []
    for case in cases_of(collected):
        runs = runs_of(collected, case)
        if not runs or all(find(run, "results.repose.steady") for run in runs):
            continue
        low, high = mean(runs, "results.repose.minimum_deg"), mean(runs, "results.repose.maximum_deg")
        told.append([case, regimes(runs), with_error(low), with_error(high), *slumping(runs)])
    if not told:
        return ""
    heads = ["case without a steady angle", "regime", "lowest frame", "highest frame", "slumps a run", "period, s", "from, degrees", "to, degrees"]
    return table(heads, told)


def slumping(runs):
    """Numbers of its falls: of the direction of the centre of mass, which a block's surface follows."""
    return [with_error(here) if here else "" for here in (mean(runs, f"results.repose.slumps.{name}") for name in
            ("count", "period", "start_deg", "stop_deg"))]


def angle_plot(book, collected, name, cases):
    series = {}
    for case in cases:
        runs = runs_of(collected, case)
        if runs and runs[0]["derived"].get("angles"):
            series[case] = runs[0]["derived"]["angles"]
    if not series:
        return ""
    return plots.lines(book.pictures, name, "Direction of the centre of mass over time", series, "time from the start of rotation, s",
                       "direction of the centre of mass, degrees")


def table1(book, collected):
    paper = {row["case"]: row["paper"] for row in book.rows("table1") if "value" in row}
    cases = cases_of(collected)
    return ["By every definition, in degrees:", angle_table(collected, cases, paper), nearest_definition(book, "table1"),
            unsteady_rows(book, collected), angle_plot(book, collected, "table1-angles", cases[:3])]


# --- pictures and segregation ---

def figure3(book, collected):
    runs = runs_of(collected, "one revolution")
    if not runs:
        return []
    start, end = mean(runs, "derived.radial_start"), mean(runs, "derived.radial_end")
    drawn = [pictures.drum(book.snapshots(runs[0]), runs[0], book.pictures, f"figure3-{name}", number, "species", False)
             for name, number in (("start", 0), ("end", -1))]
    said = [" ".join(drawn).strip()]
    if start and end:
        said.append(f"Mean distance from the axis, large less small over the drum's radius: {with_error(start)} at the start, "
                    f"{with_error(end)} after one revolution.")
    return said


def figure4(book, collected):
    cubes, spheres = runs_of(collected, "cubes"), runs_of(collected, "spheres")
    said = []
    if cubes:
        said.append(pictures.drum(book.snapshots(cubes[0]), cubes[0], book.pictures, "figure4"))
        angles = [find(cubes[0], path) for path in DEFINITIONS.values()]
        angles = [angle for angle in angles if angle is not None]
        if angles:
            said.append(f"Definitions of the angle differ by {max(angles) - min(angles):.1f} degrees for cubes, frames by "
                        f"{find(cubes[0], 'results.repose.maximum_deg') - find(cubes[0], 'results.repose.minimum_deg'):.1f}.")
    said.append(angle_table(collected, cases_of(collected)))
    if cubes and spheres:
        rough, smooth = (find(runs[0], "results.repose.interface_fluctuation") for runs in (cubes, spheres))
        if rough and smooth:
            said.append(f"The surface of cubes rises and falls by {1e3 * rough:.2f} mm (standard deviation in time), that of spheres by "
                        f"{1e3 * smooth:.2f} mm: {rough / smooth:.1f} times.")
    return said


# --- rates, walls, laws, sizes ---

def rotation_rate(book, collected):
    cases = [case for case in cases_of(collected) if runs_of(collected, case)]
    angles = {case: mean(runs_of(collected, case), ANGLE) for case in cases}
    steady = [case for case in cases if regimes(runs_of(collected, case)) in ("rolling", "cascading")]
    bends = {case: mean(runs_of(collected, case), "results.regime.evidence.curvature_deg") for case in cases}
    falls = {case: mean(runs_of(collected, case), "results.repose.slumps.size_deg") for case in cases}
    rows = [[case, *(with_error(one) if one else "" for one in (angles[case], bends[case], falls[case])), regimes(runs_of(collected, case))]
            for case in cases]
    said = [table(["rate", "angle, degrees", "upper half steeper by, degrees", "falls by, degrees", "regime"], rows),
            "LAMMPS finds the same at these rates: spheres that roll at pi/8 rad/s, and at pi/32 rad/s avalanches that fall by 4.6 degrees."]
    if steady:
        said.append(f"The slowest of these rates at which the bed flows steadily in every run is {steady[0]}; the paper's threshold is "
                    "approximately pi/2 rad/s.")
    climbs = [(one, other, difference(angles[other], angles[one])) for one, other in zip(steady, steady[1:])
              if angles[one] and angles[other]]
    if climbs:
        text = ", ".join(f"{with_error(step)} from {one} to {other}" for one, other, step in climbs)
        grows = all(step.value > 0 for _, _, step in climbs)
        said.append(f"From the threshold on the angle {'grows with the rate, as in the paper' if grows else 'does not grow at every step'}: {text}.")
    return said


def wall_friction(book, collected):
    runs = [run for run in collected["runs"] if run["status"] == "successful"]
    if not runs:
        return []
    slumps = sum(find(run, "results.regime.name") == "slumping" for run in runs)
    return [f"{slumps} of {len(runs)} runs slump.", unsteady_rows(book, collected)]


def equivalence(means, what):
    """Words for a claim that several numbers are alike."""
    worst = furthest_apart(means)
    if not worst:
        return f"{what}: too few numbers to compare."
    z, one, other = worst
    apart = difference(means[one], means[other])
    if abs(z) < AGREES:
        return f"{what}: substantially equivalent; no two differ by more than {abs(z):.1f} spreads ({one} less {other}: {with_error(apart)})."
    return f"{what}: not equivalent; {one} less {other} is {with_error(apart)}, {abs(z):.1f} spreads."


def force_models(book, collected):
    by_friction = {}
    for run in collected["runs"]:
        if run["status"] == "successful":
            contact = run["inputs"]["contact"]
            by_friction.setdefault(contact["friction"], {}).setdefault(contact["law"], []).append(run)
    rows, said = [], []
    for friction, laws in by_friction.items():
        rows += [[f"{friction:g}", law, *(with_error(mean(runs, path)) for path in DEFINITIONS.values())] for law, runs in laws.items()]
        for name in ("surface-fit", "center-of-mass"):
            means = {law: mean(runs, DEFINITIONS[name]) for law, runs in laws.items()}
            said.append(equivalence({law: one for law, one in means.items() if one}, f"Friction {friction:g}, angle by {name}"))
    return [table(["friction", "law", *DEFINITIONS], rows), *said] if rows else []


def size_scaling(book, collected):
    means, rows = {}, []
    for case in cases_of(collected):
        runs = runs_of(collected, case)
        numbers = [mean(runs, f"derived.radial_{name}") for name in ("start", "end", "change")]
        rows.append([case, *(with_error(one) for one in numbers)])
        if numbers[2]:
            means[case] = numbers[2]
    said = [table(["drum", "radial index at the start", "after one revolution", "growth"], rows)]
    if means:
        z = {case: z_of(one, 0.0) for case, one in means.items()}
        grown = [case for case in means if means[case].value > 0 and (z[case] is None or z[case] > AGREES)]
        said.append("Large spheres move outward in every drum, as in the paper." if len(grown) == len(means) else
                    f"Large spheres move outward beyond doubt in {listed(grown) if grown else 'none'} only.")
        said.append(equivalence(means, "Growth of the radial index in the three drums, a share of each drum's radius"))
    return said


# --- along the axis ---

def axial_series(runs, length):
    """[[z, share, error by chance], ...] of the first run."""
    derived = runs[0]["derived"]
    share, count, p = derived["axial_share"], derived["axial_count"], derived["axial_mean"]
    width = length / len(share)
    return [[1e3 * (-length / 2 + (k + 0.5) * width), s, math.sqrt(p * (1 - p) / max(n, 1))] for k, (s, n) in enumerate(zip(share, count))]


def axial(book, collected):
    rows, series, excess = [], {}, {}
    for case in cases_of(collected):
        runs = [run for run in runs_of(collected, case) if "axial_excess" in run["derived"]]
        if not runs:
            continue
        excess[case] = mean(runs, "derived.axial_excess")
        series[case] = axial_series(runs, runs[0]["inputs"]["drum"]["length"])
        rows.append([case, with_error(excess[case]), with_error(mean(runs, "results.segregation.axial_index")),
                     with_error(mean(runs, "derived.axial_ends"))])
    if not rows:
        return []
    said = [table(["ends", "unlike random, in its standard deviations", "axial index, over the measuring window",
                   "share of the large in the end slices less the mean"], rows),
            plots.lines(book.pictures, collected["file"], "Share of the large spheres along the axis", series, "z, mm",
                        "share of the large by number", 0.5)]
    return said + [axial_words(case, one, revolutions(runs_of(collected, case)[0])) for case, one in excess.items()]


def revolutions(run):
    return run["inputs"]["drum"]["rotation_rate"] * find(run, "results.run.simulated_seconds") / (2.0 * math.pi)


def axial_words(case, excess, turns):
    """By chance alone the number is 0 +- 1 in each run, so 1/sqrt(runs) for their mean."""
    z = excess.value * math.sqrt(excess.count)
    if abs(z) < AGREES:
        return f"With {case} there is no axial segregation after {turns:.3g} revolutions: slices differ as a random mixture's do ({z_text(z)} spreads)."
    if z < 0:
        return f"With {case} slices differ less than a random mixture's do ({z_text(z)} spreads): no stripes."
    return f"With {case} there is axial segregation after {turns:.3g} revolutions: slices differ more than a random mixture's do ({z_text(z)} spreads)."
