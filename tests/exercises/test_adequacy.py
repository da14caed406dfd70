"""The grader is proven right: no wrong solution passes, no right one fails, and misconceptions get their own name.

For every exercise, for its public cases and for the hidden cases of 50 seeds (of one, among the quick tests):

- every misconception is caught; on every tenth seed it is also named by its own id alone
- there is a case in every band of every feature that the exercise declares
- every shortcut that is generated from the features is caught, unless it is declared as equivalent
- every syntactic mutant of the reference, and of the solution in the notebook, is caught, unless the specification
  declares it as equivalent
- every right solution of `solutions/` is accepted, and every wrong one refused
- nothing that answers by a call's number, by the public key, or by what it was asked before is accepted

`python3 -m autograder prove` says the same of fewer seeds, and which case would catch what slips through.
"""

import pytest
from support import ROOT
from transform_lab.judging.calling import call
from transform_lab.judging.verdict import examine

from autograder.course import Course
from autograder.exercises import EXERCISES, PUBLIC_SEED, key
from autograder.proving.adequacy import NAMED_EVERY, measure, misnamed, quiet, refused, seeds, slips_through
from autograder.proving.bands import empty_bands
from autograder.proving.solutions import made_no_longer, notebook_solution, to_be_tried

every_exercise = pytest.mark.parametrize("name", EXERCISES)


@every_exercise
def test_adequacy(name, thorough):
    exercise, course = EXERCISES[name], Course(ROOT)
    drawn_from = seeds(51 if thorough else 2)
    tried = to_be_tried(course, exercise)
    assert notebook_solution(course, name) and {"misconception", "mutant", "right"} <= {each.kind for each in tried}
    assert not made_no_longer(exercise, tried), "declared as equivalent, and made no longer"
    assert not empty_bands(exercise, drawn_from)
    found = measure(exercise, tried, drawn_from, named=drawn_from[::NAMED_EVERY])
    said = []
    for each, what in zip(tried, found):
        assert len(what.accepted) + len(what.refused) == len(drawn_from)
        if slips_through(each, what):
            said.append(f"{each.kind}, and not caught: {each.label} ({len(what.accepted)} seeds)")
        if refused(each, what):
            said.append(f"{each.kind}, and refused: {each.label} ({len(what.refused)} seeds)")
        if misnamed(each, what):
            said.append(f"{each.label} is called {dict(what.called)}")
    assert not said, "\n".join(said)


@every_exercise
def test_it_is_the_judge_who_says_so(name, thorough, slow):
    """What is measured quickly, the judge says too."""
    exercise = EXERCISES[name]
    tried = to_be_tried(Course(ROOT), exercise)[:: 1 if thorough else 10]
    public = key(exercise, PUBLIC_SEED)
    with quiet():
        verdicts = [
            examine(name, public, lambda args, kwargs, f=each.fresh(): call(f, args, kwargs)).right for each in tried
        ]
    assert verdicts == [not what.refused for what in measure(exercise, tried, [PUBLIC_SEED])]
