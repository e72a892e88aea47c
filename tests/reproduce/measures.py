"""Numbers that the paper speaks of and a run's results do not have by themselves: from its samples and snapshots."""
import math

import numpy as np

from draw_drum import read_snapshot

SLICE = 3.0  # diameters, of the axial profile
LOOSE = 2.0  # diameters above the inner surface
FEW = {"cleared_1_percent": 0.01, "cleared_1_in_1000": 0.001}


def radial_history(samples):
    """Mean distance from the axis, large less small over the drum's radius, before the drum turns and at the end."""
    known = [row["radial_index"] for row in samples if row.get("radial_index") is not None]
    if len(known) < 2:
        return {}
    return {"radial_start": known[0], "radial_end": known[-1], "radial_change": known[-1] - known[0]}


def angle_history(samples):
    """[[time, direction of the centre of mass], ...], at most some 400 of them."""
    known = [[row["time"], row["center_of_mass_deg"]] for row in samples if row.get("center_of_mass_deg") is not None]
    return {"angles": known[:: max(1, len(known) // 400)]} if known else {}


def inner_radius(inputs, fill):
    return 0.5 * inputs["drum"]["diameter"] * math.sqrt(1.0 - fill)


def loose_share(snapshot, radius):
    """Share of the particles that are more than two diameters nearer the axis than the bed's inner surface would be,
    were the bed spread evenly over the wall."""
    off_axis = np.hypot(snapshot["position"][:, 0], snapshot["position"][:, 1])
    return float(np.mean(off_axis < radius - LOOSE * 2.0 * snapshot["radius"].mean()))


def revolution_cleared(history, few):
    """The first revolution from which on the share stays at or below few; None where it does not."""
    for revolution, share in reversed(history):
        if share > few:
            later = [r for r, _ in history if r > revolution]
            return later[0] if later else None
    return history[0][0] if history else None


def loose_history(snapshots, inputs, fill):
    radius, rate = inner_radius(inputs, fill), inputs["drum"]["rotation_rate"]
    history = [[snapshot["time"] * rate / (2.0 * math.pi), loose_share(snapshot, radius)] for snapshot in snapshots]
    return {"loose": history, **{name: revolution_cleared(history, few) for name, few in FEW.items()}}


def axial_profile(snapshot, length):
    """Share of the largest spheres in slices along the axis, and how unlike a random mixture the slices are: chi squared
    less its degrees of freedom over its standard deviation, some 0 +- 1 by chance alone."""
    count = max(2, int(length / (SLICE * 2.0 * snapshot["radius"].mean())))
    place = np.clip(((snapshot["position"][:, 2] / length + 0.5) * count).astype(int), 0, count - 1)
    large = snapshot["radius"] > 0.999 * snapshot["radius"].max()
    n = np.bincount(place, minlength=count)
    share = np.bincount(place, weights=large, minlength=count) / np.maximum(n, 1)
    p = large.mean()
    chi2 = float(np.sum(n * (share - p) ** 2) / (p * (1.0 - p)))
    return {"axial_share": share.round(4).tolist(), "axial_count": n.tolist(), "axial_mean": float(p),
            "axial_excess": (chi2 - (count - 1)) / math.sqrt(2.0 * (count - 1)),
            "axial_ends": float((share[0] + share[-1]) / 2.0 - p)}


def derive_drum(run, samples, folder):
    inputs, results = run["inputs"], run["results"]
    derived = {**radial_history(samples), **angle_history(samples)}
    omega2 = results["regime"].get("omega2_outer")
    if omega2 is not None:
        derived["omega_outer"] = math.sqrt(omega2)
    names = sorted(folder.glob("*.hdf"))
    if results["regime"].get("omega2_inner", 0.0) > 0.9 and len(names) > 10:
        derived.update(loose_history(map(read_snapshot, names), inputs, results["run"]["fill_fraction"]))
    long_enough = inputs["drum"]["length"] > 30.0 * max(kind.get("diameter") or 0.0 for kind in inputs["particles"])
    if len(inputs["particles"]) > 1 and long_enough and names:
        derived.update(axial_profile(read_snapshot(names[-1]), inputs["drum"]["length"]))
    return derived


DERIVED = {"drum": derive_drum}


def derive(run, samples, folder):
    return DERIVED.get(run["process"], lambda *_: {})(run, samples, folder)
