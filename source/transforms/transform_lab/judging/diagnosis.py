"""Name the misconception behind wrong answers, when exactly one explains all of them.

A misconception explains a function's answers when they equal its own wherever it differs from the right answer, and are
right everywhere else. Two mistakes at once are named when each wrong part of the answer (a pose's position and its
orientation, say) has exactly one explanation that leaves the other parts right. When none fits, or several do, nothing
is named: a wrong name is worse than none.
"""

import re
from collections import Counter

from . import codec
from .advice import OUT, TWO_AT_A_TIME, advice
from .answers import as_told, made_of, same
from .kinds import ARGUMENT, EARLIER_ANSWER, KINDS
from .naming import GENERAL, Diagnosis, general, joined, shared
from .places import by_place
from .plain import error_of, has_to_be_wrong, open_parts_of
from .slips import by_shape, cut_short
from .two_mistakes import part_by_part

# Where a formula breaks down.
NO_NUMBER = (
    "ZeroDivisionError|FloatingPointError|LinAlgError: Singular|"
    "ValueError: .*(math domain|zero norm|expected a (nonnegative|positive) input|expected a number in range)"
)
PRINT_IS_NOT_RETURN = "`print` shows a value to you; only `return` hands it to whoever called the function."
WRITTEN_ELSEWHERE = (
    "Your function changed one of its arguments, and returns one as it was before.",
    "Is the result written into the argument, in place of the answer? Make a new object, write into that, and return it.",
)
REMEMBERS = general("mutable-default")
NOT_ITS_OWN = {
    ARGUMENT: general("argument-returned"),
    EARLIER_ANSWER: general(
        "mutable-default",
        "Your function hands out the same object in every call: each answer overwrites the one before.",
        "Make a new array or message inside the function. A default argument, such as `T=np.eye(4)`, is made only once.",
    ),
}


def diagnose(name, exercise, replies, outcomes, tell=str):
    """The Diagnosis of the answers to all cases of `exercise`; see transform_lab.judging.verdict for the arguments.

    That a call changed its arguments is said first, and hides nothing but what is its consequence; so is that an answer is no
    object of its own.
    """
    found = _explain(name, exercise, replies, outcomes, tell)
    if not any(outcome.mutated for outcome in outcomes):
        kinds = sorted({outcome.same_object for outcome in outcomes} - {""})
        return joined([*(NOT_ITS_OWN[kind] for kind in kinds), found]) if kinds else found
    says, hint = GENERAL["input-mutated"]
    failed = [(case, outcome) for case, outcome in zip(exercise["cases"], outcomes) if not outcome.answered]
    if not failed:
        return general(
            "input-mutated", f"Your answers are right, but your function {says.removeprefix('Your function ')}"
        )
    if all(outcome.mutated and _is_as_given(exercise["returns"], case, outcome) for case, outcome in failed):
        return general("input-mutated", *WRITTEN_ELSEWHERE)
    if any(TWO_AT_A_TIME.search(reply.error) for reply in replies):
        hint = OUT
    return joined([general("input-mutated", says, hint), found])


def _is_as_given(returns, case, outcome):
    """Whether an answer is one of the arguments, as it was before the call."""
    given = map(codec.decode, [*case["args"], *case["kwargs"].values()])
    return outcome.got is not None and any(made_of(returns, outcome.got, value) for value in given)


def constant(replies):
    """Whether a function of arguments answers the same to all of them."""
    return len(replies) > 1 and all(
        reply.outcome == "returned" and reply.value == replies[0].value for reply in replies
    )


