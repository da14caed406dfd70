r"""Reads the numbers and formulas of the notebooks' prose, in plain text and in LaTeX, and says whether a formula is true.

A formula is true when its sides agree in a `World`, a handful of frames and a point thrown at random: `{}^A T_B` is frame B
described in frame A there, `\mathbf{p}_B` the point described in B, `\mathbf{x}_B` B's x axis described in A, and so on. So
formulas need no list: each is computed as it is written.
"""

import math
import re

import numpy as np
from transform_lab import tft

WORDS = {
    "zero": 0, "half a": 0.5, "half": 0.5, "a quarter": 0.25, "quarter": 0.25, "a third": 1 / 3, "a": 1, "once": 1, "first": 1,
    "second": 2, "third": 3, "fourth": 4, "twice": 2, "both": 2, "one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6,
    "seven": 7, "eight": 8, "nine": 9, "ten": 10, "twelve": 12, "sixteen": 16,
}  # fmt: skip
WORD = rf"\b(?:{'|'.join(sorted(WORDS, key=len, reverse=True))})\b"
PLAIN = r"\d+(?:\.\d+)?(?:e-?\d+)?"
NUMBER = (
    rf"[-−+]?\s?(?:\\(?:sin|cos|tan)\s?{PLAIN}(?:\^\\circ)?|\\sqrt\{{{PLAIN}\}}|\\t?frac\{{{PLAIN}\}}\{{{PLAIN}\}}"
    rf"|{PLAIN}\\pi|\\pi|{PLAIN}(?:\s(?:cm|centimetres)\b)?)"
)
MEANT_EXACTLY = 1e-9


def rounding(literal):
    """How far a number may be off that is written so: half a unit of its last digit if it has three digits or more, two
    decimals among them, as 36.87 and 0.707; others, as 22.5 and 0.85, are meant exactly."""
    digits, _, exponent = literal.partition("e")
    decimals = len(digits.partition(".")[2])
    if decimals < 2 or len(digits.replace(".", "").lstrip("0")) < 3:
        return 0.0
    return 0.5 * 10.0 ** (int(exponent or 0) - decimals)


def numbers(text, words=False):
    """[(value, how far it may be off)] of the numbers in `text`, in order; lengths in centimetres are told in metres."""
    found = re.findall(f"{NUMBER}|{WORD}" if words else NUMBER, text, flags=re.IGNORECASE)
    return [_number(literal) for literal in found]


def _number(literal):
    if literal.lower() in WORDS:
        return WORDS[literal.lower()], 0.0
    plain, metres = re.subn(r"\s(?:cm|centimetres)$", "", literal)
    value, off = measured(plain, {})
    return (value * 0.01, off * 0.01) if metres else (value, off)


# Formulas


class World(dict):
    """What the names in a formula stand for: frames, a point and a quaternion at random, and what is put into it.

    `shared_origin`: all frames have one origin, as where only rotations are spoken of.
    """

    def __init__(self, random, shared_origin=False):
        self._random, self._shared_origin = random, shared_origin
        self._frames = {"a": self._frame()}
        self._frames["box"] = self._frames["a"]  # the empty box to fill in, in notebook 4
        self._point = np.append(random.uniform(-2, 2, 3), 1)
        angle, axis = random.uniform(0, 4 * math.pi), tft.unit_vector(random.normal(size=3))
        q = tft.quaternion_about_axis(angle, axis)
        self.update(zip("xyzw", q), q=q, theta=angle, u=axis, **dict(zip(("u_x", "u_y", "u_z"), axis)))
        self.update(M=self._frame(), I=None)

    def _frame(self):
        T = tft.random_rotation_matrix(self._random.random(3))
        if not self._shared_origin:
            T[:3, 3] = self._random.uniform(-2, 2, 3)
        return T

    def _described(self, frame, in_frame):
        for name in (frame, in_frame):
            if name not in self._frames:
                self._frames[name] = self._frame()
        return np.linalg.inv(self._frames[in_frame]) @ self._frames[frame]

    def __missing__(self, name):
        if match := re.fullmatch(r"([a-z]+)_([TR])_([a-z]+)", name):
            in_frame, kind, frame = match.groups()
            T = self._described(frame, in_frame)
            value = T if kind == "T" else T[:3, :3]
        elif match := re.fullmatch("p_([a-z]+)", name):
            value = (np.linalg.inv(self._described(match[1], "a")) @ self._point)[:3]
        elif match := re.fullmatch("([xyz])_([a-z])", name):
            value = self._described(match[2], "a")[:3, "xyz".index(match[1])]
        elif name in ("R", "t"):
            value = self["a_T_b"][:3, :3] if name == "R" else self["a_T_b"][:3, 3]
        else:
            raise KeyError(name)
        self[name] = value
        return value


