"""What helps with an error, for those whose message says little to a beginner.

The wordings are those of Python 3.11 to 3.14 and of NumPy 1 and 2, which say some things differently.
"""

import re

MESSAGE = "Point|Vector3|Quaternion|Pose|PoseStamped"
OF_NUMPY = (
    "sin|cos|tan|arcsin|arccos|arctan|arctan2|sqrt|deg2rad|rad2deg|radians|degrees|pi|array|asarray|eye|identity|zeros|ones|empty|diag|"
    "dot|matmul|cross|outer|trace|transpose|allclose|isclose|hstack|vstack|column_stack|concatenate|stack|append|block|clip|copysign|sign"
)
OF_LINALG = "inv|det|norm|solve|eig|svd|qr|pinv|multi_dot"
FIELDS = (
    "A message is no array, its numbers are in its fields: `[p.x, p.y, p.z]` of a Point, `[q.x, q.y, q.z, q.w]` of a Quaternion; "
    "a Pose has `position` and `orientation`."
)
NO_FIELDS = "This is a row of numbers and no message: they are `v[0]`, `v[1]`, `v[2]`, not `v.x`, `v.y`, `v.z`."
NONE = (
    "Something here is None. A function without a `return` gives None, and so does a method that changes a list in place, "
    "such as `append` or `sort`."
)
TEXT = "A text is no number, even if digits stand in it: take off the quotes."
LISTS = "Lists are no vectors: `+` joins them, `*` repeats them. `np.array([…])` makes arrays of them, for reckoning."
FOURTH = "A point has three numbers, a 4x4 matrix takes four: what belongs in the fourth place?"
NO_ROS = (
    "There is no ROS here: `from transform_lab import tft, Pose, Point, Quaternion` has what the exercises need of it."
)
WHOLE = "An array of whole numbers holds no fractions: `M = M / 2` makes a new array, where `M /= 2` writes into the old one."
OUT = (
    "A function for two arrays, such as `np.dot`, does not take a third as a factor: it is where the result is written. Multiply "
    "two at a time."
)
TWO_AT_A_TIME = re.compile(
    r"(dot|matmul|multiply|add|subtract)\w*\(\) takes from 2 to 3 positional arguments but [4-9]"
)
NUMBERS_OF_ARGUMENTS = (
    r"positional arguments? but \d+ (was|were) given|missing \d+ required positional|missing required argument|"
    r"takes (exactly|at most|at least) \w+ arguments?|expected (at least |at most )?\d+ arguments?, got|"
    "invalid number of arguments"
)

