"""The commands of `python3 -m autograder`: what each one asks for, does and prints."""

import argparse
import difflib
import os
import subprocess
import sys
import zipfile
from pathlib import Path

from rich.console import Console
from rich.table import Table

from .course import ASSIGNMENT, Course, CourseError

console = Console(highlight=False, soft_wrap=True)
errors = Console(stderr=True, highlight=False, soft_wrap=True)

UNPROTECTED = (
    "[bold red]NOT PROTECTED:[/] students' code runs as you, without a sandbox: it can read and change your files, the "
    "gradebook and other students' work, and use the network."
)


def run(arguments):
    """Run one command; the exit code: 0 done, 1 done but with something to look at, 2 not done."""
    options = _parser().parse_args(arguments)
    try:
        return options.command(options)
    except CourseError as error:
        errors.print(str(error), markup=False)
        return 2
    except KeyboardInterrupt:
        errors.print("Stopped. What was graded is kept; run the same command to go on.")
        return 130


def _parser():
    parser = argparse.ArgumentParser(
        prog="python3 -m autograder", description="Courseware and grader for the transform lab."
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def add(name, command, help):
        sub = commands.add_parser(name, help=help, description=help)
        sub.set_defaults(command=command)
        return sub

    def sandbox_options(sub):
        sub.add_argument("--unsafe-no-sandbox", action="store_true", help="run students' code without protection")
        sub.add_argument("--seed", type=int, help="draw the hidden cases from this seed, to repeat a run")

    sub = add("demo", demo, "grade a small class of realistic submissions, with feedback and the class report")
    sub.add_argument("--remove", action="store_true", help="remove the demo's class again")
    sub = add("lab", lab, "open the student's notebooks in JupyterLab")
    sub.add_argument("arguments", nargs=argparse.REMAINDER, help="passed on to JupyterLab, such as --port=8889")
    add("release", release, "make notebooks/ from source/ and say what changed")
    sub = add("grade", grade, "grade submitted/ into the gradebook, autograded/, feedback/ and reports/")
    sub.add_argument("students", nargs="*", metavar="STUDENT", help="only these (default: everybody)")
    sub.add_argument("--force", action="store_true", help="grade again what is unchanged")
    sub.add_argument("--jobs", type=int, default=os.cpu_count(), help="submissions at a time (default: all cores)")
    sub.add_argument("--no-feedback", action="store_true", help="leave out nbgrader's feedback pages")
    sandbox_options(sub)
    add("report", report, "write the class report from what is graded")
    sub = add(
        "check", check, "grade one student's notebook files without a course; exit 1 unless all points are earned"
    )
    sub.add_argument("notebooks", nargs="+", type=Path, metavar="NOTEBOOK")
    sandbox_options(sub)
    add("doctor", doctor, "say what protects grading on this machine, and what does not")
    sub = add("package", package, "make a zip of the notebooks for a learning management system")
    sub.add_argument("--output", type=Path, default=Path(f"{ASSIGNMENT}.zip"))
    sub = add("export", export, "write the gradebook's points as CSV")
    sub.add_argument("--output", type=Path, default=Path("-"), help="a file (default: print)")
    sub = add("test", test, "run all tests")
    sub.add_argument("arguments", nargs=argparse.REMAINDER, help="passed on to pytest")
    return parser


def course():
    return Course(Path.cwd())


# --- students and release -------------------------------------------------------------------------------------------


def lab(options):
    folder = course().release
    if not folder.is_dir():
        raise CourseError("There are no notebooks yet: run `python3 -m autograder release` first.")
    return subprocess.call([sys.executable, "-m", "jupyterlab", str(folder), *options.arguments])


def release(options):
    from .release import release as make

    changes = make(course())
    for change in changes:
        console.print(change, markup=False)
    console.print(f"notebooks/{ASSIGNMENT} is {'up to date' if not changes else 'made anew'}.")
    return 0


def package(options):
    """The same bytes for the same notebooks: sorted names, one date."""
    folder = course().release
    paths = [path for path in sorted(folder.rglob("*")) if path.is_file() and "__pycache__" not in path.parts]
    if not paths:
        raise CourseError("There is nothing to package: run `python3 -m autograder release` first.")
    with zipfile.ZipFile(options.output, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in paths:
            name = Path(ASSIGNMENT, path.relative_to(folder)).as_posix()
            archive.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), path.read_bytes(), zipfile.ZIP_DEFLATED)
    console.print(f"{options.output}: {len(paths)} files.", markup=False)
    return 0


# --- grading --------------------------------------------------------------------------------------------------------


def grade(options):
    here = course()
    protected = _protection(options.unsafe_no_sandbox)
    students = here.students()
    chosen, unknown = [], []
    for student in options.students or students:
        (chosen if student in students else unknown).append(student)
    for student in unknown:
        near = difflib.get_close_matches(student, students, 1)
        meant = f" Did you mean {near[0]}?" if near else ""
        errors.print(f"{student}: no submission in submitted/{student}/{ASSIGNMENT}.{meant}", markup=False)
    failed = _grade(here, chosen, options, protected)
    return 1 if unknown or failed else 0


def _protection(unsafe):
    """Whether sandboxes are used; refuses when they cannot be and nobody asked to go without."""
    from . import sandbox

    if unsafe:
        errors.print(UNPROTECTED)
        return False
    problem = sandbox.problem()
    if problem:
        raise CourseError(f"{problem}\nNothing was graded. To grade without protection: --unsafe-no-sandbox")
    return True