class Unreadable(ValueError):
    """A formula has something in it that is not understood here."""


SPACES = re.compile(r"(?<!\\)\\[,;:! ]|\\quad|\s+|~")
BETWEEN = re.compile(r"\\qquad|\\text\{[^{}]*\}|\\Longrightarrow|\\longleftrightarrow")
TOKEN = re.compile(rf"{PLAIN}|\\[a-zA-Z]+|R\((?=-?q)|[a-zA-Z]|\\\\|.", re.DOTALL)


def statements(formula):
    """The equalities and inequalities in a formula, as [(left side, "=" or "≠", right side)]."""
    found = []
    for part in BETWEEN.split(formula.replace(r"pre\text{-}grasp", "{pregrasp}").replace("−", "-")):
        pieces = re.split(r"(=|\\ne\b)", part)
        for left, relation, right in zip(pieces[0::2], pieces[1::2], pieces[2::2]):
            found.append((left, "=" if relation == "=" else "≠", right))
    return found


def wrong(formula, world):
    """What is wrong with the formula in this world, or None."""
    for left, relation, right in statements(formula):
        (one, off), (other, off_too) = measured(left, world), measured(right, world)
        one, other = (np.eye(len(y)) if x is None else x for x, y in ((one, other), (other, one)))
        if np.shape(one) != np.shape(other):
            return f"{left.strip()} and {right.strip()} are not of one kind"
        if np.all(np.abs(one - other) <= off + off_too + MEANT_EXACTLY) != (relation == "="):
            return f"{left.strip()} {relation} {right.strip()} is not true: {np.round(one, 4)} and {np.round(other, 4)}"
    return None


def measured(formula, world):
    """(value, how far it may be off for the rounding of the numbers in it) of a formula without "="."""
    value = _Reader(formula, world).value
    count = len(re.findall(PLAIN, formula))
    if value is None or count == 0:
        return value, 0.0
    shifted = [_Reader(formula, world, shift=i).value for i in range(count)]
    return value, sum(np.abs(np.subtract(other, value)) for other in shifted)


