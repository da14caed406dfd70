"""Names by where answers are wrong, where nothing else explains them: in cases of one special sort, and in no others.

Which cases are special (small, far, almost a half turn, whole numbers) is told by the features of their arguments, in the key.
"""

from .naming import Diagnosis, general

BY_CHANCE = 0.08  # how likely it may be, at most, that as many cases, drawn blindly, are all of one sort

# In this order: what is special of a case, as in PlainCase, and the name
SORTS = {
    "integers": "integer-truncation",
    "zero": "zero-special-case",
    "half turn": "half-turn-missed",
    "small": "small-values-dropped",
    "far": "digits-lost",
}


def by_place(exercise, outcomes):
    """The Diagnosis of answers that are wrong in special cases alone."""
    special = [case.get("special", ()) for case in exercise["cases"]]
    failing = [sorts for sorts, outcome in zip(special, outcomes) if not outcome.answered]
    for sort, identifier in SORTS.items():
        share = sum(sort in sorts for sorts in special) / len(special)
        if all(sort in sorts for sorts in failing) and share ** len(failing) < BY_CHANCE:
            return general(identifier)
    return Diagnosis()
