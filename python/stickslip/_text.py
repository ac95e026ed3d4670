"""Texts of files, whatever wrote them."""
from __future__ import annotations

import codecs


def decoded(content: bytes) -> str:
    """A text in UTF-8, UTF-16 or, where it is neither, Latin-1, as the program takes it; ValueError for a character 0, which
    belongs to no text."""
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        text = content.decode('utf-16', 'replace')
    elif content[1:4:2] == b'\0\0':   # UTF-16 without a mark: each of the first letters has a byte that is 0
        text = content.decode('utf-16-le', 'replace')
    elif content[0:3:2] == b'\0\0':
        text = content.decode('utf-16-be', 'replace')
    else:
        try:
            text = content.decode('utf-8-sig')
        except UnicodeDecodeError:
            text = content.decode('latin-1')
    if '\0' in text:
        raise ValueError(f"line {text[:text.index(chr(0))].count(chr(10)) + 1}: a character 0 belongs to no text")
    return text
