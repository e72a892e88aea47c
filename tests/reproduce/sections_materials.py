"""What is said of materials: cohesion, sizes, laws of rolling friction, and which test tells friction from rolling friction."""
import numpy as np
import pictures
import plots
from collecting import cases_of, runs_of
from comparing import find, mean
from markdown import number, table, with_error

ANGLE = "results.repose.angle_deg"
RATE = "results.flow.mass_rate"
DYNAMIC, STATIC = "results.repose.dynamic_cohesive_index", "results.surface.static_cohesive_index"
TENSION = "results.packing.tension_share"


def text(one, factor=1):
    if one is None:
        return ""
    return with_error(type(one)(factor * one.value, factor * one.error if one.error else one.error, one.count, one.freedom))


def bond_number(runs):
    return find(runs[0], "results.run.bond_number") or 0.0


def words(runs, path):
    return ", ".join(sorted({find(run, path) or "" for run in runs}))


def over_bond_numbers(book, collected, index, title):
    rows, angles, indices = [], [], []
    for case in cases_of(collected):
        runs = runs_of(collected, case)
        if not runs:
            continue
        angle, swing = mean(runs, ANGLE), mean(runs, index)
        rows.append([f"{bond_number(runs):g}", text(angle), text(swing, 1e6), text(mean(runs, TENSION), 100), words(runs, "results.regime.name")])
        if angle and swing:
            angles.append([bond_number(runs), angle.value, angle.error or 0])
            indices.append([bond_number(runs), 1e6 * swing.value, 1e6 * (swing.error or 0)])
    said = [table(["Bond number", "angle, degrees", f"{title}, µm", "contacts in tension, %", "regime"], rows)]
    if len(angles) > 1:
        name = collected["file"]
        said.append(" ".join([plots.lines(book.pictures, f"{name}-angle", "Angle over Bond number", {"angle": angles}, "Bond number", "degrees"),
                              plots.lines(book.pictures, f"{name}-index", f"{title} over Bond number", {title: indices}, "Bond number", "µm")]))
        said.append(f"From none to the most cohesion the angle changes by {angles[-1][1] - angles[0][1]:+.1f} degrees, the {title} by a factor of "
                    f"{number(indices[-1][1] / indices[0][1])}.")
    return said


def cohesion(book, collected):
    drawn = [pictures.drum(book.snapshots(run), run, book.pictures, f"{collected['file']}-{run['case']}".replace(" ", "-"))
             for case in cases_of(collected) for run in runs_of(collected, case)[:1] if run["snapshots"]]
    return [" ".join(drawn).strip(), *over_bond_numbers(book, collected, DYNAMIC, "dynamic cohesive index")]


def cohesion_heap(book, collected):
    return over_bond_numbers(book, collected, STATIC, "static cohesive index")


def sizes(book, collected):
    rows = []
    for case in cases_of(collected):
        runs = runs_of(collected, case)
        d10, d90 = (mean(runs, f"results.run.sizes.{name}") for name in ("d10", "d90"))
        rows.append([case, text(d10, 1e3), text(d90, 1e3), text(mean(runs, ANGLE)), text(mean(runs, "results.segregation.radial_index")),
                     text(mean(runs, "results.segregation.lacey_index"))])
    return [table(["case", "D10, mm", "D90, mm", "angle, degrees", "radial segregation", "Lacey's index"], rows),
            "Radial segregation is the mean distance from the axis of the third of the largest less that of the smallest, over the drum's radius."]


def by_inputs(collected, *paths):
    """{(values of these inputs): runs}, in order."""
    found = {}
    for run in collected["runs"]:
        if run["status"] == "successful":
            found.setdefault(tuple(find(run, path) for path in paths), []).append(run)
    return found


FRICTION, ROLLING = "inputs.contact.friction", "inputs.contact.rolling_friction"


def rolling(book, collected):
    found = by_inputs(collected, "inputs.contact.rolling_law", ROLLING)
    laws, frictions = (list(dict.fromkeys(key[k] for key in found)) for k in (0, 1))
    angles = {key: mean(runs, ANGLE) for key, runs in found.items()}
    rows = [[f"{one:g}", *(text(angles.get((law, one))) for law in laws)] for one in frictions]
    series = {law: [[one, angles[law, one].value, angles[law, one].error or 0] for one in frictions if angles.get((law, one))] for law in laws}
    said = [table(["rolling friction", *(f"{law}, degrees" for law in laws)], rows)]
    if all(len(points) > 1 for points in series.values()) and series:
        said.append(plots.lines(book.pictures, collected["file"], "Angle over rolling friction", series, "rolling friction", "degrees"))
    return said


def plane(found, path):
    """Slopes of the mean over friction and over rolling friction, by least squares, and what is left: their errors, too."""
    seen = [(key, mean(runs, path)) for key, runs in found.items()]
    seen = [(key, one.value) for key, one in seen if one]
    if len(seen) < 4:
        return None
    columns = np.array([[1.0, *key] for key, _ in seen])
    values = np.array([value for _, value in seen])
    solved, *_ = np.linalg.lstsq(columns, values, rcond=None)
    left = float(np.sum((values - columns @ solved) ** 2) / (len(seen) - 3))
    errors = np.sqrt(left * np.diag(np.linalg.inv(columns.T @ columns)))
    return solved[1:], errors[1:], left**0.5


def drum_map(book, collected):
    rows = [[f"{mu:g}", f"{mu_r:g}", text(mean(runs, ANGLE))] for (mu, mu_r), runs in by_inputs(collected, FRICTION, ROLLING).items()]
    return [table(["friction", "rolling friction", "angle, degrees"], rows)]


def has_clogged(run):
    return find(run, "results.flow.clogged") is True


def flow_map(book, collected):
    """Both halves: the drum's study stands before the flow's. A run that clogged has no steady flow, and is counted instead."""
    drum = book.study("materials-map-drum")
    tried, drums = by_inputs(collected, FRICTION, ROLLING), by_inputs(drum, FRICTION, ROLLING) if drum else {}
    flows = {key: [run for run in runs if not has_clogged(run)] for key, runs in tried.items()}
    rows = [[f"{mu:g}", f"{mu_r:g}", text(mean(drums.get((mu, mu_r), []), ANGLE)), text(mean(flows[mu, mu_r], RATE), 1e3),
             f"{sum(map(has_clogged, runs))} of {len(runs)}"] for (mu, mu_r), runs in tried.items()]
    said = [table(["friction", "rolling friction", "angle of the drum, degrees", "mass flow, g/s", "runs that clogged"], rows)]
    of_drum, of_flow = plane(drums, ANGLE), plane(flows, RATE)
    if not of_drum or not of_flow:
        return said
    (a, b), (a_error, b_error), _ = of_drum
    (c, d), (c_error, d_error), left = of_flow
    said.append(f"Planes through them by least squares: the angle changes by {0.1 * a:+.2f} ± {0.1 * a_error:.2f} degrees for 0.1 more of friction "
                f"and by {0.1 * b:+.2f} ± {0.1 * b_error:.2f} for 0.1 more of rolling friction; the flow by {100 * c:+.2f} ± {100 * c_error:.2f} "
                f"and {100 * d:+.2f} ± {100 * d_error:.2f} g/s.")
    if abs(b) > 0 and left > 0:
        along = c - d * a / b
        said.append(f"Where the angle stays the same, 0.1 more of friction goes with {-0.1 * a / b:+.3f} of rolling friction, and the flow changes by "
                    f"{100 * along:+.2f} g/s, {number(abs(0.1 * along) / left)} times what is left about its plane: so much the flow tells of the two "
                    "where the drum tells nothing.")
    return said
