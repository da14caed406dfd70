"""Reaches a verdict on a function, and says what it is: what the grader shares with `check`.

calling -> codec -> answers (of the kinds in kinds.py) -> verdict (with a status of status.py) -> diagnosis, then panel
(in words) and comparison (as a scene)
"""
