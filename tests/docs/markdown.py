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


def _without_chance(line):
    """A line without what may differ from run to run, or when methods get better: hashes, names of jobs, times and other
    numbers that are not whole; and so without the width of columns. Words, layout, counts and verdicts remain."""
    line = re.sub(r"\b[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}\b", "UUID", line)
    line = re.sub(r"\b[0-9a-f]{64}\b", "HASH", line)
    line = re.sub(r"-?\b[0-9]+(\.[0-9]+(e[-+]?[0-9]+)?|e[-+]?[0-9]+|(?= (%|(us|ms|s|min|h|[kM] rays)\b)))", "NUMBER", line)
    line = re.sub(r"--threads [0-9]+", "--threads COUNT", line)
    line = re.sub(r"NUMBER (us|ms|s|min|h)\b|\b[0-9]+(:[0-5][0-9]){1,2}(?= |$)", "TIME", line)
    line = re.sub(r"NUMBER ([kM] )?rays", "NUMBER rays", line)
    line = re.sub(r"\b(NUMBER|[0-9]+) [kMG]\b", "NUMBER", line)
    return re.sub(r"  +", "  ", line.rstrip())


def matches(expected, printed):
    """Whether lines are as expected, chance aside. … stands for any text in a line, and alone for any number of lines."""
    expected, printed = map(_without_chance, expected), map(_without_chance, printed)
    pattern = ""
    for line in expected:
        if line.strip() == "…":
            pattern += r"(?:[^\n]*\n)*"
        else:
            pattern += "[^\n]*".join(re.escape(part) for part in line.split("…")) + r"\n"
    return re.fullmatch(pattern, "".join(line + "\n" for line in printed)) is not None
