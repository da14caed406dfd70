"""Proves an exercise: nothing wrong that we can think of passes its cases, and nothing right fails them.

solutions -> adequacy (calls them on the cases of many seeds) -> search (a case for what slips through) -> show
"""
