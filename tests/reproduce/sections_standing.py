"""What is said of filled cylinders and of heaps on a plate."""
import pictures
from collecting import cases_of, runs_of
from comparing import AGREES, difference, mean, z_of
from markdown import listed, table, with_error, z_text
from sections_slow import equivalence

END = "results.repose.angle_deg"
FILLING = "results.repose.while_filling.angle_deg"


def text(one):
    return with_error(one) if one else ""


def mounds(collected):
    rows = []
    for case in cases_of(collected):
        runs = runs_of(collected, case)
        rows.append([case, *(text(mean(runs, path)) for path in (FILLING, END, "results.packing.solid_fraction", "results.packing.coordination_number"))])
    return table(["case", "slope while it fills, degrees", "slope at the end, degrees", "solid fraction", "contacts a particle"], rows)


def drawn(book, collected, number=-1):
    said = []
    for case in cases_of(collected):
        runs = runs_of(collected, case)
        if runs and "cylinder" in runs[0]["inputs"]:
            half = runs[0]["inputs"]["cylinder"]["diameter"] / 2.0
            said.append(pictures.standing(book.snapshots(runs[0]), runs[0], book.pictures, f"{collected['file']}-{case}", half, number))
    return " ".join(said).strip()


def figure1(book, collected):
    ends = {case: mean(runs_of(collected, case), END) for case in cases_of(collected)}
    ends = {case: one for case, one in ends.items() if one}
    return [drawn(book, collected), mounds(collected), equivalence(ends, "Slopes at the end by shape") if len(ends) > 1 else ""]


def steeper(one, other, names):
    apart = difference(one, other)
    z = z_of(apart, 0.0)
    sure = z is not None and z > AGREES
    word = "steeper than" if sure else "flatter than" if z is not None and z < -AGREES else "not told apart from"
    return f"{names[0]}: {word} {names[1]} ({with_error(apart)} degrees, {z_text(z)} spreads)."


def figure2(book, collected):
    spheres, tetrahedra = (runs_of(collected, case) for case in ("spheres", "tetrahedra"))
    said = [drawn(book, collected), mounds(collected)]
    for path, when in ((FILLING, "while it fills"), (END, "at the end")):
        one, other = mean(tetrahedra, path), mean(spheres, path)
        if one and other:
            said.append(steeper(one, other, (f"A mound of tetrahedra {when}", "one of spheres")))
    for name, runs in (("spheres", spheres), ("tetrahedra", tetrahedra)):
        before, after = mean(runs, FILLING), mean(runs, END)
        if before and after:
            said.append(steeper(before, after, (f"A mound of {name} under the stream", "what is left after it")))
    return said


def heap(book, collected):
    methods = list(dict.fromkeys(name for run in collected["runs"] for name in run["results"].get("repose", {}).get("other_methods", {})))
    rows, angles = [], {}
    for case in cases_of(collected):
        runs = runs_of(collected, case)
        angles[case] = mean(runs, END)
        rows.append([case, text(angles[case]), *(text(mean(runs, f"results.repose.other_methods.{name}")) for name in methods),
                     text(mean(runs, "results.surface.height")), text(mean(runs, "results.heap.lost"))])
    known = [(one.value, case) for case, one in angles.items() if one]
    order = f"From the flattest to the steepest: {listed(case for _, case in sorted(known))}." if len(known) > 1 else ""
    return [table(["case", "angle of repose, degrees", *methods, "height, m", "particles lost"], rows), order]
