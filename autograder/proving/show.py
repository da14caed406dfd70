"""What `prove` prints: a table of the exercises, then of one exercise's misconceptions, and what is open with what to do."""

import os
import re

from rich.table import Column, Table
from rich.text import Text

from ..exercises import PUBLIC_SEED, key
from .adequacy import misnamed
from .search import code_of, quoted

THRESHOLD = re.compile(r"(?<= )[-+.\de]*\d[-+.\de]*(?=,| |$)")
NO_CASE = "No case found that tells it apart: perhaps it is {}."


def summary(proofs, seeds):
    """The Table with a row for each exercise; a number alone stands for all of them."""
    heads = "exercise cases bands miscon-\nceptions named mutants short-\ncuts equi-\nvalent solu-\ntions open".split(
        " "
    )
    title = f"caught, named or accepted on the cases of all {seeds} seeds"
    table = Table(
        *(Column(head, no_wrap=True) for head in heads),
        title=title,
        title_justify="left",
        box=None,
        padding=(0, 1, 0, 0),
    )
    for proof in proofs:
        misconceptions = proof.of("misconception")
        table.add_row(
            proof.exercise.name,
            str(len(proof.exercise.drawn(PUBLIC_SEED))),
            _all_or_some([(f.name, band) not in proof.empty for f in proof.exercise.features for band in f.bands]),
            _share(misconceptions),
            _all_or_some([not misnamed(each, what) for each, what in misconceptions]),
            *(_share(proof.of(*kinds)) for kinds in (["mutant"], ["shortcut"], ["equivalent"], ["right", "wrong"])),
            str(proof.open or ""),
        )
    return table


def _share(found):
    return _all_or_some([not (what.refused if each.right else what.accepted) for each, what in found])


def _all_or_some(good):
    return str(len(good)) if all(good) else f"{sum(good)} of {len(good)}"


def misconceptions(proof):
    """The Table of an exercise's misconceptions: by which families of cases each is caught, and what it is called."""
    table = Table(Column("misconception", no_wrap=True), "caught by", "called", box=None, pad_edge=False)
    public = key(proof.exercise, PUBLIC_SEED)
    for number, (each, what) in enumerate(proof.of("misconception")):
        families = dict.fromkeys(case["family"] for case in public["cases"] if case["wrong"][number] is not None)
        caught = "all families" if len(families) == len(public["weights"]) else "; ".join(families) or "nothing"
        table.add_row(
            Text(each.label), Text(caught), Text(_called(what) if misnamed(each, what) else "by its own name")
        )
    return table


def features(proof):
    """The Table of what an exercise's arguments are measured by, with the bands that have a case for every seed."""
    table = Table(Column("feature", no_wrap=True), "bands with a case in them", "empty", box=None, pad_edge=False)
    for feature in proof.exercise.features:
        filled = [band for band in feature.bands if (feature.name, band) not in proof.empty]
        table.add_row(Text(feature.name), Text(" ".join(filled)), Text(" ".join(set(feature.bands) - set(filled))))
    return table


def shortcuts(proof):
    """The Table of the shortcuts of an exercise, thresholds of one kind together, with how many of them are caught."""
    table = Table(Column("shortcut"), "caught", "declared equivalent", box=None, pad_edge=False)
    kinds = {}
    for each, what in proof.of("shortcut", "equivalent"):
        if not each.mutant:
            kinds.setdefault(THRESHOLD.sub("…", each.label), []).append((each, what))
    for label, tried in kinds.items():
        wrong = [(each, what) for each, what in tried if not each.right]
        table.add_row(Text(label), _share(wrong) if wrong else "", str(len(tried) - len(wrong) or ""))
    return table


def _called(found):
    return ", or ".join("; ".join(called) or "nothing" for called in found.called)


