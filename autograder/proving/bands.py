"""Which bands of its features an exercise's cases lie in; see autograder.exercises.features."""

from inspect import signature

import numpy as np


def empty_bands(exercise, seeds):
    """{(feature's name, band): seeds for which no case lies in it}"""
    bind, empty = signature(exercise.reference).bind, {}
    for seed in seeds if exercise.features else ():
        bound = [
            dict(bind(*case.args, **case.kwargs).arguments) for case in exercise.cases(np.random.default_rng(seed))
        ]
        for feature in exercise.features:
            missing = set(feature.bands).difference(*map(feature.bands_of, bound))
            for band in missing:
                empty.setdefault((feature.name, band), []).append(seed)
    return empty
