"""Where a row of the paper disagrees by more than three of its spreads: what the paper leaves unsaid is varied, one
thing at a time, and the row is looked at again."""
import copy
import math

from collecting import cases_of, runs_of
from comparing import judge


def merge_patch(target, patch):
    """RFC 7396."""
    if not isinstance(patch, dict):
        return copy.deepcopy(patch)
    merged = copy.deepcopy(target) if isinstance(target, dict) else {}
    for name, value in patch.items():
        if value is None:
            merged.pop(name, None)
        else:
            merged[name] = merge_patch(merged.get(name), value)
    return merged


def request_of(document, case):
    """The inputs of a case before defaults: base and patch, or base with its varied values."""
    inputs = document["base"]["inputs"]
    patch = next((entry.get("inputs", {}) for entry in document.get("cases", []) if entry["name"] == case), None)
    return None if patch is None else merge_patch(inputs, patch)


def fill_variants(inputs):
    """What is unsaid of a fill: how wide the stream is, and how dense (by default 5 % of it is particles)."""
    cylinder, stream = inputs["cylinder"]["diameter"], inputs["stream"]
    kind = inputs["particles"][0]
    spheres = {"sphere": 1, "dumbbell": 2, "tetrahedron": 4, "cube": 8}[kind.get("shape", "sphere")]
    particle = spheres * math.pi / 6 * kind["diameter"] ** 3
    rate = stream.get("rate", 0.05 * math.pi / 4 * stream["diameter"] ** 2 * stream["impact_speed"] / particle)
    return [
        {"name": "stream a quarter as wide as the cylinder, a quarter of the rate", "inputs": {"stream": {"diameter": 0.25 * cylinder, "rate": round(rate / 4, 1)}}},
        {"name": "stream nearly as wide as the cylinder", "inputs": {"stream": {"diameter": 0.9 * cylinder}}},
        {"name": "a quarter of the rate", "inputs": {"stream": {"rate": round(rate / 4, 1)}}},
    ]


def variants(inputs, is_regime=False):
    """What is unsaid: how rough the wall is, how full the drum, how stiff and how elastic the particles. A regime alone is tried
    with what may hold or loosen the bed."""
    if "stream" in inputs:
        return fill_variants(inputs)
    diameter = max(kind["diameter"] for kind in inputs["particles"])
    friction, fill = inputs["wall"]["friction"], inputs["fill_fraction"]
    overlap = inputs["contact"].get("maximum_overlap", 0.01)
    lining = {"diameter": diameter, "pitch": diameter}
    hold = [
        {"name": "wall lined with glued spheres", "inputs": {"wall": {"lining": lining}}},
        {"name": f"wall friction {friction / 2:g}", "inputs": {"wall": {"friction": friction / 2}}},
        {"name": f"wall friction {friction * 2:g}", "inputs": {"wall": {"friction": friction * 2}}},
    ]
    return hold if is_regime else hold + [
        {"name": f"fill {fill - 0.1:g}", "inputs": {"fill_fraction": round(fill - 0.1, 4)}},
        {"name": f"fill {fill + 0.1:g}", "inputs": {"fill_fraction": round(fill + 0.1, 4)}},
        {"name": f"four times as stiff, overlap {overlap / 2:g}", "inputs": {"contact": {"maximum_overlap": overlap / 2}}},
        {"name": "restitution 0.9", "inputs": {"contact": {"restitution": 0.9}}},
    ]


def can_vary(collected, row):
    """Drums and fills alone have all that is varied; "more than nothing" can't be nearer or further. "vary": false says that a
    row is an input, or would take too long."""
    process = collected["document"]["base"].get("process", "drum")
    inputs = request_of(collected["document"], row["case"])
    if not row.get("vary", True) or not {"value", "within", "words"} & set(row) or inputs is None or any("diameter" not in kind for kind in inputs["particles"]):
        return False
    if process == "fill":
        return "impact_speed" in inputs.get("stream", {}) and "diameter" in inputs["stream"]
    return process == "drum" and "fill_fraction" in inputs and "friction" in inputs.get("wall", {})


def document_for(collected, case, rows):
    """The study that varies the unsaid about one case."""
    inputs = request_of(collected["document"], case)
    is_regime = all("words" in row for row in wrong_rows(collected, rows) if row["case"] == case)
    cases = [entry | {"label": {"paper": "unsaid"}} for entry in variants(inputs, is_regime)]
    name = f"investigate {collected['document']['name']}: {case}"
    base = {"inputs": inputs}
    if "process" in collected["document"]["base"]:
        base["process"] = collected["document"]["base"]["process"]
    return {"name": name, "description": f"What the paper leaves unsaid about {case}, varied one thing at a time.", "base": base,
            "cases": cases, "repeats": 1}


def wrong_rows(collected, rows):
    return [row for row in rows if can_vary(collected, row) and judge(row, runs_of(collected, row["case"])).agrees is False]


def disagreeing(collected, rows):
    """Cases with a row that disagrees and can be varied, in order, each once."""
    wrong = [row["case"] for row in wrong_rows(collected, rows)]
    return [case for case in cases_of(collected) if case in wrong]
