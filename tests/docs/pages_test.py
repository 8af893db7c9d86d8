# SPDX-License-Identifier: Apache-2.0
"""Checks that the pages know the tree: links lead somewhere, and the tables have every setting, skip and command."""

import pathlib
import re
import unittest

import markdown

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def text(path):
    return (ROOT / path).read_text(encoding="utf-8")


class PagesTest(unittest.TestCase):
    def test_links_lead_to_files(self):
        for page in PAGES:
            for link in markdown.links(page.read_text(encoding="utf-8")):
                if "://" not in link and not link.startswith("#"):
                    self.assertTrue((page.parent / link.split("#")[0]).exists(), f"{page.name}: {link}")

    def test_every_page_can_be_reached_from_the_readme(self):
        for page in PAGES[1:]:
            self.assertIn(f"(docs/{page.name})", text("README.md"))

    def test_every_setting_is_described(self):
        message = text("proto/flatlight/v1/settings.proto").split("message Settings {")[1].split("message Plan")[0]
        names = re.findall(r"^  (?:optional |repeated )?\w+ (\w+) = \d+;", message, re.MULTILINE)
        self.assertGreater(len(names), 5)
        for name in names:
            self.assertIn(f"`--{name.replace('_', '-')}", text("docs/settings.md"))

    def test_every_gallery_scene_has_its_picture(self):
        for scene in (ROOT / "server/gallery/scenes").glob("*.json"):
            self.assertIn(f"(pictures/gallery/{scene.stem}.png)", text("docs/gallery.md"))


if __name__ == "__main__":
    unittest.main()
