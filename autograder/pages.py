"""Students' text in nbgrader's pages (feedback, formgrader): as they wrote it, without what could act on the reader.

nbgrader_config.py names the filter here; nbconvert puts raw HTML of a Markdown cell into the page as it is.
"""

import nh3
from jinja2 import pass_context
from nbconvert.filters.markdown_mistune import IPythonRenderer, MarkdownWithMath

from .outputs import calm

PICTURES = ("data:image/png;base64,", "data:image/jpeg;base64,", "data:image/gif;base64,")  # attached to a cell
ATTRIBUTES = {
    **{tag: {"id", "class"} for tag in ("h1", "h2", "h3", "h4", "h5", "h6", "span", "div", "code", "pre")},
    "a": {"href", "class", "id"},
    "img": {"src", "alt", "width", "height"},
    "th": {"align", "style"},
    "td": {"align", "style"},
    "details": {"open"},
}


@pass_context
def markdown2html(context, source):
    """nbconvert's filter of that name, with a page as its result that holds nothing from elsewhere and no script."""
    renderer = IPythonRenderer(escape=False, attachments=context.get("cell", {}).get("attachments", {}))
    return nh3.clean(
        MarkdownWithMath(renderer=renderer).render(calm(source)),
        tags=nh3.ALLOWED_TAGS | {"details", "summary", "input"},
        attributes=ATTRIBUTES,
        attribute_filter=_attribute,
        filter_style_properties={"text-align"},
        url_schemes={"http", "https", "mailto", "data"},
    )


def _attribute(tag, name, value):
    """Pictures are those of the cell itself; links lead where they say."""
    if name == "src":
        return value if value.startswith(PICTURES) else None
    if name == "href":
        return None if value.lower().startswith("data:") else value
    return value
