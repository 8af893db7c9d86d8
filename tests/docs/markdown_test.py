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
        self.assertTrue(markdown.matches(["took … long"], ["took not long"]))
        self.assertTrue(markdown.matches(["a", "…", "z"], ["a", "b", "c", "z"]))
        self.assertTrue(markdown.matches(["a", "…", "z"], ["a", "z"]))
        self.assertTrue(markdown.matches([], []))

    def test_times_names_of_jobs_and_measured_numbers_may_differ(self):
        self.assertTrue(markdown.matches(["in 9.5 s, 1.2 M rays/s"], ["in 120 ms, 980 k rays/s"]))
        self.assertTrue(markdown.matches(["error at most 4.5e-15 W/m, -0.2"], ["error at most 6e-14 W/m, 0.13"]))
        job, other = "f8a5cd01-ae29-43d2-addf-bdd9653fb02a", "01234567-89ab-43d2-addf-0123456789ab"
        self.assertTrue(markdown.matches([f"{job}  8 s  a"], [f"{other}  12.5 s    a"]))
        self.assertTrue(markdown.matches(["--threads 2, error 6.6 %"], ["--threads 8, error 7 %"]))
        self.assertTrue(markdown.matches(["efficiency 1.03 M"], ["efficiency 980 k"]))
        self.assertTrue(markdown.matches(["done in 4.5 s (31 s left)"], ["done in 1:15 (2:01:07 left)"]))
        self.assertFalse(markdown.matches(["7 rays"], ["8 rays"]))
        self.assertFalse(markdown.matches(["0.5 equal"], ["0.5 differs"]))

    def test_mismatches(self):
        self.assertFalse(markdown.matches(["a.b"], ["axb"]))
        self.assertFalse(markdown.matches(["took … long"], ["took not very short"]))
        self.assertFalse(markdown.matches(["a … b"], ["a 1", "2 b"]))
        self.assertFalse(markdown.matches([], ["surprise"]))
        self.assertFalse(markdown.matches(["a"], []))


if __name__ == "__main__":
    unittest.main()
