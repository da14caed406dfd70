"""Reaches a verdict on a function, and says what it is: what the grader shares with `check`.

calling -> codec -> answers -> verdict -> diagnosis, then panel (in words) and comparison (as a scene)
"""
