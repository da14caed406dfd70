"""What may be said of replies to hidden cases: a student's function can put their numbers into words of its own."""

import builtins
import re
from functools import cached_property

from .failed_cells import MISSING_NAME

KNOWN = {
    "LinAlgError",
    *(name for name, value in vars(builtins).items() if isinstance(value, type) and issubclass(value, Exception)),
}
ERROR = re.compile(r"(\w+)(?:: .*?)??(?:, in your line (\d+): `(.*)`)?", re.DOTALL)  # see calling.one_line


class Telling:
    """Called with what is wrong with a reply, a text: the part of it that may be said, "" for nothing.

    The whole text if it is wrong with a public case, too, before any hidden one was seen; else of an error its usual name and
    the student's own line.

    answers: public_example.Answer of public cases; source: the text of the cell that has the function
    """

    def __init__(self, answers, source):
        self.answers, self.source = answers, source

    @cached_property
    def public(self):
        return {answer.problem for answer in self.answers}

    def __call__(self, text):
        if text in self.public:
            return text
        error = ERROR.fullmatch(text)
        if error is None or error[1] not in KNOWN:  # an answer that is none may have any words
            return ""
        kind, number, line = error.groups()
        if (found := MISSING_NAME.match(text)) and re.search(rf"\b{found[1]}\b", self.source):
            kind = found[0]
        lines = self.source.split("\n")
        if number and int(number) <= len(lines) and lines[int(number) - 1].strip().startswith(line.removesuffix("…")):
            return f"{kind}, in your line {number}: `{line}`"
        return kind
