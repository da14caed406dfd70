"""A verdict depends on the answers alone: not on the order of the calls, and not on what was called before."""

import os
import pickle
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import cache, partial
from multiprocessing import get_context

import numpy as np
from solutions.right import NAMES, RIGHT
from solutions.wrong import CACHES, WRONG
from transform_lab.judging.calling import call
from transform_lab.judging.verdict import Reply, examine

from autograder.exercises import EXERCISES, key
from autograder.proving.adequacy import quiet

SEED = 11
EVERY = {
    **{f"right: {name}: {label}": (name, function) for (name, function), label in zip(RIGHT, NAMES)},
    **{f"wrong: {name}: {function.__name__}": (name, function) for name, _, function in WRONG},
}
# Default arguments that are written into, and caches.
REMEMBER = {"ttp_accumulates", "chain_remembers", *CACHES}


@cache
def drawn(name):
    return key(EXERCISES[name], SEED)


def judged(name, exercise, function):
    """The Verdict as a notebook's `check` and the grader reach it, but for the answer that it shows."""
    first = exercise["cases"][0]
    verdict = examine(
        name,
        exercise,
        lambda args, kwargs: function(args, kwargs),
        lambda: function(first["args"], first["kwargs"]),
    )
    remembers = "mutable-default" in verdict.misconceptions
    return replace(
        verdict, answer=None if remembers else repr(verdict.answer), failing=None if remembers else verdict.failing
    )


def test_in_any_order(thorough):
    rng, different = np.random.default_rng(SEED), []
    with quiet():
        for name, function in list(EVERY.values())[:: 1 if thorough else 10]:
            cases, called = drawn(name)["cases"], partial(call, function)
            first = judged(name, drawn(name), called)
            shuffled = {**drawn(name), "cases": [cases[number] for number in rng.permutation(len(cases))]}
            if (other := judged(name, shuffled, called)) != first:
                different.append((name, function, first, other))
    assert not different


def test_in_a_fresh_process_each(thorough, slow):
    """But for what remembers earlier calls, and is wrong for that alone."""
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:  # in this process, other tests have called them
        differ = {label: pair for found in pool.map(partial(differing, thorough), EXERCISES) for label, pair in found}
    assert not thorough or {label.split(": ")[2] for label in differ} == REMEMBER
    for together, apart_from_others in differ.values():
        assert apart_from_others.right and not together.right


def differing(thorough, name):
    """[(label, (Verdict of all calls in one process, of each call in a fresh one))] where these are not the same."""
    labels = [label for label, (of, _) in EVERY.items() if of == name][:: 1 if thorough else 40]
    functions, found = [EVERY[label][1] for label in labels], []
    with quiet():
        for label, function, replies in zip(labels, functions, apart(functions, drawn(name)["cases"])):
            verdicts = (
                judged(name, drawn(name), partial(call, function)),
                judged(name, drawn(name), lambda *case: replies[repr(case)]),
            )
            if verdicts[0] != verdicts[1]:
                found.append((label, verdicts))
    return found


def apart(functions, cases):
    """For each function its Replies, {arguments: Reply}: in a process for each case, in which all are called once."""
    found = [{} for _ in functions]
    for case in cases:
        read, write = os.pipe()
        if (child := os.fork()) == 0:
            try:
                with open(write, "wb") as file:
                    pickle.dump([call(function, case["args"], case["kwargs"]) for function in functions], file)
            finally:
                os._exit(0)  # whatever was raised: the tests go on in one process
        os.close(write)
        with open(read, "rb") as file:
            for replies, reply in zip(found, pickle.load(file)):
                replies[repr((case["args"], case["kwargs"]))] = reply
        os.waitpid(child, 0)
    return found


def test_what_the_verdict_would_be_if_order_counted():
    """The test sees it: a function that answers by the number of its calls has another verdict in another order."""
    exercise = key(EXERCISES["is_rotation"], SEED)
    verdicts = []
    for cases in (exercise["cases"], exercise["cases"][::-1]):
        answers = iter([case["expected"] for case in exercise["cases"]])
        verdicts.append(
            examine(
                "is_rotation", {**exercise, "cases": cases}, lambda a, k, n=answers: Reply("returned", next(n), [a, k])
            )
        )
    assert verdicts[0].right and not verdicts[1].right
