"""The commands of `python3 -m autograder`: what each one does and prints."""

import difflib
import os
import subprocess
import sys
from collections import Counter
from contextlib import nullcontext
from pathlib import Path

from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from .course import ASSIGNMENT, Course, CourseError
from .files import replace
from .names import odd

console = Console(highlight=False, soft_wrap=True)
errors = Console(stderr=True, highlight=False, soft_wrap=True)

UNPROTECTED = (
    "[bold red]NOT PROTECTED:[/] students' code runs as you, without a sandbox: it can read and change your files, the "
    "gradebook and other students' work, and use the network."
)

OPEN_TO_THE_NETWORK = (
    "[bold red]NOT PROTECTED:[/] whoever in the network reaches {} can run any code there as you, and read the course. Set up "
    "TLS (autograder/docs/larger_classes.md), or start scheduler and workers with `--host 127.0.0.1` on this machine alone."
)

NEW_TERM = f"""\
The course is called {{name}} now (nbgrader_config.py). What is left to do:
  1. Change what you want in source/, then `python3 -m autograder release`.
  2. The class: `nbgrader db student import FILE.csv` (columns id,first_name,last_name,email,lms_user_id, or some of them).
  3. The due date: `nbgrader db assignment add {ASSIGNMENT} --duedate "2027-01-31 18:00 UTC"`.
  4. On a hub: its administrator runs `python3 -m autograder hub …` once more, with the options of the first time, which tells
     students' servers the name; then `nbgrader release_assignment {ASSIGNMENT}`.
"""


def run(options):
    """Carry out a command, as the command line gave it; its exit code, see command_line.py."""
    try:
        if options.command != "test":
            course()  # where there is none, the commands' own imports would say so with a traceback
        return COMMANDS[options.command](options)
    except CourseError as error:
        errors.print(str(error), markup=False)
        return 2
    except OSError as error:
        errors.print(f"{error.filename or 'The system'}: {error.strerror}.", markup=False)
        return 2
    except KeyboardInterrupt:
        errors.print("Stopped. What was graded is kept; run the same command to go on.")
        return 130


def course():
    return Course(Path.cwd())


def _meant(name, known):
    """A question behind an error that names what is not known; "" where nothing that is comes near."""
    near = difflib.get_close_matches(name, known, 1)
    return f" Did you mean {near[0]}?" if near else ""


# --- students and release -------------------------------------------------------------------------------------------


def lab(options):
    folder = course().release
    if not folder.is_dir():
        raise CourseError("There are no notebooks yet: run `python3 -m autograder release` first.")
    return subprocess.call([sys.executable, "-m", "jupyterlab", str(folder), *options.extra])


def release(options):
    from .handout.release import release as make

    changes = make(course())
    for change in changes:
        console.print(change, markup=False)
    console.print(f"notebooks/{ASSIGNMENT} is {'up to date' if not changes else 'made anew'}.")
    return 0


def package(options):
    from .handout.package import for_gradescope, for_students, write

    here = course()
    folder, only = options.output, options.output.suffix == ".zip" and not options.output.is_dir()
    path = folder if only else folder / f"{ASSIGNMENT}.zip"
    path.parent.mkdir(parents=True, exist_ok=True)
    write(path, for_students(here))
    console.print(f"{path}: the notebooks, for students: in an LMS, on a web page, by mail.", markup=False)
    if not only:
        path = folder / f"{ASSIGNMENT}-gradescope.zip"
        write(path, for_gradescope(here))
        console.print(
            f"{path}: the autograder, for a programming assignment on Gradescope (base image: Ubuntu 24.04 or newer). "
            "It holds the solutions: keep it to yourself.",
            markup=False,
        )
    return 0


def collect(options):
    from .collecting.collect import collect as take
    from .collecting.told import lines, needs_a_look, table

    outcome = take(
        course(),
        options.downloads,
        options.students,
        options.system,
        _zone(options.timezone),
        options.dry_run,
        busy=_busy,
    )
    if outcome.came:
        shown = Table("student", "came from", "notebooks", "handed in", "", box=None, pad_edge=False)
        for row in table(outcome):
            _add_row(shown, *row)
        console.print(shown)
    for line in lines(outcome, options.timezone, options.dry_run):
        console.print(line, markup=False)
    return 1 if needs_a_look(outcome) else 0


def _zone(name):
    import zoneinfo

    try:
        return zoneinfo.ZoneInfo(name) if name else None
    except (zoneinfo.ZoneInfoNotFoundError, ValueError, OSError):
        raise CourseError(f"There is no time zone {name!r}; they are called as Europe/Berlin is.") from None


