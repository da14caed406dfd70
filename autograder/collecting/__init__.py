"""What a learning management system (LMS) gives as "all submissions", sorted into submitted/STUDENT/.

One module for each system says how its downloads are named, and where that is known from; `collect.py` is the path of a
download, top to bottom.
"""
