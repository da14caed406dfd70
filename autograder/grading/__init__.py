"""The path of a submission, from files to verdicts; `grade.py` is to be read first."""
