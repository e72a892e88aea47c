#!/usr/bin/python3
"""Draw the drum of a snapshot: the particles of a slice coloured by their speed, and the measured angle of repose
as a line through the surface.

    draw_drum.py SNAPSHOT.hdf RESULT.json PICTURE.png [--colour speed|species] [--slice METRES] [--dark]

The drum is seen along its axis, turning counter-clockwise, so the surface rises to the right.
"""
import argparse
import json
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.patches import Arc, Circle

SPECIES_COLOURS = ["#c98b4b", "#2f6f8f", "#7a9a4f", "#8a5a9a"]


def read_snapshot(path):
    """Positions (n,3) m, radii (n) m, speeds (n) m/s, species (n), time s and the run's inputs."""
    with h5py.File(path) as file:
        vtk = file["VTKHDF"]
        data = vtk["PointData"]
        position = vtk["Points"][:]
        species = data["species"][:] if "species" in data else np.zeros(len(position), int)
        return {
            "position": position,
            "radius": data["radius"][:],
            "speed": np.linalg.norm(data["velocity"][:], axis=1),
            "species": species,
            "time": float(np.ravel(vtk["FieldData/time"][:])[0]),
            "inputs": json.loads(file["run"].attrs["params_json"])["inputs"],
        }


def in_slice(snapshot, thickness):
    """Indices of the particles whose centres lie in the slice around the middle, the farthest first."""
    z = snapshot["position"][:, 2]
    if thickness is None:
        thickness = 2.0 * snapshot["radius"].max(initial=0.0)
    chosen = np.flatnonzero(np.abs(z) <= thickness / 2.0)
    return chosen[np.argsort(z[chosen])]


def surface_offset(snapshot, angle, drum_radius):
    """Distance of the surface from the axis, along the line's normal, m; None without particles.

    In a frame turned by the angle the surface is level: the height at which the middle of the chord holds half as
    much volume as it does inside the bed. Particles in flight above are too few to count."""
    x, y, radius = snapshot["position"][:, 0], snapshot["position"][:, 1], snapshot["radius"]
    along = np.cos(angle) * x + np.sin(angle) * y
    above = -np.sin(angle) * x + np.cos(angle) * y
    middle = np.abs(along) < 0.4 * drum_radius
    if not middle.any():
        return None
    layer = 1.5 * radius.mean()
    volume, edges = np.histogram(above[middle], np.arange(-drum_radius, drum_radius + layer, layer),
                                 weights=radius[middle] ** 3)
    bed = np.median(volume[volume > 0.1 * volume.max()])
    return float(edges[np.flatnonzero(volume >= 0.5 * bed)[-1] + 1])


def draw_wall(axes, snapshot, ink):
    inputs = snapshot["inputs"]
    radius = inputs["drum"]["diameter"] / 2.0
    axes.add_patch(Circle((0, 0), radius, fill=False, edgecolor=ink, linewidth=2.5))
    lining = (inputs.get("wall") or {}).get("lining")
    if not lining or not lining.get("diameter"):
        return
    # As many as fit around at their pitch, touching the wall from within, turned with it since rotation began.
    ring = radius - lining["diameter"] / 2.0
    count = max(1, int(np.floor(2.0 * np.pi * ring / lining.get("pitch", lining["diameter"]) + 1e-9)))
    turned = inputs["drum"].get("rotation_rate", 0.0) * max(snapshot["time"], 0.0)
    spheres = [Circle((ring * np.cos(a), ring * np.sin(a)), lining["diameter"] / 2.0)
               for a in turned + 2.0 * np.pi * np.arange(count) / count]
    axes.add_collection(PatchCollection(spheres, facecolor="#9aa4aa", edgecolor="none"))


