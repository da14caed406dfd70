"""Why something was not done."""

from dataclasses import dataclass

from ..sandbox import NotStarted


@dataclass(frozen=True)
class Failure:
    """In words; of_content: what was handed in is to blame, and not what this machine lacks"""

    words: str
    of_content: bool

    @classmethod
    def of(cls, error: BaseException, *lacking: type[BaseException]) -> "Failure":
        """The Failure that an exception stands for.

        lacking: kinds of exceptions, besides the usual ones, by which the machine says that it lacks something; another that
            was raised in their stead counts as well
        """
        words = f"{type(error).__name__}: {' '.join(str(error).split())}"[:300]
        first: BaseException | None = error
        while first and not isinstance(first, lacking):
            first = first.__cause__ or first.__context__
        return cls(words, of_content=not (first or isinstance(error, (OSError, MemoryError, NotStarted))))
