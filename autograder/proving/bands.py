"""Which bands of its features an exercise's cases lie in; see autograder.exercises.features."""


def empty_bands(exercise, seeds):
    """{(feature's name, band): seeds for which no case lies in it}"""
    empty = {}
    for seed in seeds if exercise.features else ():
        bound = [exercise.bound(case.args, case.kwargs) for case in exercise.drawn(seed)]
        for feature in exercise.features:
            missing = set(feature.bands).difference(*map(feature.bands_of, bound))
            for band in missing:
                empty.setdefault((feature.name, band), []).append(seed)
    return empty
