"""The grader of the transform lab: exercises, judge, sandbox, nbgrader plug-in, reports and the command line."""
