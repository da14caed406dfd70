"""Every seed asks the same questions, each with numbers of its own: what is wrong earns the same for all, and has one name."""

import json

import numpy as np
import pytest
from solutions.wrong import CACHES, WRONG
from support import SEEDS, judged, key_of

from autograder.exercises import EXERCISES, PUBLIC_SEED
from autograder.exercises.draws import OWN, Draws
from autograder.proving.adequacy import quiet


@pytest.mark.parametrize("name", EXERCISES)
def test_what_is_wrong_earns_the_same_for_every_seed_and_is_called_the_same(name, thorough):
    wrong = {f"{each.id} ({number})": each.wrong for number, each in enumerate(EXERCISES[name].misconceptions, 1)}
    wrong |= {function.__name__: function for of, _, function in WRONG if of == name}
    differ = {}
    with quiet():
        for label in sorted(wrong.keys() - CACHES)[:: 1 if thorough else 10]:
            verdicts = [judged(name, wrong[label], seed) for seed in SEEDS[1 : None if thorough else 3]]
            found = {(round(verdict.credit, 6), verdict.misconceptions) for verdict in verdicts}
            if len(found) > 1:
                differ[label] = found
    assert not differ


@pytest.mark.parametrize("seed", SEEDS[1:])
def test_what_is_drawn(seed):
    first, drawn = Draws(1000), Draws(seed)
    for draw in (
        lambda rng: rng.choice([-1.0, 1.0], size=20),
        lambda rng: rng.choice(3, size=20, p=[0.2, 0.3, 0.5]),
        lambda rng: rng.permutation(20),
        lambda rng: rng.integers(1000, size=20),
    ):
        np.testing.assert_array_equal(draw(drawn), draw(first))
    for _ in range(100):
        near, number = first.uniform(3.0, 5.0), drawn.uniform(3.0, 5.0)
        assert 3.0 <= number <= 5.0 and 0.0 < abs(number - near) <= OWN * 2.0
    assert (drawn.normal(size=100) != first.normal(size=100)).all()
    assert drawn.standard_normal() != first.standard_normal()  # all else that NumPy's generator does, it does as ever


@pytest.mark.parametrize("name", ["make_transform", *list(EXERCISES)[6:]])
def test_numbers_of_its_own(name):
    """Who has learned the public answers by heart knows few of the others: those that are given by the sort of case alone."""
    public, hidden = ([json.dumps(case["args"]) for case in key_of(name, seed)["cases"]] for seed in (PUBLIC_SEED, 1))
    assert sum(case in public for case in hidden) <= 0.1 * len(hidden)
