"""The grader of the transform lab: exercises, judge, sandbox, nbgrader plug-in, reports and the command line.

The students' package `transform_lab` lies beside the notebooks (nbgrader copies it from there), so its folder is put on
the path here, once for every way into the grader.
"""

import os
import sys
from pathlib import Path

ASSIGNMENT = "transforms"  # as nbgrader calls it, and its folders in source/, notebooks/, submitted/STUDENT/, …

_SOURCE = str(Path(__file__).resolve().parent.parent / "source" / ASSIGNMENT)
if _SOURCE not in sys.path:
    sys.path.insert(0, _SOURCE)

# nbformat imports jsonschema, and jsonschema these, of which one takes a second to build a grammar of international web
# addresses. No notebook's schema asks for them, and jsonschema does without.
for _package in "rfc3987_syntax", "isoduration", "rfc3986_validator", "webcolors", "rfc3339_validator":
    sys.modules.setdefault(_package, None)  # type: ignore[arg-type]  # None: it cannot be imported

# NumPy's and SciPy's linear algebra starts a thread for each core, and for 4x4 matrices they only wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
