"""What being late costs: the due date, the policy of nbgrader's plug-in, and extensions, as they are now.

nbgrader reckons it once, when a submission is graded. Here it is reckoned whenever the gradebook is opened, so what is changed
later holds for everybody, and nobody need be graded again for it.
"""

from datetime import timedelta

from nbgrader.api import Assignment, MissingEntry, SubmittedAssignment, SubmittedNotebook
from nbgrader.preprocessors import AssignLatePenalties
from sqlalchemy import or_, select

from ..course import ASSIGNMENT, CourseError

NO_DUE_DATE = (
    "The assignment has no due date, so nobody is late. To set one: "
    f'`nbgrader db assignment add {ASSIGNMENT} --duedate "2027-01-31 18:00 UTC"`, or in the formgrader.'
)


def penalize(gradebook, config, student=None):
    """Write what being late costs each notebook of those who are late, or once were; of one student, or of all.

    config: nbgrader's, which names the plug-in; raises CourseError when that fails
    """
    late = or_(
        SubmittedNotebook.late_submission_penalty.is_not(None),
        SubmittedAssignment.timestamp > Assignment.duedate,
        SubmittedAssignment.extension.is_not(None),
    )
    whose = select(SubmittedAssignment.id).join(Assignment).join(SubmittedAssignment.notebooks)
    whose = whose.where(Assignment.name == ASSIGNMENT, late)
    if student:
        whose = whose.where(SubmittedAssignment.student_id == student)
    found = gradebook.db.scalars(select(SubmittedAssignment).where(SubmittedAssignment.id.in_(whose))).all()
    if found:
        cost = _policy(config)
        for submission in found:
            seconds = seconds_late(submission)
            for notebook in submission.notebooks:
                notebook.late_submission_penalty = cost(submission.student_id, notebook.score, seconds)
        gradebook.db.commit()


def seconds_late(submission):
    """By how many seconds a submission came after its due date, extension included."""
    # nbgrader adds the extension to the due date even where there is none.
    return 0 if submission.assignment.duedate is None else submission.total_seconds_late


def _policy(config):
    """From (student, points of a notebook, seconds late) to the points that being late costs, None where it is not late."""

    def cost(student, score, seconds):
        if seconds <= 0:
            return None
        try:
            points = step.plugin_inst.late_submission_penalty(student, score, seconds)
            return None if points is None else min(max(float(points), 0.0), score)
        except Exception as error:
            raise _failed(error) from error

    try:
        step = AssignLatePenalties(config=config)
        step.init_plugin()
    except Exception as error:
        raise _failed(error) from error
    return cost


def _failed(error):
    return CourseError(
        "What being late costs cannot be reckoned: the plug-in that nbgrader_config.py names for it "
        f"(AssignLatePenalties.plugin_class, else nbgrader's own) failed with {type(error).__name__}: {error}"
    )


def extend(gradebook, config, student, extension: timedelta):
    """Give a student more time, in the place of what was given before; nothing takes it back. Returns a line about it."""
    try:
        submission = gradebook.find_submission(ASSIGNMENT, student)
    except MissingEntry:
        raise CourseError(
            f"{student} is not in the gradebook with a submission, and nbgrader keeps an extension with that. Collect and "
            "grade it first; the extension then takes back what being late has cost."
        ) from None
    if submission.assignment.duedate is None:
        raise CourseError(NO_DUE_DATE)
    gradebook.grant_extension(ASSIGNMENT, student, minutes=extension / timedelta(minutes=1))
    penalize(gradebook, config, student)
    due, seconds = submission.duedate, seconds_late(submission)
    came = (
        f"handed in {submission.timestamp:%Y-%m-%d %H:%M} UTC"
        if submission.timestamp
        else "handed in at an unknown time"
    )
    late = f"{timedelta(seconds=int(seconds))} late, which costs {submission.late_submission_penalty:g} points"
    return f"{student}: due {due:%Y-%m-%d %H:%M} UTC, {came}: {late if seconds else 'not late'}."
