"""Draws what fits a calibration's targets: the draws of its posterior by pairs of parameters. Several results (of GET
/calibrations/ID/results, or answers by themselves) over the same parameters go into one picture, each in a colour of its own.

    draw_calibration.py RESULTS... --out PICTURE [--names NAME...] [--mark VALUE...]
"""
import argparse
import json
import sys

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

COLOURS = ["#c98b4b", "#0f5c8c", "#1d6b3f"]


def answer_of(path):
    with open(path) as file:
        document = json.load(file)
    answer = document.get("answer", document)
    if not answer or "samples" not in answer:
        sys.exit(f"{path} has no draws: the calibration has not come to an answer")
    return answer


def draw_pair(axes, answers, names, column, row, marks):
    for answer, name, colour in zip(answers, names, COLOURS):
        samples = np.array(answer["samples"])
        axes.plot(samples[:, column], samples[:, row], ".", markersize=3, color=colour, alpha=0.5, label=f"{name}: {answer['status']}")
    if marks:
        axes.plot(marks[column], marks[row], "k+", markersize=14, markeredgewidth=2, label="true values")
    axes.grid(alpha=0.3)


def draw(answers, names, picture, marks=(), size=4.2):
    parameters = answers[0]["parameters"]
    if any(answer["parameters"] != parameters for answer in answers) or len(parameters) < 2:
        sys.exit("the results must have the same parameters, two or more")
    count = len(parameters) - 1
    figure, grid = plt.subplots(count, count, squeeze=False, figsize=(size * count + 1.5, size * count * 0.8 + 0.3))
    for row in range(count):
        for column in range(count):
            axes = grid[row][column]
            axes.set_visible(column <= row)
            if column <= row:
                draw_pair(axes, answers, names, column, row + 1, marks)
                axes.set_xlabel(parameters[column].rsplit("/", 1)[-1].replace("_", " "))
                axes.set_ylabel(parameters[row + 1].rsplit("/", 1)[-1].replace("_", " "))
    grid[0][0].legend(fontsize="small")
    figure.tight_layout()
    figure.savefig(picture, dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+")
    parser.add_argument("--out", required=True)
    parser.add_argument("--names", nargs="+", default=[])
    parser.add_argument("--mark", nargs="+", type=float, default=[], help="the true values, where they are known")
    asked = parser.parse_args()
    names = asked.names or [str(k + 1) for k in range(len(asked.results))]
    draw([answer_of(path) for path in asked.results], names, asked.out, asked.mark)


if __name__ == "__main__":
    main()
