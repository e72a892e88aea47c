"""One state, whatever computed it: the hash of all that a scene saves, by each instruction set, at -O3 (avx512, avx2) and
-O2 (plain), with any number of threads. The programs of an instruction set differ in how many contacts a vector holds, in
how they fuse products (plain: by double arithmetic of its own, and libm), and in what the optimiser did."""
import json
from pathlib import Path

import pytest
from conftest import BUILD, program

SECTION = "The same bits"
WHY = "every operation rounds alike: fused products are written out, and sums have one order"
CASES = ["spheres", "two sizes", "tetrahedra", "spring-dashpot, lifters", "hertz-mindlin, end walls",
         "rolling friction, two sizes", "materials", "jkr, two sizes", "liquid bridges",
         "damped rolling of materials", "constant rolling torque, two sizes", "flow out of a hopper"]
KEPT = json.loads((Path(__file__).parent / "state_hashes.json").read_text())


def builds(precision):
    """The folders of all programs that this machine can run."""
    return sorted(folder for folder in (BUILD / "tests").glob(f"{precision}-*") if (folder / "state_hash").exists())


@pytest.mark.parametrize("precision", ["single", "double"])
def test_instruction_sets_come_to_one_state(record, precision):
    """2000 steps from the beginning of rotation, the making of the bed before it included."""
    folders = builds(precision)
    assert any(folder.name == f"{precision}-plain" for folder in folders) and len(folders) > 1, "make physics-programs"
    for number, case in enumerate(CASES):
        found = {folder.name: program("state_hash", folder, case=number, steps=2000) for folder in folders}
        assert all(f"{one['precision']}-{one['isa']}" == name for name, one in found.items())
        assert all(one["settled"] > 1000 and one["overlap"] > 0 for one in found.values())
        assert {one["hash"] for one in found.values()} == {KEPT[precision][case]}, (
            f"the bits of '{case}', {precision}, are not those that state_hashes.json keeps. Where that is meant, say so in the commit"
            " and write the new hash there")
        record.same(f"{case}, {precision}: states 2,000 steps after the bed was made, by "
                    + ", ".join(name.split("-")[1] for name in found), len({one["hash"] for one in found.values()}), 1, WHY)


def test_any_number_of_threads_comes_to_one_state(record):
    found = {(folder.name, threads): program("state_hash", folder, steps=10000, settling=0, threads=threads)
             for folder in builds("single") for threads in (1, 2, 3, 8)
             if threads == 1 or not folder.name.endswith("plain")}
    record.same("spheres: states after 10,000 steps of -O2 and -O3 with 1, 2, 3 and 8 threads",
                len({one["hash"] for one in found.values()}), 1, WHY)


def test_a_step_more_is_another_state(record):
    """The hash sees the state: a step more is another one."""
    record.same("spheres: states after 100 and 101 steps", len({program("state_hash", steps=steps)["hash"] for steps in (100, 101)}), 2,
                "a step moves every particle")
