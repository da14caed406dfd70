"""The command line of `python3 -m autograder`: what each command asks for. What it does, commands.py, is loaded to do it."""

import argparse
import os
from pathlib import Path

from . import ASSIGNMENT

COLLECT = "sort what an LMS gives as all submissions into submitted/, and say who came from what"
COLLECT_AT_LENGTH = """\
Takes "download all submissions" as it comes: zip files, or folders that they were unpacked into; of several, the later one
counts. It sees which system a download is of, and puts the newest of each notebook into submitted/STUDENT/transforms/,
unless what is there is newer or was changed by hand. Running it again changes nothing. Exit 0: done; 1: something was left
that needs a look; 2: nothing was done.
"""

PROVE = "say what the cases of an exercise do not catch, and which case would"
PROVE_AT_LENGTH = """\
Says of each exercise whether its cases, as many seeds draw them, catch all misconceptions (and name each by its own id
alone), all mutants of the reference and of the notebook's solution (except those that the specification declares as
equivalent), and your own wrong solutions; and whether they accept your right ones. For what slips through, it searches
for a case that would catch it, and prints it as code. Exit 0: nothing is open; 1: something is.

Your own solutions are functions in any file of tests/solutions/:

    from solutions.right import right
    from solutions.wrong import wrong

    @right("chain")
    def one_by_one(*transforms): ...

    @wrong("chain", "order-reversed")
    def from_the_back(*transforms): ...
"""


def run(arguments):
    """Run one command; the exit code: 0 done, 1 done but with something to look at, 2 not done."""
    parser = _parser()
    options, options.extra = parser.parse_known_args(arguments)
    if options.extra and options.command not in ("lab", "test"):
        parser.error(f"unrecognized arguments: {' '.join(options.extra)}")
    from .commands import run

    return run(options)


