"""Microsoft Teams: the folder "Submitted files" of a class's SharePoint site.

`Submitted files/FULL NAME/ASSIGNMENT/[Version N/]NAME`, the words in the site's language. The sources are tools that read it:
kubohiroya/-summarize-teams-submissions, 06benste/teams-assignment-downloader. Several assignments lie side by side; ours are
those with its notebooks in them. A greater version is newer; there is no time, and of a student no more than the name.
"""

import re
from pathlib import PurePosixPath

from ..intake.naming import is_notebook
from .piece import Form, Found, Left, Piece, Who, share, stem_of

SUBMITTED = re.compile(
    "submitted files|提出済みのファイル|(abgegebene|eingereichte) dateien|fichiers (envoyés|remis|soumis)|"
    "archivos (enviados|entregados)|file (inviati|consegnati)|ingeleverde bestanden|arquivos enviados|przesłane pliki|"
    "已提交的文件|제출된 파일",
    re.IGNORECASE,
)
WORKING = re.compile(
    "working files|作業中のファイル|arbeitsdateien|fichiers de travail|archivos de trabajo", re.IGNORECASE
)
VERSION = re.compile(
    r"(version|versión|versione|versão|versie|versio|wersja|verze|verzió|версия|バージョン|版本|버전) ?(?P<number>\d{1,3})",
    re.IGNORECASE,
)


def fits(download):
    """Teams is known by its outermost folder, or by versions."""
    named = SUBMITTED.match(download.name)
    tops = any(SUBMITTED.fullmatch(path.parts[0]) for path in download.files)
    fitting = share(download, lambda path: len(path.parts) > 2 + tops or WORKING.fullmatch(path.parts[0]))
    return fitting if named or tops or any(_version(path.parts[2:]) for path in download.files) else 0.0


def _version(parts):
    return VERSION.fullmatch(parts[0]) if len(parts) > 1 else None


def sort(download, notebooks, people):
    pieces, left, found = [], [], []
    tops = any(SUBMITTED.fullmatch(path.parts[0]) for path in download.files)
    for path in download.files:
        parts = path.parts[1:] if tops and SUBMITTED.fullmatch(path.parts[0]) else path.parts
        if WORKING.fullmatch(path.parts[0]):
            left.append(Left("not handed in: it lies among the working files", (str(path),), look=False))
        elif len(parts) < 3:
            left.append(Left("it does not lie where Teams puts files", (str(path),)))
        else:
            found.append((path, parts))
    assignments = {parts[1] for _, parts in found}
    ours = {parts[1] for _, parts in found if is_notebook(parts[-1]) and stem_of(parts[-1], notebooks)}
    for path, (name, assignment, *inside) in found:
        if len(assignments) > 1 and assignment not in ours:
            left.append(Left("of another assignment", (str(path),), look=False))
            continue
        version = _version(inside)
        order = (int(version["number"]),) if version else ()
        pieces.append(Piece((Who(name),), path, PurePosixPath(*inside[1:] if version else inside), order=order))
    return Found(pieces, left)


FORM = Form("teams", "Teams: Submitted files", fits, sort)
