"""Outputs of a student's cells, made safe to keep and to show: only known kinds, no script, nothing from elsewhere."""

import base64
import binascii
import html
import re

import nh3

TEXT = ("text/plain", "text/markdown", "text/latex")
PICTURES = ("image/png", "image/jpeg", "image/gif")
ACTIVE_LATEX = re.compile(r"\\(href|url|require|style|class|cssId|unicode|html[A-Za-z]*|data|bbox)\b")
HTML_TAGS = nh3.ALLOWED_TAGS - {"a", "img"}


def printable(text):
    """Text without the halves of characters that no file and no terminal can hold."""
    return text.encode("utf-8", "replace").decode("utf-8")


def calm(text):
    """Text in which no link runs a script, and no formula links, loads or styles; what is taken out is left as words."""
    text = ACTIVE_LATEX.sub(r"\1", text)
    while "javascript:" in html.unescape(text).lower():
        text = re.sub("javascript:", "javascript ", html.unescape(text), flags=re.IGNORECASE)
    return text


def safe(output):
    """`output` (an untrusted dictionary) as an nbformat output, or None when it is nothing that can be shown."""
    kind = output.get("output_type")
    if kind == "stream":
        name = "stderr" if output.get("name") == "stderr" else "stdout"
        return {"output_type": "stream", "name": name, "text": printable(str(output.get("text", "")))}
    if kind == "error":
        lines = output.get("traceback") if isinstance(output.get("traceback"), list) else []
        return {
            "output_type": "error",
            "ename": printable(str(output.get("ename", ""))),
            "evalue": printable(str(output.get("evalue", ""))),
            "traceback": [printable(str(line)) for line in lines],
        }
    if kind in ("display_data", "execute_result"):
        data = output.get("data") if isinstance(output.get("data"), dict) else {}
        kept = {
            mime: value for mime, value in ((mime, _safe_data(mime, value)) for mime, value in data.items()) if value
        }
        if not kept:
            return None
        result = {"output_type": kind, "data": kept, "metadata": {}}
        if kind == "execute_result":
            count = output.get("execution_count")
            result["execution_count"] = count if type(count) is int else None
        return result
    return None


def _safe_data(mime, value):
    text = "".join(value) if isinstance(value, list) and all(isinstance(part, str) for part in value) else value
    if not isinstance(text, str):
        return None
    text = printable(text)
    if mime == "text/markdown":
        text = text.replace("![", "[")  # a picture would be loaded from elsewhere; a link waits to be followed
    if mime in ("text/html", "text/markdown", "text/latex"):
        text = calm(text)
    if mime in ("text/html", "text/markdown"):
        return nh3.clean(text, tags=HTML_TAGS)
    if mime in TEXT:
        return text
    if mime in PICTURES:
        try:
            base64.b64decode("".join(text.split()), validate=True)
        except binascii.Error:
            return None
        return text
    return None