def _parser():
    parser = argparse.ArgumentParser(
        prog="python3 -m autograder", description="Courseware and grader for the transform lab."
    )
    commands = parser.add_subparsers(required=True, dest="command", metavar="COMMAND")

    def add(name, help):
        return commands.add_parser(name, help=help, description=help)

    def sandbox_options(sub):
        sub.add_argument("--unsafe-no-sandbox", action="store_true", help="run students' code without protection")
        sub.add_argument("--seed", type=_natural, help="draw the hidden cases from this seed, to repeat a run")

    sub = add("demo", "grade a small class of realistic submissions, with feedback and the class report")
    sub.add_argument("--remove", action="store_true", help="remove the demo's class again")
    add("lab", "open the student's notebooks in JupyterLab; other options are passed on to it")
    add("release", "make notebooks/ from source/ and say what changed")
    sub = add("collect", COLLECT)
    sub.formatter_class = argparse.RawDescriptionHelpFormatter
    sub.description = COLLECT_AT_LENGTH
    sub.add_argument("downloads", nargs="+", type=Path, metavar="FILE-OR-FOLDER", help="as the LMS gives it")
    sub.add_argument(
        "--students",
        action="append",
        default=[],
        type=Path,
        metavar="FILE",
        help="a class list in CSV, as an LMS or nbgrader exports it; also Moodle's grading worksheet; may be given several times",
    )
    sub.add_argument(
        "--from", dest="system", metavar="NAME", help="the system, where that cannot be seen, such as canvas"
    )
    sub.add_argument(
        "--timezone",
        metavar="NAME",
        help="where the LMS's server is, such as Europe/Berlin, for times in its files' names (default: as this machine)",
    )
    sub.add_argument("--dry-run", action="store_true", help="say the same and write nothing")
    sub = add("grade", "grade submitted/ into the gradebook, autograded/, feedback/ and reports/")
    sub.add_argument("students", nargs="*", metavar="STUDENT", help="only these (default: everybody)")
    sub.add_argument("--force", action="store_true", help="grade again what is unchanged")
    sub.add_argument(
        "--jobs", type=_positive, default=os.cpu_count(), help="submissions at a time (default: all cores)"
    )
    sub.add_argument(
        "--scheduler", metavar="ADDRESS", help="grade on the workers of a Dask scheduler, such as tcp://host:8786"
    )
    sub.add_argument("--no-feedback", action="store_true", help="leave out the feedback pages")
    sandbox_options(sub)
    sub = add("report", "write the class report from what is graded")
    sub.add_argument(
        "--compare",
        type=Path,
        metavar="PATH",
        help="with another class: its verdicts.csv, or a term's folder in archive/",
    )
    sub = add("extend", "give a student more time, and say what being late costs then")
    sub.add_argument("student", metavar="STUDENT", help="as the folder in submitted/ is called")
    for unit in ("days", "hours"):
        sub.add_argument(
            f"--{unit}",
            type=_number,
            default=0.0,
            metavar="N",
            help=f"{unit} after the due date; neither takes it back",
        )
    sub = add("term", "begin a new term: the old one's work goes into archive/, the course gets another name")
    sub.add_argument(
        "name", metavar="NAME", help="the course's new name in nbgrader's exchange, such as transforms-2027"
    )
    sub = add("check", "grade one student's notebook files without a course; exit 1 unless all points are earned")
    sub.add_argument(
        "notebooks", nargs="+", type=Path, metavar="NOTEBOOK", help="files, or the folder with all of them"
    )
    sub.add_argument("--summary", type=Path, metavar="FILE", help="append the table as Markdown (for GitHub Actions)")
    sandbox_options(sub)
    sub = add("prove", PROVE)
    sub.formatter_class = argparse.RawDescriptionHelpFormatter
    sub.description = PROVE_AT_LENGTH
    sub.add_argument("exercises", nargs="*", metavar="EXERCISE", help="only these (default: all)")
    sub.add_argument(
        "--seeds", type=_positive, default=30, help="draw the cases from so many seeds (default: 30; the tests: 51)"
    )

    def hub_options(sub, required):
        sub.add_argument(
            "--environment", type=Path, required=required, metavar="FOLDER", help="in which students' servers run"
        )
        sub.add_argument(
            "--instructor-config",
            type=Path,
            required=required,
            metavar="FOLDER",
            help="for the settings that instructors have besides",
        )
        sub.add_argument(
            "--exchange",
            type=Path,
            default=Path("/srv/nbgrader/exchange"),
            metavar="FOLDER",
            help="which all servers share (default: /srv/nbgrader/exchange)",
        )

    sub = add("hub", "set this course up on a JupyterHub, as its administrator, and say what the hub has to be told")
    hub_options(sub, required=True)
    sub = add("doctor", "say what protects grading on this machine, and what does not")
    sub.add_argument("--hub", action="store_true", help="and what of a JupyterHub is not as `hub` leaves it")
    hub_options(sub, required=False)
    sub = add("package", "make zips: the notebooks for a learning management system, the grader for Gradescope")
    sub.add_argument(
        "--output",
        type=Path,
        default=Path(),
        metavar="PATH",
        help="the folder to put both into (default: this one), or a file named *.zip for that of the notebooks alone",
    )
    sub = add("export", "write the gradebook's points as CSV: as a table, or as an LMS imports them")
    sub.add_argument(
        "--format",
        default="plain",
        metavar="NAME",
        help="columns: plain, or those that an LMS imports, such as canvas (default: plain)",
    )
    sub.add_argument(
        "--column",
        metavar="NAME",
        default=ASSIGNMENT,
        help=f"the assignment's name in the LMS (default: {ASSIGNMENT})",
    )
    sub.add_argument("--output", type=Path, default=Path("-"), help="a file (default: print)")
    sub = add("test", "run the quick tests; other options are passed on to pytest, and choose among all tests")
    sub.add_argument("--all", action="store_true", help="all tests: in sandboxes, in a browser, of whole classes, too")
    return parser


def _natural(text):
    number = int(text)
    if number < 0:
        raise ValueError
    return number


def _number(text):
    number = float(text)
    if not 0 <= number <= 10_000:
        raise ValueError
    return number


def _positive(text):
    if _natural(text) == 0:
        raise ValueError
    return int(text)


_natural.__name__, _positive.__name__, _number.__name__ = (
    "whole number",
    "positive number",
    "number",
)  # as argparse names them in its errors
