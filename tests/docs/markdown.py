# SPDX-License-Identifier: Apache-2.0
"""Takes Markdown pages apart: fenced blocks and links."""

import dataclasses
import re

_FENCE = re.compile(r"^```(\w*)[ \t]*([^\n]*)\n(.*?)^```[ \t]*$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\]\(([^)\s]+)\)")


@dataclasses.dataclass
class Block:
    language: str
    title: str  # What follows the language: the name of the file that the block shows.
    text: str
    line: int  # Of its first line.


def blocks(text):
    return [Block(m[1], m[2].strip(), m[3], text.count("\n", 0, m.start()) + 2) for m in _FENCE.finditer(text)]


def links(text):
    """The targets of links and pictures, those in fenced blocks aside."""
    return _LINK.findall(_FENCE.sub("", text))


def steps(block):
    """The commands of a console block, each with the lines it is said to print."""
    found = []
    for number, line in enumerate(block.text.splitlines(), block.line):
        if line.startswith("$ "):
            found.append((number, [line[2:]], []))
        elif found and not found[-1][2] and found[-1][1][-1].endswith("\\"):
            found[-1][1].append(line)
        elif found:
            found[-1][2].append(line)
        else:
            raise ValueError(f"line {number}: a console block begins with a command")
    return [(number, "\n".join(command), printed) for number, command, printed in found]


def matches(expected, printed):
    """Whether lines are as expected: … stands for any text in a line, and alone on a line for any number of lines."""
    pattern = ""
    for line in expected:
        if line.strip() == "…":
            pattern += r"(?:[^\n]*\n)*"
        else:
            pattern += "[^\n]*".join(re.escape(part) for part in line.rstrip().split("…")) + r"[ \t]*\n"
    return re.fullmatch(pattern, "".join(line + "\n" for line in printed)) is not None