# (pattern of an error, what helps); an empty one where the message is our own and says it. The first that fits counts.
ADVICE = tuple(
    (re.compile(pattern), helps)
    for pattern, helps in (
        # what transform_lab says itself
        (r"must be a plain list of numbers|must be made of numbers|must be a 4x4 homogeneous|must be \d.* numbers; got", ""),
        (r"AttributeError: (tft|rospy)\.\w+ is not here\. ", ""),
        (r"must have the bottom row|no rotation matrix in its upper left|a reflection in its upper left", ""),
        (r"contains NaN or infinity: |has a number that is too large|is no orientation|of zeros has no direction", ""),
        (r"is not an attribute of \w+, whose fields are|takes its fields by position or by name", ""),
        (
            r"Invalid number of arguments, args should be (?P<fields>\[[^]]*\])",
            r"A message takes its fields, \g<fields>, by name, one number for each: `x, y, z = p`, then `Point(x=x, y=y, z=z)`.",
        ),
        (r"^NotImplementedError", "Write this one from NumPy and tft, so that it works by itself."),
        # names
        (r"name '(self)' is not defined", "These functions stand by themselves, and belong to no object: leave `self` out."),
        (rf"name '({OF_NUMPY})' is not defined", r"`\1` is one of NumPy's names: `np.\1`."),
        (rf"name '({OF_LINALG})' is not defined", r"This one is in NumPy's `linalg`: `np.linalg.\1`."),
        (r"name '(acos|asin|atan|atan2)' is not defined", r"Python's is `math.\1`, after `import math`."),
        (r"name 'tf' is not defined", "In these notebooks it is called `tft`."),
        (
            r"name '(math|Rotation|scipy)' is not defined",
            r"`\1` is imported nowhere: write the import at the top of this cell.",
        ),
        (r"^NameError", "Each notebook starts empty: is that name defined in this one, in a cell above, and spelled the same?"),
        (
            r"^UnboundLocalError.*'(\w+)'",
            r"On this path through the function `\1` has no value yet. A name that a function assigns to is its own from the "
            "first line on, whatever has that name outside.",
        ),
        (r"No module named '(tf|rospy|rclpy|geometry_msgs|std_msgs|visualization_msgs|tf_transformations)\b", NO_ROS),
        (r"cannot import name 'tf' from 'transform_lab'", "It is called `tft`: `from transform_lab import tft`."),
        (
            r"^(ModuleNotFoundError|ImportError)",
            "Is it spelled right? NumPy, SciPy and transform_lab are there; others may not be, where your work is graded.",
        ),
        (rf"module 'numpy' has no attribute '({OF_LINALG})'", r"It is in `linalg`: `np.linalg.\1`."),
        (
            r"module 'numpy.*' has no attribute '(inverse|inv|invert|determinant|det)'",
            "The inverse of a matrix M is `np.linalg.inv(M)`, its determinant `np.linalg.det(M)`.",
        ),
        (
            r"module '([\w.]+)' has no attribute '(\w+)'",
            r"There is no `\2` in it; look for the spelling with `dir`, or in the documentation.",
        ),
        # messages and arrays
        (r"'member_descriptor'|unsupported operand .*'type'", "A message is made with parentheses: `Pose()`."),
        (
            r"'Pose' object has no attribute '([xyzw])'",
            r"A Pose has a `position` and an `orientation`, and the numbers are in these: `pose.position.x`.",
        ),
        (rf"'({MESSAGE})' object has no attribute", FIELDS),
        (
            rf"not '?({MESSAGE})\b|'({MESSAGE})' object|non-iterable ({MESSAGE})\b|of type ({MESSAGE})\b|"
            rf"class 'transform_lab.messages|operand.*'({MESSAGE})'|'({MESSAGE})' has no len",
            FIELDS,
        ),
        (r"'(numpy.ndarray|list|tuple)' object has no attribute '([xyzw]|position|orientation)'", NO_FIELDS),
        (r"'(numpy.ndarray|list)' object has no attribute '(inv|inverse)'", "The inverse of a matrix M is `np.linalg.inv(M)`."),
        (
            r"'numpy.ndarray' object has no attribute 'append'",
            "An array has no `append`; `np.append(v, 1)` makes a new one that is longer by 1.",
        ),
        (
            r"'numpy.ndarray' object has no attribute",
            "Arrays do not have that. The parts of a transform T are slices of it, such as `T[:3, 3]`.",
        ),
        (r"operand.*'Rotation'", "A `Rotation` is an object of SciPy's: `.as_matrix()` and `.as_quat()` give its numbers."),
        (r"'(list|tuple)' object has no attribute '(T|shape|dot|transpose|copy|reshape)'", LISTS),
        (
            r"'Rotation' has no attribute '\w+_dcm'|'Rotation' object has no attribute '\w+_dcm'",
            "SciPy now calls these `from_matrix` and `as_matrix`.",
        ),
        (r"NoneType", NONE),
        # making arrays
        (
            r"array\(\) takes (from 1 to 2 positional|at most 2)|^TypeError: Field elements must be",
            "`np.array` takes all its rows in one pair of brackets more: `np.array([[1, 2], [3, 4]])`.",
        ),
        (
            r"(list|tuple) indices must be integers or slices, not (tuple|list)",
            "Is there a comma missing between two rows? If not: `A[i, j]` is for arrays, a list in a list is `A[i][j]`.",
        ),
        (r"Cannot interpret '\S+' as a data type", "The shape is one argument, with its own parentheses: `np.zeros((4, 4))`."),
        (
            r"inhomogeneous shape|inhomogeneous part",
            "All rows need the same number of entries. Count them; is a number missing, or one a vector?",
        ),
        (
            r"\b(hstack|vstack|column_stack|block|concatenate|stack|multi_dot)\(\) takes (?!from)(1|exactly)",
            r"This function takes all arrays as one list or tuple: `\1([a, b])`.",
        ),
        (
            r"only integer scalar arrays can be converted to a scalar index",
            "Arrays to be joined are handed over as one list, `np.concatenate([a, b])`; an index has to be a whole number.",
        ),
        (r"Expecting at least two arrays", "It needs two or more: what shall your function do when it is given one?"),
        (
            r"must have same number of dimensions",
            "A vector is neither a row nor a column: `p.reshape(3, 1)` is a column that can stand beside a matrix.",
        ),
        (
            r"dimensions (for|except for) the concatenation axis must match",
            "Arrays side by side need as many rows, one above the other as many columns. Print both shapes.",
        ),
        (r"cannot reshape array of size (\d+) into shape (\([\d, ]*\))", r"\1 numbers do not fill the shape \2."),
        (
            r"could not broadcast input array from shape (\([\d, ]*\)) into shape (\([\d, ]*\))",
            r"What stands right of the `=` has the shape \1, the place for it has the shape \2: take less, or a larger place.",
        ),
        (
            r"setting an array element with a sequence|only (length-1|size-1|0-dimensional) arrays can be converted",
            "A single number is needed here, and there is an array. `math` takes single numbers, NumPy's functions take arrays, "
            "too; the place of three numbers is a slice, such as `T[:3, 3]`.",
        ),
        (r"Cannot cast ufunc .* to dtype\('u?int|Cannot cast .* output from dtype\('float64'\)", WHOLE),
        (r"read-only", "This array only shows the numbers of another one: work on its `.copy()`."),
        # products
        (
            r"size 3 is different from 4|\(4,4\) and \(3,\) not aligned",
            f"{FOURTH} If it is a 3x3 matrix: only matrices of one size can be multiplied.",
        ),
        (
            r"size 4 is different from 3|\(3,3\) and \(4,\) not aligned",
            "A 3x3 rotation takes three numbers. A fourth one belongs to a 4x4 transform.",
        ),
        (r"incompatible dimensions for cross product", "A cross product is one of two vectors of three numbers."),
        (
            r"does not have enough dimensions \(has 0",
            "One side of `@` is no array: a message, a `Rotation`, a single number, or None?",
        ),
        (
            r"mismatch in its core dimension|not aligned",
            "For `A @ B`, B needs as many rows as A has columns. Print both shapes.",
        ),
        (
            r"could not be broadcast together with shapes (\([\d,]*\)) (\([\d,]*\))",
            r"`*`, `+` and `-` go entry by entry, which shapes \1 and \2 do not allow. The product of matrices is `@`; for a "
            "sum, cut out what belongs together.",
        ),
        (
            r"truth value of an array",
            "`==` of two arrays gives a True or False for each entry; `np.allclose(A, B, rtol=0, atol=1e-6)` gives a single one.",
        ),
        # linear algebra
        (
            r"Singular matrix",
            "This matrix has no inverse, its determinant is 0: print it. May a matrix of that kind be given to you, too?",
        ),
        (
            r"LinAlgError: 0-dimensional array given",
            "This is no matrix. If it is a Pose: make a matrix of it first, from its position and orientation.",
        ),
        (
            r"LinAlgError: 1-dimensional array given",
            "A vector has no inverse and no determinant: is this the matrix you meant?",
        ),
        (r"must be square", "Only a matrix with as many rows as columns has an inverse or a determinant: print its shape."),
        (r"^ValueError: Expected `matrix`", "SciPy wants the 3x3 rotation alone: which part of a transform is it?"),
        (r"^ValueError: Expected `quat`", "SciPy wants the four numbers x, y, z, w, in one list."),
        (r"zero norm quaternion", "0, 0, 0, 0 is no orientation, and that is what a fresh `Quaternion()` holds."),
        (
            r"^(ZeroDivisionError|FloatingPointError)",
            "For which arguments is what you divide by 0? Print it, just before that line.",
        ),
        (
            r"math domain error|expected a (nonnegative|positive) input|expected a number in range",
            "A root of a negative number, or the angle of a cosine beyond 1: rounding is enough for that. Print what goes in.",
        ),
        # indices, unpacking
        (
            r"index (\d+) is out of bounds for axis \d+ with size (\d+)",
            r"Counting starts at 0, so \1 is beyond the last of \2: is the index too large, or the array smaller than you think?",
        ),
        (
            r"(list|tuple) index out of range",
            "Counting starts at 0: the last of three is number 2. May there be fewer than you think?",
        ),
        (r"too many indices for array", "There are more indices than the array has dimensions: print its `.shape`."),
        (
            r"only integers, slices|indices must be integers|cannot be interpreted as an integer|slice indices must be",
            "Whole numbers are needed here, as in `T[0, 3]` or `range(3)`; `//` divides without a remainder.",
        ),
        (
            r"(not enough|too many) values to unpack \(expected (\d+)",
            r"Left of the `=` are \2 names: right of it have to be as many values.",
        ),
        (
            r"cannot unpack non-iterable|object is not iterable|must be an iterable|has no len\(\)",
            "This is a single thing, and not several.",
        ),
        # calls
        (
            r"'(numpy.ndarray|list|tuple)' object is not callable",
            "Round parentheses call a function; an array or list has brackets, `T[0, 3]`, and `.shape` and `.T` have none. "
            "Or is a comma or an operator missing before them?",
        ),
        (
            r"object is not callable",
            "Round parentheses after a value call it: is an operator missing, as in `2 * (a + b)`, or has a variable taken a "
            "function's name?",
        ),
        (
            r"(operand|'\w+' and).*'\w*(function|method)\w*'|'\w*(function|method)\w*' object (is not subscriptable|has no)",
            "This is a function itself, and not its answer: it is called with round parentheses, as in `f(x)`.",
        ),
        (
            r"object is not subscriptable|object does not support item assignment",
            "Brackets pick one out of several: this is a single thing.",
        ),
        (TWO_AT_A_TIME.pattern, OUT),
        (
            NUMBERS_OF_ARGUMENTS,
            "Count the arguments: what belongs together, such as the numbers of a vector, goes in as one list, and `f(*v)` hands "
            "over what is in v one by one.",
        ),
        (r"unexpected keyword argument '(\w+)'", r"It has no argument called `\1`."),
        # text, lists
        (r"concatenate list|concatenate tuple|'list'|'tuple'|multiply sequence", LISTS),
        (r"'str'|, not str|to str\b|concatenate str|string to float|invalid literal for int|dtype\('<U|<U\d+", TEXT),
        (r"^\w*TypeError: (ufunc|loop of ufunc)", "Among the numbers is something that is none: print what goes in."),
        # other
        (
            r"^(StdinNotImplementedError|EOFError)",
            "Nobody is there to type something in while your function is checked: all it needs comes as arguments.",
        ),
        (r"^RecursionError", "The function calls itself again and again. Does it mean another one of the same name?"),
        (r"^AssertionError", "An `assert` says so: is what it demands true of all arguments that the docstring allows?"),
        (r"^KeyError", "There is nothing under this name: print what there is."),
    )
)  # fmt: skip
NEAR_THAT_LINE = "Print what that line works with, just before it: what is it, and what is its `.shape`?"


def advice(told, name, parameters):
    """What helps with an error, in one line; "" where its message says it.

    told: the error as calling.one_line has it
    name, parameters: of the exercise's function
    """
    message, _, line = told.partition(", in your line ")
    call = f"`{name}({', '.join(parameters)})`"
    if re.search(rf"\b{re.escape(name)}\(\) (takes|missing|got)", message):
        return f"It is called as {call}: keep the function's first line as it was, with its stars and defaults, and no `self`."
    for pattern, helps in ADVICE:
        if found := pattern.search(message):
            return found.expand(helps)
    if line:
        return NEAR_THAT_LINE
    kind = ", with arguments of the kind that the docstring describes" if parameters else ""
    return f"Call it yourself, in a cell of its own, {call}{kind}: below the error stand the lines that led to it."
