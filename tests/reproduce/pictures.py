"""Pictures of particles, drawn from snapshots: small files, since they are kept beside the report."""
import draw_drum
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle

DPI = 64
INK = "#1f2a30"


def snapshot(folder, run, number):
    """None where the snapshots are gone."""
    if not run["snapshots"] or not (folder / run["snapshots"][number]).exists():
        return None
    return draw_drum.read_snapshot(folder / run["snapshots"][number])


def drum(folder, run, place, name, number=-1, colour="speed", with_angle=True):
    """Markdown of the drum at one snapshot; nothing where the snapshots are gone.

    folder: of the run's snapshots; number: counted as Python does; place: folder of the pictures."""
    seen = snapshot(folder, run, number)
    if seen is None:
        return ""
    place.mkdir(parents=True, exist_ok=True)
    draw_drum.draw(seen, run["results"] if with_angle else None, place / f"{name}.png", colour, dpi=DPI)
    return f"![{run['case']} at {seen['time']:.2f} s]({place.name}/{name}.png)"


def standing(folder, run, place, name, half_width, number=-1, walls=True):
    """The same of a bed that stands under gravity down z: a slice through the axis, seen from the side, species by
    colour. half_width: of the picture, m; walls: lines there, of a cylinder."""
    seen = snapshot(folder, run, number)
    if seen is None:
        return ""
    x, y, z = seen["position"].T
    near = np.flatnonzero((np.abs(y) <= seen["radius"].max()) & (np.abs(x) <= half_width))
    near = near[np.argsort(-y[near])]
    top = max(float((z + seen["radius"])[near].max(initial=0.0)), 0.5 * half_width)
    figure, axes = plt.subplots(figsize=(5.0, max(1.5, 5.0 * top / (2.0 * half_width))))
    balls = PatchCollection([Circle((x[i], z[i]), seen["radius"][i]) for i in near], edgecolor=INK, linewidth=0.25)
    colours = draw_drum.SPECIES_COLOURS
    balls.set_facecolor([colours[int(seen["species"][i]) % len(colours)] for i in near])
    axes.add_collection(balls)
    axes.plot([-half_width, half_width], [0, 0], color=INK, linewidth=2)
    for side in (-half_width, half_width) if walls else ():
        axes.plot([side, side], [0, top], color=INK, linewidth=2)
    axes.set(xlim=(-1.03 * half_width, 1.03 * half_width), ylim=(-0.03 * half_width, top), aspect="equal")
    axes.axis("off")
    place.mkdir(parents=True, exist_ok=True)
    figure.savefig(place / f"{name}.png", dpi=DPI, bbox_inches="tight")
    plt.close(figure)
    return f"![{run['case']} at {seen['time']:.2f} s]({place.name}/{name}.png)"
