r"""Every number and every formula in the words of the notebooks, and of conventions.md, is what the code says.

- **Numbers** are compared with code by the claims in prose.txt. What no claim covers makes a test fail.
- **Formulas** with an equality are computed as they are written, in frames at random (formulas.py).
- **Points and minutes** in headings and openings are those of nbgrader's cells.
- **Predictions**: the folded answer has the numbers that `predict` takes for right; its reasons are prose like any other.

How to add a number: write a line into prose.txt, under the notebook and the cell's id, in the order of the text:

    [1_rotation frames-predict]
    lies # m in front of the robot and # to its :: ahead, right =
    $(…)$ :: ahead, -right, 0

Left of `::` stand the words around the number as they are in the cell (line breaks do not matter). `#` stands for one
number, also in words ("half a") or as \cos 45^\circ; `…` for some text and all numbers in it. Right of it stands code which
computes them: it sees the variables of the notebook as they are after the next code cell, or after any other one by
`at("cell-id")`, what a cell prints (`printed`), the reference solutions (`ref.chain`), and NAMES below. A number with
three digits or more, two decimals among them, may be rounded; any other is meant exactly. `names =` takes numbers that are
given, for later lines; they must be used, but for `_`, an example of which nothing follows. Words without a `#` or `…` must
stand there exactly so, and the code must be true.

    where p_b = taken

sets what a name in the formulas of the cell stands for; `where same origin` says that only rotations are spoken of. `--` begins
a comment.
"""

import ast
import io
import re
from contextlib import redirect_stdout
from dataclasses import dataclass, field, replace
from functools import cache
from inspect import signature
from math import pi
from types import SimpleNamespace

import nbformat
import numpy as np
import pytest
import support
import transform_lab
from formulas import BETWEEN, MEANT_EXACTLY, NUMBER, WORD, Unreadable, World, numbers, statements, wrong
from scipy.spatial.transform import Rotation
from support import ROOT
from transform_lab import tft
from transform_lab.judging.answers import TOLERANCE
from transform_lab.viewing import shapes

from autograder.exercises import EXERCISES

TEXTS = ROOT / "source/transforms"
CLAIMS = ROOT / "tests/notebooks/prose.txt"
NOTEBOOKS = sorted(path.stem for path in TEXTS.glob("*.ipynb"))
CONVENTIONS = "conventions"
PAGES = [CONVENTIONS, "glossary"]
SAME_ORIGIN = "same origin"  # what may follow "where": the cell speaks of rotations only

# Numerals that state nothing which code could compute.
NO_CLAIMS = {
    r"\[(notebook )?(\d)( [\w -]+)?\]\(\2_\w+\.ipynb\)|\*\*\d [\w -]+\*\* [→·]": "a link to another notebook, or this one",
    r"\b[234]x[234]\b": "the shape of a matrix",
    r"\bnotebook \d\b": "another notebook",
    r"^# \d · ": "the title",
    r"\bROS [12]\b|\bRViz 2\b|\btf2\b|\bpytransform3d\b": "a name",
    r"<details><summary>(Fourteen libraries|The same product)[^§]*?</details>": "measured in tests/libraries",
    r"`(Point|lookup_transform|rospy\.Publisher|node\.create_publisher)\([^`]*`|`ROS_PYTHON_CHECK_FIELDS=1`": "code to use",
    r"\bExamples? [12]\b": "a name",
    r"^\d\. ": "the number of an item",
    r"`(v\[:3\]|T\[:3, :3\] = R|T\[:3, 3\]|np\.append\(v, 1\)|(T = )?np\.eye\(4\))`": "code to use",
}
COUNTED = r"(?:centimetres|turns?|degrees|radians|points|minutes|digits)\b"  # words are numbers in front of these
NUMERAL = re.compile(
    rf"{NUMBER}|(?!(?:a|one|both|first|second|third|fourth)\b){WORD}(?: of an?| an?)?\s{COUNTED}|{WORD}\s(?:an?\s)?metres?\b",
    re.IGNORECASE,
)
FORMULA = re.compile(r"\$\$(?P<display>.+?)\$\$|\$(?P<inline>[^$]+?)\$|`(?P<code>\w+_T_\w+ = [^`]+)`", re.DOTALL)
HEADING = re.compile(r"^#+ (?:Exercise: `(?P<name>\w+)`|Question: .*) \((?P<points>\d+) points?\b", re.MULTILINE)
TOTAL = re.compile(r"About\s(?P<minutes>\d+)\sminutes,(?:[^\d]*\.)?[^\d.]*?\s(?P<points>\d+)\spoints\.")


