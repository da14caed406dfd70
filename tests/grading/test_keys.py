"""The hidden cases of a run: wrong answers are worked out for who is wrong, and other machines draw the same."""

import json
import pickle

import pytest
from transform_lab.judging.calling import call
from transform_lab.judging.verdict import examine

from autograder.exercises import EXERCISES, key
from autograder.grading.grade import Keys

SEED = 1234


def plain(exercise):
    return json.dumps({**exercise, "cases": [{**case, "wrong": list(case["wrong"])} for case in exercise["cases"]]})


def judged(exercise, name, function):
    return examine(name, exercise, lambda args, kwargs: call(function, args, kwargs))


@pytest.mark.parametrize("name", ["is_rotation", "chain", "transform_to_pose"])
def test_they_say_what_the_key_says(name):
    drawn = Keys([name], SEED)
    assert plain(drawn[name]) == json.dumps(key(EXERCISES[name], SEED))
    elsewhere = pickle.loads(pickle.dumps(drawn))
    assert list(elsewhere) == [name] and plain(elsewhere[name]) == plain(drawn[name])


def test_a_right_solution_costs_no_wrong_answer():
    drawn, exercise = Keys(["chain"], SEED)["chain"], EXERCISES["chain"]
    assert judged(drawn, "chain", exercise.reference).right
    assert not any(case["wrong"].told for case in drawn["cases"])
    assert judged(drawn, "chain", lambda *transforms: exercise.reference(*transforms[::-1])).misconceptions
    assert any(case["wrong"].told for case in drawn["cases"])