def prove(options):
    from .proving.errors import told

    try:
        from .exercises import EXERCISES
    except Exception as error:
        raise CourseError(f"The specifications in autograder/exercises/ cannot be read: {told(error)}") from None
    from .proving import show
    from .proving.adequacy import seeds
    from .proving.proof import prove, steps

    here, drawn = course(), seeds(options.seeds)
    names = list(dict.fromkeys(options.exercises)) or list(EXERCISES)
    for name in names:
        if name not in EXERCISES:
            raise CourseError(
                f"There is no exercise called {name}.{_meant(name, EXERCISES)} There are {', '.join(EXERCISES)}."
            )
    with _progress() as progress:
        bar = progress.add_task("proving", total=steps(names, drawn), counts="")
        proofs = list(prove(here, names, drawn, lambda: progress.advance(bar)))
    console.print(show.summary(proofs, len(drawn)))
    for proof in proofs:
        if options.exercises:
            console.print("", show.misconceptions(proof), "", show.features(proof), "", show.shortcuts(proof), sep="\n")
        for line in show.open_points(proof, here.root):
            console.print(line)
    number = sum(proof.open for proof in proofs)
    console.print(f"\n{number} open." if number else "\nNothing is open.")
    return 1 if number else 0


# --- grading --------------------------------------------------------------------------------------------------------


def grade(options):
    from .bridge.settings import settings
    from .grading import settled

    here = course()
    students = here.students()
    chosen = list(dict.fromkeys(options.students)) or students
    unknown = [student for student in chosen if student not in students]
    for student in unknown:
        errors.print(
            f"{student}: no submission in submitted/{student}/{ASSIGNMENT}.{_meant(student, students)}", markup=False
        )
    astray = {} if options.students else here.astray()
    for name, what_to_do in astray.items():
        errors.print(f"{name if name.isprintable() else repr(name)}: not graded: {what_to_do}.", markup=False)
    if chosen == students and not (
        options.force or options.scheduler or options.unsafe_no_sandbox or options.seed is not None
    ):
        with here.one_grader_at_a_time(_busy):
            table = settled.table(here, students, settings(here))
        if table is not None:
            _say_all(here, table, graded=0, unchanged=len(students), seed=None)
            return 1 if any(map(odd, astray)) else 0

    from .sandbox import ForkServer

    ForkServer.serving(here.package)  # loads while the rest is loaded here
    from .bridge import gradebook  # noqa: F401 (takes as long as the fork server's start)
    from .grading.workers import Cluster

    with Cluster(options.scheduler) if options.scheduler else nullcontext() as cluster:
        if exposed := cluster.unprotected() if cluster else []:
            errors.print(OPEN_TO_THE_NETWORK.format(escape(", ".join(exposed))))
        failed = _grade(
            here,
            [student for student in chosen if student in students],
            _protection(here, options.unsafe_no_sandbox, cluster),
            seed=options.seed,
            jobs=options.jobs,
            force=options.force or options.seed is not None,
            with_feedback=not options.no_feedback,
            cluster=cluster,
        )
    return 1 if unknown or failed or any(map(odd, astray)) else 0


def _protection(here, unsafe, cluster=None):
    """Whether sandboxes are used; refuses when they cannot be and nobody asked to go without."""
    from . import sandbox

    if unsafe:
        errors.print(UNPROTECTED)
        return False
    problem = cluster.ask(sandbox.refusal, here.root) if cluster else sandbox.refusal(here.root)
    if problem:
        where = "On a worker of the cluster: " if cluster else ""
        raise CourseError(f"{where}{problem}\nNothing was graded. To grade without protection: --unsafe-no-sandbox")
    return True


def _grade(here, students, protected, seed=None, jobs=os.cpu_count(), force=False, with_feedback=True, cluster=None):
    """Grade, record, write feedback and report; returns {student: what could not be done, and why}."""
    from .bridge.gradebook import Writer
    from .grading import settled
    from .grading.classroom import grade_class
    from .grading.grade import grading_run, new_seed
    from .pages import report

    seed = new_seed() if seed is None else seed
    failed, unsettled, without_feedback, fresh, counts = {}, [], {}, [], Counter()
    with here.one_grader_at_a_time(_busy), Writer(here) as writer:
        writer.can_record()
        looks = settled.Looks(here, writer.db_url)
        looks.take()
        against = grading_run(here, seed, isolated=protected)
        with _progress() as progress:
            bar = progress.add_task("grading", total=len(students), counts="")
            for student, graded, problem in grade_class(here, students, against, writer, jobs, force, cluster):
                if problem:
                    failed[student] = f"not graded: {problem}"
                    unsettled.append(student)
                    progress.console.print(f"{student}: {failed[student]}", markup=False)
                if graded:
                    fresh.append(student)
                    unsettled += [] if graded.final else [student]
                    counts.update(row.status for row in graded.rows)
                    for line in graded.problems:
                        progress.console.print(f"{student}: {line}", markup=False)
                done = int(progress.tasks[bar].completed) + 1
                said = f"{len(fresh)} graded, {done - len(fresh) - len(failed)} unchanged"
                said += f", {len(failed)} failed" if failed else ""
                said += "".join(f", {count} {status}" for status, count in counts.items() if status != "graded")
                progress.update(bar, advance=1, counts=said)
        looks.take()
        if with_feedback:
            grades = writer.grades()
            wanted = {name: grades[name] for name in students if name not in failed and name in grades}
            without_feedback, told = _write_feedback(here, wanted, jobs)
            unsettled += told
        found = report.write(here, writer)
        table = _table(found, students)
        looks.take()
        if with_feedback and not unsettled and students == here.students():
            looks.keep(students, writer.config, fresh, table)
    lacking = failed | without_feedback
    _say_all(here, table, len(fresh), len(students) - len(fresh) - len(failed), seed, lacking)
    return lacking