def rot(degrees, axis):
    """The 4x4 turn about an axis, given by its letter or by three numbers."""
    return tft.rotation_matrix(np.radians(degrees), np.eye(3)["xyz".index(axis)] if isinstance(axis, str) else axis)


def quat(degrees, axis):
    """The quaternion x, y, z, w of that turn."""
    return tft.quaternion_from_matrix(rot(degrees, axis))


def angle(rotation):
    """The angle in degrees, 0 to 180, of a 3x3 or 4x4 matrix, a quaternion or a Pose."""
    if hasattr(rotation, "orientation"):
        rotation = flat(rotation.orientation)
    turn = Rotation.from_quat(rotation) if np.ndim(rotation) == 1 else Rotation.from_matrix(np.array(rotation)[:3, :3])
    return np.degrees(turn.magnitude())


def heading(R):
    """By how many degrees the first axis of a matrix points to the left, seen from above."""
    return np.degrees(np.arctan2(R[1][0], R[0][0]))


def distance(pose, other):
    """How far two poses are from each other, in metres."""
    return np.linalg.norm(np.subtract(flat(pose.position), flat(other.position)))


def same(one, other):
    """Whether two values are equal, number by number."""
    return np.allclose(flat(one), flat(other), rtol=0, atol=MEANT_EXACTLY)


def frames(seed=1, **options):
    """Frames, points and directions at random, by the names that formulas have for them."""
    return World(np.random.default_rng(seed), **options)


def true(formula, world=None, names=None):
    """Whether "a_T_c = a_T_b @ b_T_c", written as code, is so."""
    world = frames() if world is None else world
    left, right = (eval(side, names or {}, world) for side in formula.split(" = "))
    return same(left, right)


NAMES = {
    "np": np, "pi": pi, "norm": np.linalg.norm, "det": np.linalg.det, "tft": tft, "Rotation": Rotation, "shapes": shapes,
    "TOLERANCE": TOLERANCE, "default": lambda f, name: signature(f).parameters[name].default, "EXERCISES": EXERCISES,
    "ref": SimpleNamespace(**{name: exercise.reference for name, exercise in EXERCISES.items()}),
    **{name: getattr(transform_lab, name) for name in ("Point", "Pose", "PoseStamped", "Quaternion", "Viewer")},
    **{function.__name__: function for function in (rot, quat, angle, heading, distance, same, frames, true)},
}  # fmt: skip


@dataclass
class Cell:
    """A Markdown cell, what a prediction says, or a section of conventions.md.

    `names` are the variables after the code cell that follows; `right` and `wrong` are what a prediction takes for so.
    """

    id: str
    text: str
    names: dict = field(default_factory=dict)
    right: object = None
    wrong: tuple = ()


@dataclass(frozen=True)
class Claim:
    """A line of prose.txt: words around numbers, and the code that computes them."""

    words: str
    code: str

    @property
    def has_numbers(self):
        return bool(re.search("[#…]", self.words))

    def search(self, text, start):
        """The match in `text` from `start` on, with a group for each # and …"""
        pattern = ""
        for part in re.split(r"([#…]|\s+)", self.words):
            if part == "#":
                pattern += rf"({NUMBER}|(?i:{WORD}))"
            else:
                pattern += "(.+?)" if part == "…" else r"\s+" if part.isspace() else re.escape(part)
        return re.compile(pattern, re.DOTALL).search(text, start)

    def read(self, match):
        kinds = re.findall("[#…]", self.words)
        return [n for kind, text in zip(kinds, match.groups()) for n in numbers(text, words=kind == "#")]


def read_claims(text):
    """{(notebook, cell id): ([claims], [statements for the formulas])} from the lines of prose.txt."""
    found, here = {}, None
    for number, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        if not line or line.startswith("--"):
            continue
        if match := re.fullmatch(r"\[(\w+) ([\w-]+)\]", line):
            assert match.groups() not in found, f"prose.txt, line {number}: {line} is there twice; put them together"
            here = found[match.groups()] = ([], [])
        elif line.startswith("where "):
            here[1].append(line.removeprefix("where "))
        else:
            words, separator, code = line.partition(" :: ")
            assert separator and code, f"prose.txt, line {number}: write words :: code"
            here[0].append(Claim(words.strip(), code.strip()))
    return found