class _Reader:
    """Computes a formula while it reads it from left to right. The number of index `shift` is taken a rounding larger."""

    def __init__(self, formula, world, shift=None):
        formula = formula.replace("−", "-").replace("{}^", "‹")
        self.tokens = [
            t for t in TOKEN.findall(SPACES.sub(" ", formula)) if t != " " and t not in (r"\left", r"\right")
        ]
        self.world, self.shift, self.numbers = world, shift, 0
        self.value = self.sum()
        if self.tokens:
            raise Unreadable(f"{formula.strip()} cannot be read from {' '.join(self.tokens)} on")

    def next(self):
        return self.tokens[0] if self.tokens else ""

    def take(self, expected=None):
        if not self.tokens or (expected and self.tokens[0] != expected):
            raise Unreadable(f"{expected or 'something'} is missing before {' '.join(self.tokens) or 'the end'}")
        return self.tokens.pop(0)

    def accept(self, token):
        return self.take() if self.next() == token else None

    def sum(self):
        sign = -1 if self.accept("-") else 1
        self.accept("+")
        total = sign * self.product() if sign < 0 else self.product()
        while self.next() in ("+", "-"):
            total = total + self.product() if self.take() == "+" else total - self.product()
        return total

    def product(self):
        value = self.factor()
        while self.next() not in ("", "+", "-", ",", ")", "}", "&", r"\\", r"\end"):
            if self.accept(r"\times"):
                value = np.cross(value, self.factor())
            elif self.accept("/"):
                value = value / self.factor()
            else:
                value = times(value, self.factor())
        return value

    def factor(self):
        value = self.atom()
        while self.accept("^"):
            power = "".join(self.group() if self.next() == "{" else [self.take()])
            if power == r"\mathsf":
                self.group()
                value = np.transpose(value)
            elif power == r"\circ":
                value = math.radians(value)
            elif power == "-1":
                value = np.linalg.inv(value)
            else:
                value = value ** float(power)
        return value

    def group(self):
        """The tokens within { }."""
        self.take("{")
        inner, depth = [], 1
        while depth:
            inner.append(self.take())
            depth += {"{": 1, "}": -1}.get(inner[-1], 0)
        return inner[:-1]

    def braced(self):
        self.take("{")
        value = self.sum()
        self.take("}")
        return value

    def atom(self):
        token = self.take()
        if re.fullmatch(PLAIN, token):
            self.numbers += 1
            return float(token) + (rounding(token) if self.numbers - 1 == self.shift else 0)
        if token == r"\pi":
            return math.pi
        if token == r"\sqrt":
            return math.sqrt(self.braced())
        if token in (r"\frac", r"\tfrac"):
            return self.braced() / self.braced()
        if token in (r"\sin", r"\cos", r"\tan"):
            function = getattr(math, token[1:])
            if self.accept("^"):  # the square, of any angle
                return function(self.world["theta"]) ** float(self.take())
            return function(self.factor())
        if token == "(":
            return self.listed()
        if token == "R(":
            return tft.quaternion_matrix(self.listed())[:3, :3]
        if token == r"\begin":
            self.group()
            return self.matrix()
        name = self.name(token)
        if name == "0":
            return np.zeros(3)
        try:
            return self.world[name]
        except KeyError:
            raise Unreadable(f"what {name or token} stands for is not said") from None

    def listed(self):
        values = [self.sum()]
        while self.accept(","):
            values.append(self.sum())
        self.take(")")
        return values[0] if len(values) == 1 else np.hstack(values)

    def matrix(self):
        rows = [[]]
        while not self.accept(r"\end"):
            if self.accept(r"\\"):
                rows.append([])
            elif self.accept("|"):  # drawn to show that a column is one thing
                pass
            elif not self.accept("&"):
                rows[-1].append(self.sum())
        self.group()
        return np.vstack([np.column_stack([np.atleast_1d(entry) for entry in row]) for row in rows if row])

    def name(self, token):
        """The name of what is spoken of, as in code: a_T_b for {}^A T_B, p_b for \\mathbf{p}_B."""
        before = ""
        if token == "‹":  # an index in front, {}^A
            before = f"{self.letters()}_"
            token = self.take()
        letter = "".join(self.group()) if token == r"\mathbf" else token.lstrip("\\")
        after = f"_{self.letters()}" if self.accept("_") else ""
        if before and letter == "p":
            return f"p_{before[:-1]}"
        return f"{before}{letter}{after}"

    def letters(self):
        tokens = self.group() if self.next() == "{" else [self.take()]
        return "".join(t.lstrip("\\") for t in tokens if t not in "{}").lower()


def times(one, other):
    """A product as it is written on paper: of numbers, matrices, quaternions, and of a transform and a point."""
    if np.shape(one) == (4, 4) and np.shape(other) == (3,):
        return (one @ np.append(other, 1))[:3]
    return one @ other if np.ndim(one) and np.ndim(other) else one * other