def _explain(name, exercise, replies, outcomes, tell):
    if all(outcome.answered for outcome in outcomes):
        return Diagnosis()
    misconceptions = exercise["misconceptions"]
    fits = [_fit(index, exercise, replies, outcomes) for index in range(len(misconceptions))]
    best = max(fits, default=0)
    found = shared([misconception for misconception, fit in zip(misconceptions, fits) if fit == best > 0])
    if found is not None:
        return found
    if constant(replies):
        return _general(name, exercise, replies, outcomes, tell) if outcomes[0].problem else general("hard-coded")
    found = Diagnosis() if any(outcome.got is None for outcome in outcomes) else part_by_part(exercise, outcomes)
    if found:
        return found
    mutated = any(outcome.mutated for outcome in outcomes)  # what is wrong may come from the changed argument alone
    place = Diagnosis() if mutated else cut_short(exercise, outcomes) or by_place(exercise, outcomes)
    if any(outcome.problem for outcome in outcomes):
        found = _general(name, exercise, replies, outcomes, tell)
        return found if found else found._replace(ids=place.ids, hint=place.hint or found.hint)
    if mutated:
        return found
    return place or by_shape(exercise, outcomes)


def _fit(index, exercise, replies, outcomes):
    """How well a misconception explains the answers.

    0: not. 3: they equal its own wherever it differs from the right one, and are right elsewhere. 2: so they do, where
    its own are not open. 1: none of its own is told, but they are wrong wherever it has to be, and right wherever it is.
    """
    parts = set(KINDS[exercise["returns"]].parts)
    fails = equals = is_open = False
    for case, reply, outcome in zip(exercise["cases"], replies, outcomes):
        wrong = case["wrong"][index]
        if wrong is None:
            if not outcome.answered:
                return 0
        elif open_parts := open_parts_of(wrong):
            came_to_nothing = outcome.got is None and _broke_down(outcome)
            if not came_to_nothing and not parts - open_parts <= outcome.parts:
                return 0
            if not has_to_be_wrong(wrong):
                is_open = True
            elif open_parts & outcome.parts:
                return 0
            else:
                fails = True
        elif outcome.answered or not _equals(wrong, exercise["returns"], reply, outcome):
            return 0
        else:
            equals = True
    return (2 if is_open else 3) if equals else int(fails)


def _equals(wrong, returns, reply, outcome):
    if raises := error_of(wrong):
        return reply.outcome == "raised" and re.match(r"\w*", reply.error)[0] == raises
    if outcome.got is None:
        return reply.outcome == "returned" and "unfit" in wrong and same(returns, reply.value, wrong["unfit"])
    return isinstance(wrong, list) and all(
        as_told(part, name, fingerprint, outcome)
        for (name, part), fingerprint in zip(KINDS[returns].parts.items(), wrong)
    )


def _broke_down(outcome):
    """Whether a formula came to its end: NaN came out, or arithmetic raised an error."""
    identifier, what = outcome.problem or (None, "")
    return identifier == "not-finite" or (identifier == "" and re.match(NO_NUMBER, what) is not None)


def _general(name, exercise, replies, outcomes, tell):
    """The failure that most of the calls share: an exception, or an answer that cannot be compared, or has NaN in it."""
    problems = [outcome.problem for outcome in outcomes if outcome.problem]
    identifier, times = Counter(identifier for identifier, _ in problems).most_common(1)[0]
    what = next(what for problem, what in problems if problem == identifier)
    others_right = 0 < len(problems) < len(outcomes) and all(one.answered or one.problem for one in outcomes)
    where = "" if times == len(replies) else f" in {times} of {len(replies)} cases"
    told = tell(what)
    what_came = f": {told}" if told else "."
    if not identifier and others_right and all(_broke_down(outcome) for outcome in outcomes if outcome.problem):
        return general(
            "breaks-down", f"Your answer is right wherever its formula works; it breaks down{where}{what_came}"
        )
    if not identifier:
        others = ", and is right in all others" if others_right else ""
        says = f"Your function raised an error{where}{others}{what_came}"
        return Diagnosis((), says, advice(told, name, exercise["parameters"]))
    says = f"{GENERAL[identifier][0].removesuffix('.')}{where}"
    if identifier == "not-finite":
        return general(identifier, f"{says}; all others are right." if others_right else f"{says}.")
    if identifier != "returned-none":
        return general(identifier, f"{says}: {told}." if told else f"{says}.")
    if any(reply.printed for reply in replies):
        return general(identifier, f"Your function printed something, but returned None{where}.", PRINT_IS_NOT_RETURN)
    return general(identifier, f"{says}.")