@cache
def notebook(name):
    """The notebook's Markdown cells, with the variables that its code cells make while they run in this process."""
    book = nbformat.read(TEXTS / f"{name}.ipynb", as_version=4)
    names, after, printed, predicted, waiting, cells = {"__name__": "__main__"}, {}, {}, {}, [], []
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TRANSFORM_LAB_GRADING", "1")  # nothing is drawn
        patch.setattr(transform_lab, "predict", lambda answer, wrong=(), **told: asked.append((answer, dict(wrong))))
        for cell in book.cells:
            if cell.cell_type == "markdown":
                waiting.append(Cell(cell.id, cell.source))
                cells.append(waiting[-1])
                continue
            asked = []
            with redirect_stdout(io.StringIO()) as output:
                exec(compile(cell.source, f"{name}, cell {cell.id}", "exec"), names)
            if asked:
                ((predicted[cell.id], wrong),) = asked
                text = "\n".join([*re.findall("^# (.*)", cell.source, re.MULTILINE), *wrong.values()])
                cells.append(Cell(cell.id, text, right=predicted[cell.id], wrong=tuple(wrong)))
                waiting.append(cells[-1])
                continue  # it makes no names
            after[cell.id], printed[cell.id] = dict(names), [value for value, _ in numbers(output.getvalue())]
            for text in waiting:
                text.names = after[cell.id]
            waiting.clear()
    for cell in cells:
        cell.names = {
            **cell.names, **NAMES, "points": points(name),
            "at": lambda cell_id: SimpleNamespace(**after[cell_id]), "printed": printed.__getitem__,
            "predicted": predicted.__getitem__,
        }  # fmt: skip
    return cells


