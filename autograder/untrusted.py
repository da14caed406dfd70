"""Outputs of a student's cells, made safe to keep and to show: only known kinds, no script, nothing from elsewhere.

All of it takes time and space in proportion to what comes in, whatever that is: where outside software would not, it does
not get the text, which is shown as it is.
"""

import base64
import re

import nh3

TEXT = ("text/plain", "text/markdown", "text/latex")
PICTURES = ("image/png", "image/jpeg", "image/gif")
HTML_TAGS = nh3.ALLOWED_TAGS - {"a", "img"}
LONGEST_HTML = 100_000  # characters; a table of pandas's has a few thousand
GROWS = 6  # times as long as it was, text may become: "&" becomes "&amp;"
DEEPEST = 100  # elements inside each other
MOST_RUNS = 10**9  # of a notebook's cells
# A parser repeats these in every paragraph until they are closed, as often as their attributes differ.
REPEATED = re.compile(r"<(?:a|b|big|code|em|font|i|nobr|s|small|strike|strong|tt|u)[\s/]", re.IGNORECASE)
MOST_REPEATED = 20  # elements for each character that there would be
ELEMENT = re.compile(r"<(/?)(?!(?:br|col|hr|img|input|wbr)\b)[a-z]")
ESCAPE, COLOUR, MOST_COLOURS = re.compile(r"\x1b(?:\[[^@-~\n]*[@-~]?)?"), re.compile(r"\x1b\[[\d;]{0,30}m"), 1_000

LATEX = "href url require style class cssId unicode html[A-Za-z]* data bbox".split()


def _letters(word):
    """A pattern for `word` as a page may spell it: small or capital, as references, with what a browser skips in between."""
    skipped = r"(?:[\t\n\r]|&(?:Tab|NewLine);|&#(?:0*(?:9|10|13)|x0*[9ad]);?)*+"
    return skipped.join(f"(?:{re.escape(letter)}|&#0*+(?:{_codes(letter)});?)" for letter in word)


def _codes(letter):
    codes = {ord(letter), ord(letter.upper())}
    return "|".join(f"{code}|x0*+{code:x}" for code in codes)


ACTIVE = re.compile(
    rf"(?<!\\)\\++(?P<latex>(?:{'|'.join(LATEX)})\b)|{_letters('javascript')}\s*+(?::|&colon;|&#0*+58;?|&#x0*+3a;?)",
    re.IGNORECASE,
)


def printable(text: str) -> str:
    """Text without the halves of characters that no file and no terminal can hold."""
    return text.encode("utf-8", "replace").decode("utf-8")


def calm(text: str) -> str:
    """Text in which no link runs a script, and no formula links, loads or styles; what is taken out is left as words.

    Our own pages choose their links and have formulas as MathML; this is for whoever opens a graded notebook elsewhere, too.
    """
    return ACTIVE.sub(lambda found: found["latex"] or "javascript ", text)


def clean(text: str, **rules) -> str | None:
    """HTML as nh3.clean leaves it under these rules; None where that would be out of proportion to the text."""
    if len(REPEATED.findall(text)) * text.count("<") > MOST_REPEATED * len(text):
        return None
    cleaned = nh3.clean(text, **rules)
    if len(cleaned) > GROWS * len(text):
        return None
    depth = deepest = 0
    for found in ELEMENT.finditer(cleaned):
        depth += -1 if found[1] else 1
        deepest = max(deepest, depth)
    return cleaned if deepest <= DEEPEST else None


def terminal(text: str) -> str:
    """Text as a terminal shows it, with no other commands than colours, and these only where they are few."""
    colours = len(COLOUR.findall(text)) <= MOST_COLOURS
    return ESCAPE.sub(lambda found: found[0] if colours and COLOUR.fullmatch(found[0]) else "", text)


def safe(output: object) -> dict | None:
    """`output` (untrusted JSON) as an nbformat output, or None when it is nothing that can be shown.

    It is at most GROWS times as long, and what is no text where text should be is left out.
    """
    if not isinstance(output, dict):
        return None
    kind = output.get("output_type")
    if kind == "stream":
        name = "stderr" if output.get("name") == "stderr" else "stdout"
        return {"output_type": "stream", "name": name, "text": terminal(_text(output.get("text")))}
    if kind == "error":
        lines = output.get("traceback")
        return {
            "output_type": "error",
            "ename": _text(output.get("ename")),
            "evalue": _text(output.get("evalue")),
            "traceback": [terminal(_text(line)) for line in lines] if isinstance(lines, list) else [],
        }
    if kind in ("display_data", "execute_result"):
        data = output.get("data")
        kept: dict[str, str] = {}
        for mime, value in data.items() if isinstance(data, dict) else ():
            _keep(kept, mime, _text(value))
        if not kept:
            return None
        result = {"output_type": kind, "data": kept, "metadata": {}}
        if kind == "execute_result":
            result["execution_count"] = counted(output.get("execution_count"))
        return result
    return None


def counted(value: object) -> int | None:
    """The number of a cell's run, as a notebook may have it; None for what is none."""
    return value if type(value) is int and 0 <= value < MOST_RUNS else None


def _text(value):
    """A text, or one in pieces; "" for anything else."""
    if isinstance(value, list) and all(isinstance(part, str) for part in value):
        value = "".join(value)
    return printable(value) if isinstance(value, str) else ""


def _keep(kept, mime, text):
    """Put the text into `kept` under its type, as it is safe to show; a page that is too much for a parser, as text."""
    if mime in ("text/html", "text/markdown"):
        cleaned = clean(text, tags=HTML_TAGS) if len(text) <= LONGEST_HTML else None
        if cleaned is None:
            kept.setdefault("text/plain", terminal(text))
        elif cleaned:  # and no comment stands in the middle of a word any more
            # In Markdown, a picture would be loaded from elsewhere; a link waits to be followed.
            kept[mime] = calm(cleaned.replace("![", "[") if mime == "text/markdown" else cleaned)
    elif mime in TEXT and text:
        kept[mime] = terminal(text) if mime == "text/plain" else calm(text)
    elif mime in PICTURES and text:
        try:
            base64.b64decode("".join(text.split()), validate=True)
        except ValueError:
            return
        kept[mime] = text
