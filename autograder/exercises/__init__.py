"""The exercises, each a specification in code; see `specification.py` for what one is made of."""

from .specification import PUBLIC_SEED, Case, Exercise, Misconception, key

MODULES = ("rotation", "homogeneous_transforms", "chaining", "inversion", "pre_grasp")


def _all():
    from importlib import import_module

    return {
        exercise.name: exercise for module in MODULES for exercise in import_module(f"{__name__}.{module}").EXERCISES
    }


EXERCISES = _all()

__all__ = ["EXERCISES", "PUBLIC_SEED", "Case", "Exercise", "Misconception", "key"]
