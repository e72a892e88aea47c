#!/usr/bin/env python3
"""The record of `make bench`: report.py OUT [--commit C] [--flags F] [--table FILE] [--demo FILE] [--peers FILE] ...

Gathers what the bench programs printed (a JSON line each), writes OUT/<date>-<commit>.json and prints a table, with the ratio
to the newest record that was there."""
import argparse
import datetime
import json
import pathlib
import platform
import subprocess


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def json_lines(path):
    return [json.loads(line) for line in pathlib.Path(path).read_text().splitlines() if line.startswith("{")] if path else []


def last_figures(folder):
    """{name: (figure, record)} of the newest record, by its own date, that has the figure."""
    figures = {}
    for record in sorted((json.loads(path.read_text()) for path in folder.glob("*.json")), key=lambda one: one["date"]):
        for name, figure in record["figures"].items():
            figures[name] = figure, record
    return figures


def figures_of(tables, demo, peers):
    """{name: {"unit", "minimum", "median", "maximum"}}, all that is compared between records."""
    figures = {}
    best = max((one["sphere_steps_per_second"]["median"] for one in tables if one["threads"] == 1), default=None)
    for one in tables:
        speed = one["sphere_steps_per_second"]
        figures[one["case"]] = {"unit": "sphere-steps/s", **speed, "spheres": one["spheres"], "threads": one["threads"],
                                "cost_relative_to_best": best / speed["median"]}
        if one["spheres"] > 5e5:
            memory = one["resident_bytes"] / one["spheres"]
            figures["memory a sphere"] = {"unit": "bytes", "minimum": memory, "median": memory, "maximum": memory,
                                          "spheres": one["spheres"]}
    for one in demo:
        figures[one["figure"]] = {key: one[key] for key in ("unit", "minimum", "median", "maximum")}
    for one in peers:
        figures[f"{one['peer']}, {one['spheres']}"] = {key: one[key] for key in ("unit", "minimum", "median", "maximum")}
        figures[f"ratio to {one['peer']}, {one['spheres']}"] = {"unit": "", **one["ratio"]}
    return figures


def text_of(value, unit):
    if unit.endswith("-steps/s"):
        return f"{value / 1e6:.2f} M"
    return f"{value:.4g}"


def print_table(record, last):
    print(f"{record['processor']}, {record['compiler']}, {record['flags']}, commit {record['commit']}")
    print(f"{'figure':34} {'minimum':>10} {'median':>10} {'maximum':>10} {'unit':14} {'cost':>6} {'to the last':>11}")
    compared = {}
    for name, figure in record["figures"].items():
        before, of = last.get(name, (None, None))
        ratio = f"{figure['median'] / before['median']:.3f}" if before and before["median"] else ""
        compared.update({of["date"]: of} if ratio else {})
        cost = f"{figure['cost_relative_to_best']:.2f}" if "cost_relative_to_best" in figure else ""
        numbers = " ".join(f"{text_of(figure[part], figure['unit']):>10}" for part in ("minimum", "median", "maximum"))
        print(f"{name:34} {numbers} {figure['unit']:14} {cost:>6} {ratio:>11}")
    for of in compared.values():
        print(f"the last: {of['date']}, commit {of['commit']}, {of['processor']}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--compiler", default="")
    parser.add_argument("--flags", default="")
    for name in ("table", "million", "demo", "peers"):
        parser.add_argument(f"--{name}")
    asked = parser.parse_args()
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip() or "unknown"
    changed = subprocess.run(["git", "status", "--porcelain", "-uno", "--", "core", "include", "api", "server", "Makefile"],
                             capture_output=True, text=True).stdout.strip()
    if changed:
        commit += "-changed"
    now = datetime.datetime.now(datetime.timezone.utc)
    record = {"date": now.strftime("%Y-%m-%dT%H:%M:%SZ"), "commit": commit, "processor": processor(), "compiler": asked.compiler,
              "flags": asked.flags,
              "figures": figures_of(json_lines(asked.table) + json_lines(asked.million), json_lines(asked.demo), json_lines(asked.peers))}
    asked.out.mkdir(parents=True, exist_ok=True)
    last = last_figures(asked.out)
    name = f"{now:%Y-%m-%d}-{commit}{'-peers' if asked.peers else ''}.json"
    (asked.out / name).write_text(json.dumps(record, indent=1) + "\n")
    print_table(record, last)
    print(f"kept as {asked.out / name}")


main()
