"""Where the students' package runs: in a notebook or a plain script, with somebody looking or while it is graded."""

import os
import sys


def being_graded():
    """Whether this is the grader's sandbox, where nobody looks and the grader calls the functions itself."""
    return bool(os.environ.get("TRANSFORM_LAB_GRADING"))


def shell():
    """IPython's shell where there is one; a plain `python` script has none."""
    if "IPython" not in sys.modules:
        return None
    from IPython import get_ipython

    return get_ipython()


def names():
    """{name: value} of what a notebook's cells, or a plain script, have defined."""
    ipython = shell()
    return vars(sys.modules["__main__"]) if ipython is None else ipython.user_ns
