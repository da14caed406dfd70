"""Messages field by field, be they ROS's or ours."""

END = "the script has ended"  # the namespace of a marker that says so


def plain(value):
    """A message as a dictionary of its fields, a list as a list; all else as it is."""
    names = ("secs", "nsecs") if hasattr(value, "nsecs") else getattr(value, "__slots__", None)
    if names is not None:
        return {name: plain(getattr(value, name)) for name in names}
    return [plain(item) for item in value] if isinstance(value, (list, tuple)) else value
