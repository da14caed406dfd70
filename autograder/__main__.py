"""`python3 -m autograder …`: makes its environment if need be, then hands over to the commands."""

import sys
from pathlib import Path

from . import environment

ROOT = Path(__file__).resolve().parent.parent


def main():
    if not environment.suits(ROOT):
        from .set_up import SetupFailed, go_on

        try:
            go_on(ROOT, sys.argv[1:])
        except SetupFailed as failure:
            sys.exit(str(failure))
    from .command_line import run

    sys.exit(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
