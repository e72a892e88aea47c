"""What a long time leaves as it was: the energy of an elastic gas, a bed at rest. In both precisions."""
import math
import os
import statistics
from concurrent.futures import ThreadPoolExecutor

import pytest
from conftest import BUILDS, program

SECTION = "Energy and rest"


def drifts(build, steps_per_contact, seeds):
    """Relative changes of a gas's energy over 4.5 s: 60 spheres in a drum at rest, e = 1, no friction, no weight."""
    def one(seed):
        seen = program("gas", build, steps=150000 * steps_per_contact // 20, steps_per_contact=steps_per_contact, seed=seed)
        return seen["after"] / seen["before"] - 1
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(one, range(1, seeds + 1)))


def root_mean_square(numbers):
    return math.sqrt(sum(x * x for x in numbers) / len(numbers))


@pytest.mark.minutes
def test_an_elastic_gas_keeps_its_energy(record):
    """Some ten thousand collisions, each off by what a kink within a step takes, 1e-3 of its energy at random, of sixty
    spheres' energies: 2e-3 of the whole. That is the step's doing, not the numbers': it falls with the square of the step
    and is the same in double."""
    single = {n: root_mean_square(drifts(BUILDS["single"], n, 8)) for n in (20, 80)}
    double = root_mean_square(drifts(BUILDS["double"], 20, 8))
    record("elastic gas, drift in 4.5 s, root mean square of 8 seeds, 20 steps a contact, single", single[20], 0, 0.01,
           "conserved; a walk of 1e4 collisions of 1e-3 each, five times that")
    record("elastic gas, the same in double", double, 0, 0.01, "conserved; the same walk")
    record("elastic gas, 80 steps a contact, single", single[80], 0, 0.01 / 16,
           "conserved; a sixteenth: rounding adds less than the steps do, even these")


def record_audit(record, bed, build, **asked):
    """The step's own balance: gravity's work is the loss of height, so motion and height change by the contacts' work
    alone; what the drum puts in and the particles do not gain has gone into contacts."""
    seen = program("audit", build, **asked)
    clusters = asked.get("clusters")
    record(f"a drum of {bed} over a revolution: contacts' work less gain in motion and height, over the drum's work",
           (seen["contact_work"] - seen["gained"]) / seen["wall_work"], 0, 2e-6 if clusters else 1e-9,
           "leap-frog keeps this balance to the last digit" + ("; rotation to second order, (60 rad/s x 2e-5 s)^2" if clusters else ""))
    record.between(f"a drum of {bed} over a revolution: gone into contacts, over the drum's work", 1 - seen["gained"] / seen["wall_work"], 0.5, 1,
                   "at most all of it; the bed gains its lean once, contacts lose all the way")


@pytest.mark.parametrize("clusters", [0, 1])
def test_a_drums_energy_is_accounted_for(record, clusters):
    record_audit(record, "dumbbells" if clusters else "spheres", BUILDS["single"], clusters=clusters)


@pytest.mark.minutes
@pytest.mark.parametrize("law, number", [("constant", 1), ("sjkr", 2), ("jkr", 4), ("liquid-bridge", 5)])
def test_a_cohesive_drums_energy_is_accounted_for(record, law, number):
    """What a pull gives where spheres meet, and takes where they part, is the contacts' work as friction's is."""
    record_audit(record, f"spheres that cohere by {law}", BUILDS["single"], cohesion=number)


@pytest.mark.minutes
def test_a_drums_energy_is_accounted_for_in_double(record):
    record_audit(record, "spheres, in double,", BUILDS["double"])


@pytest.mark.minutes
def test_beds_at_rest_stay_at_rest_for_a_million_steps(record):
    """In one bed of a dozen a loose sphere finds a lower place, and others set by some 1e-4 d after it: of three beds' medians
    the middle one counts. What leaked from every contact would move all of them."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        seen = list(pool.map(lambda seed: program("gas", weight=1, particles=320, steps=1000000, seed=seed), (1, 2, 3)))
    medians = [bed["median"] for bed in seen]
    record("three beds of 320 at rest, a million steps: median move", statistics.median(medians), 0, 1e-4,
           "nothing; a loaded contact gives by 1e-3 d, so that a tenth of its friction lost would show. A few loose spheres do move; "
           f"the beds: {', '.join(f'{m:.2g}' for m in medians)}", "d")
    record("three beds of 320 at rest, a million steps: most kinetic energy left over m g d", max(bed["kinetic"] for bed in seen), 0, 1e-6,
           "nothing; a loose sphere may still roll to and fro: rolling has no resistance of its own")
