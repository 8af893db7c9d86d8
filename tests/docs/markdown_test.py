# SPDX-License-Identifier: Apache-2.0
import unittest

import markdown

PAGE = """\
Text with a [link](docs/page.md) and a ![picture](a.svg).
```console
$ flatlight scenes
penumbra  A lamp
…
$ one \\
  two
```
```json bad.json
{"a": "[no](link)"}
```
"""


class MarkdownTest(unittest.TestCase):
    def test_blocks(self):
        first, second = markdown.blocks(PAGE)
        self.assertEqual((first.language, first.title, first.line), ("console", "", 3))
        self.assertEqual((second.language, second.title, second.text), ("json", "bad.json", '{"a": "[no](link)"}\n'))

    def test_links_leave_blocks_out(self):
        self.assertEqual(markdown.links(PAGE), ["docs/page.md", "a.svg"])

    def test_steps(self):
        self.assertEqual(
            markdown.steps(markdown.blocks(PAGE)[0]),
            [(3, "flatlight scenes", ["penumbra  A lamp", "…"]), (6, "one \\\n  two", [])],
        )

    def test_matches(self):
        self.assertTrue(markdown.matches(["a  b"], ["a  b"]))
        self.assertTrue(markdown.matches(["took … s"], ["took 0.25 s"]))
        self.assertTrue(markdown.matches(["a", "…", "z"], ["a", "b", "c", "z"]))
        self.assertTrue(markdown.matches(["a", "…", "z"], ["a", "z"]))
        self.assertTrue(markdown.matches([], []))

    def test_mismatches(self):
        self.assertFalse(markdown.matches(["a.b"], ["axb"]))
        self.assertFalse(markdown.matches(["took … s"], ["took 0.25 ms"]))
        self.assertFalse(markdown.matches(["a … b"], ["a 1", "2 b"]))
        self.assertFalse(markdown.matches([], ["surprise"]))
        self.assertFalse(markdown.matches(["a"], []))


if __name__ == "__main__":
    unittest.main()
