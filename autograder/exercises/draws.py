"""The numbers of a seed: all seeds ask the same questions, each with numbers of its own."""

import numpy as np

PUBLIC_SEED = 24  # the cases students see; any other seed draws hidden ones
HIDDEN = 42  # what hidden cases have in common is drawn from it: public ones tell nothing about it
OWN = 0.1  # how much of a number is the seed's own: too little to change its sign, or which of three is the largest


class Draws(np.random.Generator):
    """What the cases of a seed are drawn from.

    `choice`, `permutation` and `integers` give the same for all seeds of hidden cases: which sort of thing a case is, its
    signs, its order. `uniform` and `normal` give numbers that lie between what they have in common and the seed's own. So what
    is wrong with a function shows in the same cases for every seed: it gets the same name, and earns the same.
    """

    def __init__(self, seed):
        super().__init__(np.random.PCG64(seed))
        self.common = np.random.default_rng(PUBLIC_SEED if seed == PUBLIC_SEED else HIDDEN)

    def choice(self, *args, **kwargs):
        return self.common.choice(*args, **kwargs)

    def permutation(self, *args, **kwargs):
        return self.common.permutation(*args, **kwargs)

    def integers(self, *args, **kwargs):
        return self.common.integers(*args, **kwargs)

    def uniform(self, *args, **kwargs):
        return _between(self.common.uniform(*args, **kwargs), super().uniform(*args, **kwargs))

    def normal(self, *args, **kwargs):
        return _between(self.common.normal(*args, **kwargs), super().normal(*args, **kwargs))


def _between(common, own):
    return (1.0 - OWN) * common + OWN * own