def _say_all(here, table, graded, unchanged, seed, lacking=None):
    """What came of a run; of whom something is lacking, last, where it is not overlooked."""
    _show_class(table)
    drawn = f" (hidden cases drawn from seed {seed})" if graded else ""
    console.print(f"{graded} graded{drawn}, {unchanged} unchanged.")
    for what, where in (
        ("class report", here.reports / "index.html"),
        ("every verdict", here.reports / "verdicts.csv"),
        ("feedback", here.root / "feedback"),
        ("gradebook", here.gradebook),
    ):
        console.print(f"  {what:14} {where.relative_to(here.root)}", markup=False)
    if lacking:
        whose = f"{len(lacking)} student{'s lack' if len(lacking) > 1 else ' lacks'}"
        errors.print(f"[bold red]Not all is done:[/] {whose} something; `python3 -m autograder grade` tries again.")
        for student, why in lacking.items():
            errors.print(f"  {student}: {why}", markup=False)


def _write_feedback(here, grades, jobs):
    """Make the pages that are missing or out of date; ({who could not get theirs: why}, those of whom there is more to say)"""
    from .pages import feedback

    failed, told = {}, []
    wanted = {student: told for student, told in grades.items() if not feedback.is_complete(here, student, told)}
    with _progress() as progress:
        bar = progress.add_task("feedback", total=len(wanted), counts="")
        for student, problem in feedback.generate(here, wanted, jobs):
            progress.advance(bar)
            if problem:
                told.append(student)
                progress.console.print(f"{student}: {problem}", markup=False)
            if not (here.feedback(student) / feedback.SUMMARY).is_file():
                failed[student] = problem or "no feedback: there is no page"
    return failed, told


def _busy():
    console.print("Another run of this course, grading or collecting, is going on; waiting for its end …")


