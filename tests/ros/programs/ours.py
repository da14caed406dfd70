"""Parts of transform_lab for the robot's Python, which lacks the packages that all of it needs."""

import sys
from types import ModuleType


def bare(folder):
    """Make transform_lab, in `folder`, importable module by module, without what its packages import."""
    for name in ("transform_lab", "transform_lab.judging"):
        sys.modules[name] = package = ModuleType(name)
        package.__path__ = [folder + name.removeprefix("transform_lab").replace(".", "/")]
