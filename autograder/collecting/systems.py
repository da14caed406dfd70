"""All systems whose downloads are known, and which of them a download is of."""

import copy
from collections import defaultdict
from collections.abc import Iterator
from pathlib import PurePosixPath

from ..course import CourseError
from ..intake.archive import Archive, Refused
from . import blackboard, brightspace, canvas, edx, github, gradescope, ilias, moodle, plain, sakai, teams
from .download import BOUNDS, Download
from .piece import Form

FORMS = {
    module.FORM.name: module.FORM
    for module in (canvas, moodle, blackboard, brightspace, gradescope, ilias, sakai, edx, teams, github, plain)
}
# Nothing that can be read says how their downloads are named.
REFUSED = {
    "ultra": "Blackboard Ultra: nothing public says how its downloads are named",
    "google": "Google Classroom: files keep the names that students give them, so nothing tells whose they are",
}
ENOUGH = 0.5  # the share of the files that have to fit
MOST_ZIPS = 3  # zip files in a download that are looked into: a class has more


def recognised(download: Download, wanted: str | None = None) -> tuple[Form, Download]:
    """(the Form of a download, the view of it in which that fits); raises CourseError when there is none, or more than one.

    wanted: the name of a form that somebody has chosen
    """
    if wanted in REFUSED:
        raise CourseError(f"{REFUSED[wanted]}. {_instead()}")
    if wanted is not None and wanted not in FORMS:
        raise CourseError(f"There is no system {wanted!r}; choose from {', '.join(FORMS)}.")
    forms = [FORMS[wanted]] if wanted else [form for form in FORMS.values() if form is not plain.FORM]
    found = list(_fitting(forms, download)) or list(_fitting([plain.FORM], download))
    if not download.files:
        raise CourseError(" ".join((f"{download.name}: there is no file to be taken in it.", *download.problems[:3])))
    if not found or not wanted and found[0][0] <= ENOUGH:
        fits = f"as {FORMS[wanted].title} names them" if wanted else "as any system that is known names them"
        raise CourseError(
            f"{download.name}: its files are not named {fits}, such as {_some(download)}. Known are: "
            f"{'; '.join(form.title for form in FORMS.values())}. Not known are: {'; '.join(REFUSED.values())}. {_instead()}"
        )
    best = [each for each in found if each[0] == found[0][0]]
    names = {form.name: form for _, form, _ in best}
    if len(names) > 1:
        raise CourseError(
            f"{download.name}: this may be of {' or of '.join(form.title for form in names.values())}; "
            f"say which with --from {' or --from '.join(names)}."
        )
    _, form, view = best[0]
    if form is plain.FORM and not wanted and (why := plain.doubt(view, download.name)):
        raise CourseError(
            f"{download.name}: {why}. {_instead()} With --from plain each folder is taken for a student's."
        )
    if form is plain.FORM and not wanted and (inner := _inner(view)):
        name, title = inner
        raise CourseError(f"{download.name}: {name} in it is a download of its own ({title}); collect that by itself.")
    return form, view


def _inner(view):
    """(name, title) of a folder or zip file in a plain download that is itself a system's download; None without one."""
    forms, below = [form for form in FORMS.values() if form is not plain.FORM], defaultdict(dict)
    for path, where in view.files.items():
        if len(path.parts) > 1:
            below[path.parts[0]][PurePosixPath(*path.parts[1:])] = where
        elif len(view.files) <= MOST_ZIPS and path.suffix.lower() == ".zip":
            try:
                with Archive(view.read(path), BOUNDS) as archive:
                    below[path.name] = {entry: entry for entry in archive.entries}
            except Refused:
                continue
    for name, files in below.items():
        inside = copy.copy(view)
        inside.name, inside.files = name, files
        best = next((each for each in _fitting(forms, inside) if each[0] > ENOUGH), None)
        if best:
            return name, best[1].title
    return None


def _fitting(forms, download) -> Iterator[tuple[float, Form, Download]]:
    """(share, form, view) of what fits at all, the best first; of views, the outermost that fits as well."""
    found = [
        (form.fits(view), -depth, form, view)
        for depth, view in enumerate(download.views())
        for form in forms
        if view.files
    ]
    for fitting, _, form, view in sorted(found, key=lambda each: each[:2], reverse=True):
        if fitting > 0:
            yield fitting, form, view


def _some(download):
    return ", ".join(str(path)[:100] for path in list(download.files)[:3])


def _instead():
    return "Put each student's files into a folder called as the student is, and collect the folder that holds these."
