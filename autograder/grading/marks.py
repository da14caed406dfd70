"""What nbgrader records of a graded notebook: the points of its cells, and who left a question unanswered."""

from dataclasses import dataclass, field

from nbgrader import utils


@dataclass
class Marks:
    """As nbgrader's own SaveAutoGrades would find them.

    scores: {cell: points, or None where a human has to grade}; comments: {cell: text or None}
    """

    scores: dict[str, float | None] = field(default_factory=dict)
    comments: dict[str, str | None] = field(default_factory=dict)


def marks(notebook):
    """The Marks of an autograded notebook."""
    found = Marks()
    for cell in notebook.cells:
        if utils.is_grade(cell):
            found.scores[cell.metadata.nbgrader.grade_id], _ = utils.determine_grade(cell)
        if utils.is_solution(cell):
            unchanged = cell.metadata.nbgrader.get("checksum") == utils.compute_checksum(cell)
            found.comments[cell.metadata.nbgrader.grade_id] = "No response." if unchanged else None
    return found


@dataclass
class CellGrade:
    """What a cell earned, by the grader or by a human; `waiting` for a human who has not given any yet.

    by_hand: a human has given it, or points beside those of the grader
    """

    earned: float
    most: float
    waiting: bool
    by_hand: bool = False


@dataclass
class NotebookGrades:
    """What the gradebook holds of one notebook: {cell: CellGrade}, {cell: comment}, and the points that being late costs."""

    cells: dict[str, CellGrade] = field(default_factory=dict)
    comments: dict = field(default_factory=dict)
    penalty: float = 0.0

    def by_hand(self, cell):
        """Whether a person has given the points of a cell."""
        return cell in self.cells and self.cells[cell].by_hand
