"""Plots of the report. Each takes plain numbers and writes one small file."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

MARKS = {"raining": "v", "cataracting": "v", "sliding": "o", "centrifuging": "s"}
COLOURS = {"raining": "#b5532b", "cataracting": "#b5532b", "sliding": "#2f6f8f", "centrifuging": "#1f2a30"}


def save(figure, place, name, title):
    place.mkdir(parents=True, exist_ok=True)
    figure.tight_layout()
    figure.savefig(place / f"{name}.png", dpi=80)
    plt.close(figure)
    return f"![{title}]({place.name}/{name}.png)"


def eq33(x):
    """Eqn 33: x is 1/sin phi itself."""
    return x


def eq35(x):
    return np.sqrt(0.5) * (1.0 + 1.0 / (np.tan(np.arcsin(1.0 / x)) + 0.125))


def eq36(x):
    return 1.0 / np.sin(np.arctan(0.16 + np.tan(np.arcsin(1.0 / x))))


def figure8(place, grains, beds, marks):
    """The paper's map: Omega_i^2 over 1/sin phi. grains: (x, omega2) of single particles; beds: (x, omega2, regime);
    marks: (x, omega2, text) of the paper's own."""
    figure, axes = plt.subplots(figsize=(7.0, 5.2))
    x = np.linspace(1.02, max([5.0] + [one[0] for one in grains if one[0] < 11]) * 1.02, 300)
    axes.plot(x, eq33(x), color="#777777", label="Eqn 33")
    axes.plot(x, eq35(x), "--", color="#777777", label="Eqn 35")
    axes.plot(x, eq36(x), ":", color="#777777", label="Eqns 36-37")
    axes.plot(*zip(*grains), "D", color="#7a9a4f", markersize=5, label="single particle keeps contact") if grains else None
    for regime in dict.fromkeys(bed[2] for bed in beds):
        points = [(bed[0], bed[1]) for bed in beds if bed[2] == regime]
        axes.plot(*zip(*points), MARKS.get(regime, "x"), color=COLOURS.get(regime, "#8a5a9a"), markersize=7, label=f"bed, {regime}")
    for one_x, omega2, text in marks:
        axes.annotate(text, (one_x, omega2), xytext=(one_x + 0.6, omega2 - 0.45), fontsize=8, arrowprops={"arrowstyle": "-"})
    axes.set(xlabel="1/sin(angle of repose or of friction)", ylabel="omega² R_i/g", ylim=(1.0, 5.2), xlim=(0.9, x[-1]))
    axes.legend(fontsize=8)
    return save(figure, place, "figure8", "Figure 8: where beds rain, slide and stay")


def lines(place, name, title, series, xlabel, ylabel, level=None):
    """series: {label: [[x, y], ...]} or {label: [[x, y, error], ...]}; level: a line drawn across."""
    figure, axes = plt.subplots(figsize=(6.4, 3.6))
    for label, points in series.items():
        columns = list(zip(*points))
        if len(columns) == 3:
            axes.errorbar(columns[0], columns[1], columns[2], label=label, capsize=2, linewidth=1.2)
        else:
            axes.plot(columns[0], columns[1], label=label, linewidth=1.2)
    if level is not None:
        axes.axhline(level, color="#999999", linestyle="--", linewidth=0.8)
    axes.set(xlabel=xlabel, ylabel=ylabel)
    axes.legend(fontsize=8)
    return save(figure, place, name, title)
