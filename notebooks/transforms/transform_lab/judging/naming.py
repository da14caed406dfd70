"""What a diagnosis is made of: ids, what the answers show and what helps; and those that any exercise can have."""

from typing import NamedTuple

# Failures that any exercise can have: what the answer shows, and what helps.
GENERAL = {
    "returned-none": ("Your function returned None.", "Does every path through it end in a `return` with a value?"),
    "wrong-type": (
        "Your function returned something of the wrong kind.",
        "Look at what the docstring says it returns.",
    ),
    "wrong-shape": ("Your function returned an array of the wrong shape.", "Print the answer's `.shape` and compare."),
    "not-finite": (
        "Your answer contains NaN or infinity.",
        "Look for a division by zero, or a root of a negative number.",
    ),
    "breaks-down": (
        "Your answer is right wherever its formula works, and in the other cases it breaks down.",
        "There something is divided by zero, or has no inverse, or no root. Treat such arguments by themselves, or find "
        "another formula.",
    ),
    "input-mutated": (
        "Your function changed one of its arguments.",
        "Whoever called it still needs the original. A plain `=` copies nothing, it only gives a second name: build a new object "
        "from the numbers, or work on a copy.",
    ),
    "hard-coded": (
        "Your function gives the same answer whatever it is given.",
        "Compute the answer from the arguments; the check calls it with many different ones.",
    ),
    "mutable-default": (
        "Your function gives another answer when it is called again with the same arguments.",
        "It remembers earlier calls. Does it change a default argument, such as `pose=Pose()`, or something made outside of it? "
        "Make a new object in each call.",
    ),
    "argument-returned": (
        "Your function returns the very object that it was given, where a new one was asked for.",
        "Whoever changes the answer would change the argument, too: make a new object, and fill in its numbers.",
    ),
    "not-normalised": (
        "Your quaternion has the right direction, but its length is not 1.",
        "An orientation is a unit quaternion: divide by its length.",
    ),
    "rounded": (
        "Your answer is right, but rounded.",
        "Return all the digits there are; round when you print.",
    ),
    "integer-truncation": (
        "Your function goes wrong where an argument is made of whole numbers, and is right everywhere else.",
        "An array that takes its type from whole numbers, as a copy does, or `zeros_like`, keeps whole numbers alone: "
        "begin with an array of floats, such as `np.eye(4)` or `np.zeros(3)`.",
    ),
    "zero-special-case": (
        "Your function goes wrong where a turn or a distance is zero, and is right everywhere else.",
        "Is there a case of its own for that, which forgets the rest? A frame may be moved without being turned, or turned "
        "where it is.",
    ),
    "half-turn-missed": (
        "Your function goes wrong at a half turn or near it, and is right everywhere else.",
        "There w is 0, and so is the sine of the angle: do you divide by one of them, or by something as small?",
    ),
    "small-values-dropped": (
        "Your function goes wrong where a turn, a distance or a difference is small, and is right everywhere else.",
        "Is something small taken for nothing, by a tolerance? Do without that special case, or keep it for exact zeros.",
    ),
    "digits-lost": (
        "Your function goes wrong where distances or angles are large, and is right everywhere else.",
        "Is a tolerance relative to the size of the numbers (`rtol`, `rcond`), or are they kept in single precision?",
    ),
    "sign-slip": (
        "All numbers have the right size, but some have the wrong sign.",
        "Where can a sign get lost, or turn round? In a root, in an `abs`, in a cross product in the other order, at a minus.",
    ),
    "entry-slip": (
        "A single number is wrong, always the same, and all others are right.",
        "Go through what you wrote for this place, letter by letter: an index, a sign, a factor.",
    ),
    "too-strict": (
        "You answer False to some that deserve True; whatever deserves False gets it.",
        "Which of your conditions do they not meet? Is it asked for, and does it allow for rounding?",
    ),
    "too-generous": (
        "You answer True to some that deserve False; whatever deserves True gets it.",
        "Which property of a right one do they lack, and does your function look at it?",
    ),
}


class Diagnosis(NamedTuple):
    """ids of the misconceptions (none when nothing explains the answers), what they show, and what helps."""

    ids: tuple = ()
    says: str = ""
    hint: str = ""

    def __bool__(self):
        return bool(self.ids)


def general(identifier, says="", hint=""):
    """The Diagnosis of a failure that any exercise can have; `says` and `hint` where there is more to say than in GENERAL."""
    usual = GENERAL[identifier]
    return Diagnosis((identifier,), says or usual[0], hint or usual[1])


def shared(misconceptions):
    """The Diagnosis that these misconceptions (plain data) share; None without any, and when they have different names."""
    if len({misconception["id"] for misconception in misconceptions}) != 1:
        return None
    first = misconceptions[0]
    return Diagnosis(tuple(first["id"].split(";")), first["says"], first["hint"])


def joined(found):
    """Several Diagnoses as one: a line for each mistake in what is said, and the same line in the hint."""
    ids = tuple(dict.fromkeys(identifier for one in found for identifier in one.ids))
    return Diagnosis(ids, *together(*((one.says, one.hint) for one in found if one.says)))


def together(*messages: tuple[str, str]) -> tuple[str, str]:
    """(says, hint) of several mistakes, from the (says, hint) of each: the n-th line of both is about the n-th mistake."""
    says, hints = zip(*dict.fromkeys(messages))
    return "\n".join(says), "\n".join(hints)