def _grade(here, students, options, protected):
    from . import feedback, report
    from .classroom import grade_class
    from .gradebook import Writer
    from .grading import assignment, new_seed

    seed = new_seed() if options.seed is None else options.seed
    failed = []
    with Writer(here) as writer:
        against = assignment(here, seed, isolated=protected)
        fresh = []
        with _progress() as progress:
            bar = progress.add_task("grading", total=len(students))
            for student, graded, problem in grade_class(here, students, against, writer, options.jobs, options.force):
                progress.advance(bar)
                if problem:
                    failed.append(student)
                    progress.console.print(f"{student}: not graded: {problem}", markup=False)
                if graded:
                    fresh.append(student)
                    for line in graded.problems:
                        progress.console.print(f"{student}: {line}", markup=False)
        wanted = [s for s in students if s not in failed and (s in fresh or not any(here.feedback(s).glob("*.html")))]
        wanted = [student for student in wanted if any(here.autograded(student).glob("*.ipynb"))]
        if not options.no_feedback and wanted:
            with _progress() as progress:
                bar = progress.add_task("feedback", total=len(wanted))
                for student, problem in feedback.generate(here, wanted, options.jobs):
                    progress.advance(bar)
                    if problem:
                        progress.console.print(f"{student}: no feedback: {problem}", markup=False)
        recorded = writer.students()
    found = report.write(here, [student for student in here.students() if student in recorded])
    _show_class(found, students)
    unchanged = len(students) - len(fresh) - len(failed)
    console.print(f"{len(fresh)} graded (hidden cases drawn from seed {seed}), {unchanged} unchanged.")
    for what, where in (
        ("class report", here.reports / "index.html"),
        ("every verdict", here.reports / "verdicts.csv"),
        ("feedback", here.root / "feedback"),
        ("gradebook", here.gradebook),
    ):
        console.print(f"  {what:14} {where.relative_to(here.root)}", markup=False)
    return failed


def _progress():
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    return Progress(*columns, console=console)


def _show_class(found, students):
    table = Table("student", "points", "misconceptions and what needs a look", box=None, pad_edge=False)
    for student in students:
        rows = found.get(student)
        if rows is None:
            continue
        points = f"{sum(row.score for row in rows):g} of {sum(row.max_score for row in rows):g}"
        said = {}
        for row in rows:
            what = row.misconception or row.status
            if what != "graded":
                said.setdefault(what, []).append(row.exercise)
        table.add_row(student, points, "; ".join(f"{what} ({', '.join(names)})" for what, names in said.items()))
    console.print(table)


def report(options):
    from . import report
    from .gradebook import Writer

    here = course()
    with Writer(here) as writer:
        students = sorted(writer.students())
    _show_class(report.write(here, students), students)
    console.print(f"{here.reports.relative_to(here.root)}/index.html and verdicts.csv are written.")
    return 0


def demo(options):
    from . import sandbox
    from .demo import enroll, is_demo
    from .gradebook import Writer
    from .release import release as make

    here = course()
    if options.remove:
        with Writer(here) as writer:
            for student in filter(is_demo, {*here.students(), *writer.students()}):
                writer.remove(student)
        console.print("The demo's class is removed.")
        return 0
    submitted = here.root / "submitted"
    real = [student for student in here.students() if not is_demo(student)] if submitted.is_dir() else []
    if real:
        raise CourseError(
            f"This course has real submissions ({real[0]}, …), and the demo would add its class to their gradebook. "
            "Run it in a fresh clone."
        )
    make(here)
    students = enroll(here)
    problem = sandbox.problem()
    if problem:
        errors.print(
            f"{problem}\nThe demo runs its own submissions without a sandbox; grading yours would be refused.",
            markup=False,
        )
    failed = _grade(here, students, _grading_options(), protected=problem is None)
    console.print("`python3 -m autograder demo --remove` takes the demo's class out again.", markup=False)
    return 1 if failed else 0


def _grading_options():
    return _parser().parse_args(["grade"])


def check(options):
    from .check import check_files

    here = course()
    protected = _protection(options.unsafe_no_sandbox)
    found, problems = check_files(here, options.notebooks, options.seed, protected)
    for problem in problems:
        errors.print(problem, markup=False)
    table = Table("notebook", "exercise", "points", "", box=None, pad_edge=False)
    for row, says in found:
        table.add_row(row.notebook, row.exercise, f"{row.score:g} of {row.max_score:g}", says)
    earned, most = (sum(getattr(row, name) for row, _ in found) for name in ("score", "max_score"))
    console.print(table)
    console.print(f"{earned:g} of {most:g} points")
    return 0 if found and earned == most and not problems else 1


def doctor(options):
    from .doctor import examine

    lines = examine(course())
    for good, line in lines:
        console.print(f"{'ok  ' if good else 'LOOK'}  {line}", markup=False)
    return 0 if all(good for good, _ in lines) else 1


def export(options):
    from .gradebook import Writer

    with Writer(course()) as writer:
        text = writer.totals()
    if str(options.output) == "-":
        sys.stdout.write(text)
    else:
        options.output.write_text(text, encoding="utf-8")
    return 0


def test(options):
    everything = ["--numprocesses", str(os.cpu_count())]
    return subprocess.call([sys.executable, "-m", "pytest", *(options.arguments or everything)])
