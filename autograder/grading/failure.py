"""Why something was not done."""

from dataclasses import dataclass

from ..sandbox import NotStarted


@dataclass(frozen=True)
class Failure:
    """In words; of_content: what was handed in is to blame, and not what this machine lacks"""

    words: str
    of_content: bool

    @classmethod
    def of(cls, error: BaseException) -> "Failure":
        """The Failure that an exception stands for."""
        words = f"{type(error).__name__}: {' '.join(str(error).split())}"[:300]
        return cls(words, not isinstance(error, (OSError, MemoryError, NotStarted)))
