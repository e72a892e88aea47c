"""Pictures of particles, drawn from snapshots: small files, since they are kept beside the report."""
import draw_drum

DPI = 64


def drum(folder, run, place, name, number=-1, colour="speed", with_angle=True):
    """Markdown of the drum at one snapshot; nothing where the snapshots are gone.

    folder: of the run's snapshots; number: counted as Python does; place: folder of the pictures."""
    if not run["snapshots"] or not (folder / run["snapshots"][number]).exists():
        return ""
    snapshot = draw_drum.read_snapshot(folder / run["snapshots"][number])
    place.mkdir(parents=True, exist_ok=True)
    draw_drum.draw(snapshot, run["results"] if with_angle else None, place / f"{name}.png", colour, dpi=DPI)
    return f"![{run['case']} at {snapshot['time']:.2f} s]({place.name}/{name}.png)"