def open_points(proof, root):
    """What an author has to look at, as lines to print."""
    name = proof.exercise.name
    if not proof.solved:
        yield _point(f"{name}: no notebook in source/ has a cell {name}-solution, so its mutants are not tried.")
    yield from _slipping(proof, root)
    for each, what in proof.refused:
        yield from _refused(proof, each, what, root)
    for each, what in proof.misnamed:
        yield _point(f"{name}: the misconception {each.label} is called {_called(what)}, on some seeds at least.")
    for (feature, band), seeds in proof.empty.items():
        yield _point(f"{name}: no case lies in the band {band} of {feature}, on {_seeds(seeds, proof)}.")
        yield _detail("Add one to the cases, or narrow the feature's bands to what the docstring allows.")
    for what in proof.made_no_longer:
        yield _point(f"{name}: declared as equivalent, and made no longer; take it out of the specification:")
        yield _detail(f"changed: {what}")


def _slipping(proof, root):
    """What slips through; said together: mutants of a line that one case would catch, shortcuts beyond several thresholds."""
    alike = {}
    for each, what in proof.slipping:
        line = (each.mutant.file, each.mutant.line) if each.mutant else THRESHOLD.sub("…", each.label)
        alike.setdefault((line, proof.cases[each.label] if each.mutant else None), []).append((each, what))
    for group in alike.values():
        each, seeds = group[0][0], _seeds({seed for _, what in group for seed in what.accepted}, proof)
        if each.kind == "mutant":
            yield _point(f"{proof.exercise.name}: {_counted(len(group), 'mutant')} of a line, not caught on {seeds}.")
            yield from _where([each for each, _ in group], root)
        elif each.kind == "shortcut":
            yield _point(f"{proof.exercise.name}: {_counted(len(group), 'shortcut')}, not caught on {seeds}.")
            yield from (_detail(each.label) for each, _ in group)
        elif each.kind == "misconception":
            yield _point(f"{proof.exercise.name}: the misconception {each.label}, not caught on {seeds}.")
        elif each.kind == "cheat":
            yield _point(f"{proof.exercise.name}: a function that {each.label}, accepted on {seeds}.")
        else:
            yield _point(f"{proof.exercise.name}: the wrong solution {each.label}, accepted on {seeds}.")
        for case in dict.fromkeys(proof.cases[each.label] for each, _ in group):
            yield from _advice([each for each, _ in group if proof.cases[each.label] == case], case)


def _advice(group, case):
    if case is not None:
        yield _detail("A case that would catch it:" if len(group) == 1 else "A case that would catch each of them:")
        yield _detail(case, 4)
    elif group[0].kind == "cheat":
        yield _detail("It looks at no argument: add cases with other answers, drawn from the generator.")
    elif group[0].kind in ("mutant", "shortcut"):
        yield _detail(f"{NO_CASE.format('equivalent')} If so, declare it in the specification's field `equivalent`:")
        yield _detail(f'"the reason": ({"".join(f"{quoted(each.label)}, " for each in group).strip()}),', 4)
    else:
        yield _detail(NO_CASE.format("right, whatever the exercise may ask"))


def _refused(proof, each, what, root):
    seed, number = next(iter(what.refused.items()))
    if each.kind == "equivalent":
        said, advice = "declared as equivalent, and caught", "Take it out of the specification. This case catches it:"
    else:
        said, advice = f"right ({each.label}), and refused", "By this case, for one:"
    yield _point(f"{proof.exercise.name}: {said} on {_seeds(what.refused, proof)}.")
    yield from _where([each], root)
    yield _detail(advice)
    yield _detail(code_of(proof.exercise, seed, number), 4)


def _seeds(some, proof):
    return (
        f"all {len(proof.seeds)} seeds" if len(some) == len(proof.seeds) else f"{len(some)} of {len(proof.seeds)} seeds"
    )


def _counted(number, what):
    return f"a {what}" if number == 1 else f"{number} {what}s"


def _where(group, root):
    """The line that mutants were changed in, and what was changed."""
    mutant = group[0].mutant
    if mutant:
        file = os.path.relpath(mutant.file, root) if os.path.isabs(mutant.file) else mutant.file
        yield _detail(f"{file}, line {mutant.line}:")
        yield _detail(mutant.source, 4)
        for each in group:
            yield _detail(f"changed: {each.label}")


def _point(text):
    return Text(f"\n{text}", style="bold")


def _detail(text, indent=2):
    return Text(" " * indent + text)