def _progress():
    """A bar with: how many are done, how many a minute, the time left; and below it, what came of them."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, ProgressColumn, TextColumn, TimeRemainingColumn

    class Rate(ProgressColumn):
        def render(self, task):
            return Text(f"{task.speed * 60:.0f}/min" if task.speed else "")

    class WithCounts(Progress):
        def get_renderables(self):
            yield from super().get_renderables()
            yield from (Text(task.fields["counts"]) for task in self.tasks if task.fields["counts"])

    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), Rate(), TimeRemainingColumn()
    return WithCounts(*columns, console=console)


def _add_row(table, *cells):
    """A row of plain text: what students call things is no markup."""
    table.add_row(*(Text(cell) for cell in cells))


def _table(found, students):
    """[(student, points, what needs a look)], in words, of those who have {student: Work}."""
    table = []
    for student in [student for student in students if student in found]:
        work, said = found[student], {}
        for row in work.rows:
            if remark := work.remark(row):
                said.setdefault(remark, []).append(row.exercise)
        points = f"{work.points:g} of {work.most:g}"
        table.append([student, points, "; ".join(f"{what} ({', '.join(names)})" for what, names in said.items())])
    return table


def _show_class(rows):
    table = Table("student", "points", "misconceptions and what needs a look", box=None, pad_edge=False)
    for cells in rows:
        _add_row(table, *cells)
    console.print(table)


def report(options):
    from .bridge.gradebook import Writer
    from .pages import report

    here = course()
    with Writer(here) as writer:
        found = report.write(here, writer, options.compare)
    _show_class(_table(found, found))
    console.print(f"{here.reports.relative_to(here.root)}/index.html, verdicts.csv and grades.csv are written.")
    return 0


def extend(options):
    from datetime import timedelta

    from .bridge.gradebook import Writer
    from .bridge.lateness import extend

    here = course()
    with here.one_grader_at_a_time(_busy), Writer(here) as writer:
        extension = timedelta(days=options.days, hours=options.hours)
        line = extend(writer.gradebook, writer.config, options.student, extension)
    console.print(line, markup=False)
    console.print("`python3 -m autograder grade` renews the report and the student's pages.", markup=False)
    return 0


def term(options):
    from .bridge.term import begin

    here = course()
    archive, moved = begin(here, options.name, _busy)
    if archive:
        console.print(f"{', '.join(moved)}: now in {archive.relative_to(here.root)}/.", markup=False)
    console.print(NEW_TERM.format(name=options.name), markup=False, end="")
    return 0


def demo(options):
    from . import sandbox
    from .bridge.gradebook import Writer
    from .demo import enroll, is_demo
    from .handout.release import release as make
    from .pages import report

    here = course()
    if options.remove:
        with Writer(here) as writer:
            for student in filter(is_demo, {*here.students(), *writer.students()}):
                writer.remove(student)
            report.write(here, writer)
        console.print("The demo's class is removed.")
        return 0
    submitted = here.root / "submitted"
    real = [name for name in (*here.students(), *here.astray()) if not is_demo(name)] if submitted.is_dir() else []
    if real:
        raise CourseError(
            f"This course has real submissions ({real[0]}, …), and the demo would add its class to their gradebook. "
            "Run it in a fresh clone."
        )
    if not any(here.release.glob("*.ipynb")):
        make(here)
    students = enroll(here)
    problem = sandbox.problem()
    if problem:
        errors.print(
            f"{problem}\nThe demo runs its own submissions without a sandbox; grading yours would be refused.",
            markup=False,
        )
    failed = _grade(here, students, protected=problem is None)
    console.print("`python3 -m autograder demo --remove` takes the demo's class out again.", markup=False)
    return 1 if failed else 0


def check(options):
    from .sandbox import ForkServer

    here = course()
    ForkServer.serving(here.package)  # loads while the rest is loaded here

    from transform_lab.judging import panel

    from .grading.one_student import check_files, markdown, points

    protected = _protection(here, options.unsafe_no_sandbox)
    found, refused, said = check_files(here, options.notebooks, options.seed, protected)
    for line in refused + said:
        errors.print(line, markup=False)
    table = Table("notebook", "exercise", "points", "", box=None, pad_edge=False)
    for row, verdict in found:
        cells = row.notebook, row.exercise, f"{row.score:g} of {row.max_score:g}", panel.summary(verdict)
        _add_row(table, *cells)
    earned, most = points(found)
    console.print(table)
    console.print(f"{earned:g} of {most:g} points")
    if options.summary:
        with open(options.summary, "a", encoding="utf-8") as file:
            file.write(markdown(found, refused + said))
    return 0 if found and earned == most and not refused else 1


def hub(options):
    from .hub import setting_up

    on = _hub(options)
    changed = [step for step in setting_up.steps(on) if step.take]
    for step in changed:
        step.take()
        console.print(f"done  {step.what}.", markup=False)
    if not changed:
        console.print("Nothing had to be changed.")
    looks = list(setting_up.problems(on))
    for line in looks:
        console.print(f"LOOK  {line}", markup=False)
    console.print(
        f"Into jupyterhub_config.py, whose hub is started anew then:\n\n{setting_up.for_the_spawner(on)}", markup=False
    )
    return 1 if looks else 0


def _hub(options):
    from .hub.setting_up import hub

    return hub(course(), options.environment, options.instructor_config, options.exchange)


def doctor(options):
    from .doctor import examine, examine_hub

    if options.hub and not (options.environment and options.instructor_config):
        raise CourseError("`doctor --hub` has to be told --environment and --instructor-config, as `hub` was.")
    lines = examine(course()) + (examine_hub(_hub(options)) if options.hub else [])
    for good, line in lines:
        console.print(f"{'ok  ' if good else 'LOOK'}  {line}", markup=False)
    return 0 if all(good for good, _ in lines) else 1


def export(options):
    from .bridge.gradebook import Writer
    from .pages import export

    here = course()
    with Writer(here) as writer:
        found = export.totals(writer.gradebook)
        text, left_out = export.text(here, writer.gradebook, found, options.format, options.column)
        lines = [*export.told(left_out), *export.remarks(found, options.format, export.absent(writer.gradebook))]
    if str(options.output) == "-":
        sys.stdout.write(text)
    elif not options.output.parent.is_dir():
        raise CourseError(f"{options.output}: not written; there is no folder {options.output.parent}.")
    else:
        replace(options.output, text)
        console.print(f"{options.output} is written.", markup=False)
    for line in lines:
        errors.print(line, markup=False)
    return 1 if left_out else 0


def test(options):
    tier = ["--all"] if options.all else []
    spread = ["--numprocesses", str(os.cpu_count()), "--dist", "loadfile", "--no-loadscope-reorder"]
    return subprocess.call([sys.executable, "-m", "pytest", *tier, *(options.extra or spread)])


_ALL = demo, lab, release, collect, grade, report, extend, term, check, prove, hub, doctor, package, export, test
COMMANDS = {command.__name__: command for command in _ALL}