@cache
def page(name):
    """The sections of conventions.md or of another page, each under the first words of its heading."""
    parts = re.split(r"^(?=## )", (TEXTS / f"{name}.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    titles = [re.match("#+ (.*?)[:,\n]", part)[1] for part in parts]
    return [Cell(re.sub(r"\W+", "-", title.lower()), part, NAMES) for title, part in zip(titles, parts)]


def texts(name):
    return page(name) if name in PAGES else notebook(name)


@cache
def points(name):
    """({exercise or cell id: points}, in the order of the notebook) of nbgrader's cells."""
    cells = nbformat.read(TEXTS / f"{name}.ipynb", as_version=4).cells
    graded = [cell.metadata.nbgrader for cell in cells if cell.metadata.get("nbgrader", {}).get("grade")]
    return {cell.grade_id: cell.points for cell in graded}


def flat(value):
    """The numbers of a value in order: of arrays, lists of them, messages."""
    if hasattr(value, "position"):
        return flat(value.position) + flat(value.orientation)
    if hasattr(value, "x"):
        return [getattr(value, axis) for axis in "xyzw" if hasattr(value, axis)]
    if isinstance(value, (list, tuple)):
        return [number for item in value for number in flat(item)]
    return np.ravel(np.asarray(value, float)).tolist()


def problems(name, cells, claims):
    """What is wrong with the numbers and formulas of a notebook's cells: a list of sentences."""
    found, given = [], {}
    for cell in cells:
        checked = _Checked(cell, *claims.get((name, cell.id), ((), ())), given)
        if name not in PAGES:
            checked.points(points(name))
        checked.claims()
        checked.formulas(shared_origin=name == NOTEBOOKS[0])
        checked.rest(name)
        found += [f"{name}, cell {cell.id}: {says}" for says in checked.problems]
    code = [c.code for at, (lines, _) in claims.items() if at[0] == name for c in lines if not c.code.endswith("=")]
    code += [line for at, (_, where) in claims.items() if at[0] == name for line in where if line != SAME_ORIGIN]
    used = {node.id for line in code for node in ast.walk(ast.parse(line)) if isinstance(node, ast.Name)}
    found += [f"{name}: {lost} is taken from the text in prose.txt and never used" for lost in {*given} - used - {"_"}]
    unknown = [cell_id for at, cell_id in claims if at == name and cell_id not in {cell.id for cell in cells}]
    return found + [f"{name} has no cell {cell_id}, of which prose.txt speaks" for cell_id in unknown]


class _Checked:
    """One cell while it is checked; `covered` tells which of its characters something has been compared with."""

    def __init__(self, cell, claims, where, given):
        self.cell, self.lines, self.where, self.given = cell, claims, where, given
        self.covered, self.problems = [False] * len(cell.text), []

    def cover(self, places):
        for place in places:
            self.covered[place] = True

    def points(self, of):
        for match in HEADING.finditer(self.cell.text):
            right = of.get(match["name"] or self.cell.id)
            self.compare(match, [(int(match["points"]), 0)], [right], "nbgrader's cell")
        for match in TOTAL.finditer(self.cell.text):
            self.compare(match, [(int(match["points"]), 0)], [sum(of.values())], "the sum of nbgrader's cells")
            if not 25 <= int(match["minutes"]) <= 100:
                self.problems.append(f"{match['minutes']} minutes: a notebook is made for 25 to 100")
            if int(match["minutes"]) > 60 and not re.search(r"places? to\s+stop", match[0]):
                self.problems.append(f"{match['minutes']} minutes: say where to stop")

    def claims(self):
        place = 0
        for claim in self.lines:
            match = claim.search(self.cell.text, place)
            if not match:
                before = ", behind the claim above it" if claim.search(self.cell.text, 0) else ""
                self.problems.append(
                    f"“{claim.words}” is not in the text{before}. Adapt this line of prose.txt to the text"
                )
                continue
            place = match.end()
            self.cover(range(*match.span()))
            try:
                self.claim(claim, match)
            except Exception as error:  # whatever the line's code raises is a matter of the text and of that line
                self.problems.append(f"“{match[0]}”: {claim.code} raises {type(error).__name__}: {error}")

    def claim(self, claim, match):
        said = claim.read(match)
        if claim.code.endswith("="):
            targets = claim.code.removesuffix("=").split(",")
            values = [value for value, _ in said]
            values = [np.array(values)] if len(targets) == 1 < len(values) else values
            self.given.update(zip((target.strip() for target in targets), values, strict=True))
            return
        value = eval(claim.code, {**self.cell.names, **self.given})
        if claim.has_numbers:
            self.compare(match, said, flat(value), claim.code)
        elif not value:
            self.problems.append(f"“{claim.words}” is not true: {claim.code}")

    def compare(self, match, said, right, code):
        self.cover(range(*match.span()))
        close = len(said) == len(right) and all(
            r is not None and abs(value - r) <= off * (1 + 1e-6) + MEANT_EXACTLY for (value, off), r in zip(said, right)
        )
        if not close:
            values = [value for value, _ in said]
            right = np.round(right, 9).tolist() if None not in right else right
            self.problems.append(
                f"“{match[0]}” says {values}, but {code} gives {right}. Correct the text, or prose.txt"
            )

    def formulas(self, shared_origin):
        for match in FORMULA.finditer(self.cell.text):
            says = set()
            for seed in range(3):
                world = World(np.random.default_rng(seed), shared_origin or SAME_ORIGIN in self.where)
                for line in self.where:
                    if line != SAME_ORIGIN:
                        exec(line, {**self.cell.names, **self.given}, world)
                says.add(self.formula(match, world))
            if problem := min(says - {None}, default=None):
                self.problems.append(problem)

    def formula(self, match, world):
        """What is wrong with a formula, or None."""
        if match["code"]:
            return None if true(match["code"], world, self.cell.names) else f"{match[0]} is not true"
        if all(self.covered[match.start() : match.end()]):
            return None
        tex = match["display"] or match["inline"]
        if not re.search(r"=|\\ne\b", tex):
            lacking = match["display"] and not any(self.covered[match.start() : match.end()])
            return f"nothing checks the formula {match[0]}. Write a line for it into prose.txt" if lacking else None
        try:
            problem = wrong(tex, world)
        except Unreadable as error:
            return (
                f"{match[0]} cannot be read: {error}. Say it by “where” in prose.txt, or teach formulas.py to read it"
            )
        begin = match.start("display") if match["display"] else match.start("inline")
        for piece in re.finditer(rf"(?:(?!{BETWEEN.pattern}).)+", tex, re.DOTALL):
            if statements(piece[0]):  # what else stands beside an equality is not computed
                self.cover(range(begin + piece.start(), begin + piece.end()))
        return problem

    def rest(self, name):
        """Every numeral that is left is a problem."""
        text = "".join("\n" if c == "\n" else " " if covered else c for c, covered in zip(self.cell.text, self.covered))
        for pattern in NO_CLAIMS:
            text = re.sub(pattern, lambda match: " " * len(match[0]), text, flags=re.MULTILINE)
        for match in NUMERAL.finditer(text):
            around = self.cell.text[max(0, match.start() - 40) : match.end() + 30].replace("\n", " ")
            self.problems.append(
                f"nothing computes the number {match[0].strip()} in “{around}”. Write a line into tests/notebooks/prose.txt under"
                f" [{name} {self.cell.id}]: the words around it, with # in its place :: the code that computes it"
            )


@cache
def claims():
    return read_claims(CLAIMS.read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", [*NOTEBOOKS, *PAGES])
def test_numbers_and_formulas_are_what_the_code_says(name):
    found = problems(name, texts(name), claims())
    assert not found, "\n".join(["", *found])


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_folded_answer_says_what_its_prediction_takes_for_right(name):
    cells = notebook(name)
    predictions = [(cell, cells[place + 1]) for place, cell in enumerate(cells) if cell.right is not None]
    assert predictions
    spoken_of = {
        spoken for at, (lines, _) in claims().items() if at[0] == name
        for line in lines for spoken in re.findall(r'predicted\("([\w-]+)"\)', line.code)
    }  # fmt: skip
    for prediction, answer in predictions:
        if isinstance(prediction.right, str):
            assert prediction.id in spoken_of, f"write a line into prose.txt on what {prediction.id} takes for right"
            continue
        right, said = flat(prediction.right), numbers(answer.text)
        runs = [said[start : start + len(right)] for start in range(len(said) - len(right) + 1)]
        close = [all(abs(v - r) <= off + MEANT_EXACTLY for (v, off), r in zip(run, right)) for run in runs]
        assert any(close), f"{answer.id} does not say {right}, which {prediction.id} takes for right"
        assert not [wrong for wrong in prediction.wrong if np.allclose(flat(wrong), right, atol=0.02)], prediction.id


def test_every_claim_speaks_of_a_text_that_there_is():
    assert {name for name, _ in claims()} <= {*NOTEBOOKS, *PAGES}


SUM = support.points("1_rotation")


@pytest.mark.parametrize(
    "name, cell_id, right, broken, says",
    [
        ("1_rotation", "turns-predict-unfold", "(-1, 0, 0)", "(1, 0, 0)", "says [1.0, 0.0, 0.0]"),
        ("1_rotation", "columns-say", "0 & -1 & 0", "0 & 1 & 0", "gives [0.0, -1.0, 0.0, 1.0"),
        (
            "1_rotation",
            "title",
            f"{SUM:g} points",
            f"{SUM + 1:g} points",
            f"the sum of nbgrader's cells gives [{SUM:g}]",
        ),
        ("1_rotation", "same-exercise", "(1 point)", "(2 points)", "nbgrader's cell gives [1]"),
        ("1_rotation", "quaternions-formula-unfold", "= 0.3827$", "= 0.3826$", "is not true"),
        (
            "2_homogeneous_transforms",
            "example-one-unfold",
            "raised by half a metre",
            "raised by a metre",
            "gives [45.0, 0.5]",
        ),
        ("2_homogeneous_transforms", "example-one", r"& -\sin 45", r"& \sin 45", "is not true"),
        ("3_chaining", "inner-names-say", "{}^A T_B \\; {}^B T_C", "{}^B T_C \\; {}^A T_B", "is not true"),
        ("3_chaining", "order-unfold", "You face left", "You walk 3 m, and face left", "nothing computes the number 3"),
        ("4_inversion", "undo-unfold", "(\\mathbf{p}_A - \\mathbf{t})", "(\\mathbf{p}_A + \\mathbf{t})", "is not true"),
        ("5_pre_grasp", "waypoints-say-unfold", "-0.241", "-0.242", "-0.241421356"),
        ("conventions", "the-example", "(−2, 1, −3)", "(−2, −1, −3)", "gives [-2.0, 1.0, -3.0]"),
        ("conventions", "frames", "`a_T_c = a_T_b @ b_T_c`", "`a_T_c = b_T_c @ a_T_b`", "is not true"),
        ("4_inversion", "robot", "Hand-eye", "$$ {}^A T_B $$ Hand-eye", "nothing checks the formula"),
    ],
)
def test_a_wrong_text_is_found(name, cell_id, right, broken, says):
    cells = [replace(c, text=c.text.replace(right, broken, 1)) if c.id == cell_id else c for c in texts(name)]
    assert cells != texts(name), "this test breaks a text that is no longer there: choose another one"
    found = problems(name, cells, claims())
    assert any(cell_id in problem and says in problem for problem in found), found