def draw_particles(axes, snapshot, chosen, colour, ink):
    circles = [Circle(snapshot["position"][i, :2], snapshot["radius"][i]) for i in chosen]
    spheres = PatchCollection(circles, edgecolor=ink, linewidth=0.25)
    if colour == "species":
        spheres.set_facecolor([SPECIES_COLOURS[s % len(SPECIES_COLOURS)] for s in snapshot["species"][chosen]])
    else:
        speed = snapshot["speed"][chosen]
        spheres.set_array(speed)
        spheres.set_cmap("viridis")
        # One sphere flying far faster than all others would otherwise make them all the same colour.
        spheres.set_clim(0.0, max(np.percentile(speed, 99.0), 1e-12) if len(speed) else 1.0)
    axes.add_collection(spheres)
    return spheres


def draw_angle(axes, snapshot, results, ink):
    """The measured angle as a line across the drum, with a level line and an arc between the two."""
    repose = results["repose"]
    degrees = repose.get("angle_deg")
    if degrees is None:
        axes.set_title("angle of repose: could not be measured", color=ink)
        return
    angle = np.radians(degrees)
    radius = snapshot["inputs"]["drum"]["diameter"] / 2.0
    offset = surface_offset(snapshot, angle, radius) or 0.0
    half_chord = np.sqrt(max(radius**2 - offset**2, 0.0))
    along = np.array([np.cos(angle), np.sin(angle)])
    foot = offset * np.array([-np.sin(angle), np.cos(angle)])
    low, high = foot - half_chord * along, foot + half_chord * along
    axes.plot(*zip(low, high), color="#d1352b", linewidth=2.2, solid_capstyle="round")
    axes.plot([low[0], low[0] + radius], [low[1], low[1]], color="#d1352b", linewidth=1.0, linestyle=(0, (5, 4)))
    axes.add_patch(Arc(low, 1.5 * radius, 1.5 * radius, theta1=min(0.0, degrees), theta2=max(0.0, degrees),
                       color="#d1352b", linewidth=1.4))
    error = repose.get("standard_error_deg")
    text = f"{degrees:.1f}°" if error is None else f"{degrees:.1f}° ± {error:.1f}°"
    regime = (results.get("regime") or {}).get("name")
    axes.set_title(f"angle of repose {text}" + (f", {regime}" if regime else ""), color=ink, fontsize=13)


def draw(snapshot, results, picture, colour="speed", thickness=None, dark=False, dpi=150):
    """results: None for a drum of which no angle is wanted."""
    ink, paper = ("#e6e9ea", "#14191c") if dark else ("#1f2a30", "#ffffff")
    chosen = in_slice(snapshot, thickness)
    figure, axes = plt.subplots(figsize=(7.2, 6.4), facecolor=paper)
    draw_wall(axes, snapshot, ink)
    spheres = draw_particles(axes, snapshot, chosen, colour, ink)
    if results:
        draw_angle(axes, snapshot, results, ink)
    if colour == "speed":
        bar = figure.colorbar(spheres, ax=axes, fraction=0.04, pad=0.02)
        bar.set_label("speed, m/s", color=ink)
        bar.ax.tick_params(colors=ink)
    half = 0.52 * snapshot["inputs"]["drum"]["diameter"]
    axes.set(xlim=(-half, half), ylim=(-half, half), aspect="equal")
    axes.axis("off")
    axes.text(-half, -half, f"{snapshot['time']:.2f} s", color=ink, fontsize=10, va="bottom")
    figure.savefig(picture, dpi=dpi, bbox_inches="tight", facecolor=paper)
    plt.close(figure)
    return len(chosen)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("snapshot", type=Path)
    parser.add_argument("results", type=Path)
    parser.add_argument("picture", type=Path)
    parser.add_argument("--colour", choices=["speed", "species"], default="speed")
    parser.add_argument("--slice", type=float, metavar="METRES", help="default: the largest particle's diameter")
    parser.add_argument("--dark", action="store_true", help="for a dark page")
    wanted = parser.parse_args()
    drawn = draw(read_snapshot(wanted.snapshot), json.loads(wanted.results.read_text()), wanted.picture,
                 wanted.colour, wanted.slice, wanted.dark)
    print(f"{wanted.picture}: {drawn} particles")


if __name__ == "__main__":
    main()
