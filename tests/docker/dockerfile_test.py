# SPDX-License-Identifier: Apache-2.0
"""What can be said of docker/ without root and without an engine; prove.py does the rest."""
import pathlib
import re
import unittest

import dockerfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


class ParseTest(unittest.TestCase):
    def test_steps_stay_in_order_and_lines_go_on(self):
        one, two = dockerfile.parse("# licence\nFROM debian:bookworm AS build\nENV A=b\nRUN x \\\n # why\n && y\n\n"
                                    "FROM debian:bookworm-slim\nCOPY --from=build /a /b\nUSER me\nVOLUME /data\n"
                                    'HEALTHCHECK --interval=30s --timeout=5s CMD ["ask", "it"]\nCMD ["serve"]\n')
        self.assertEqual((one.base, one.name), ("debian:bookworm", "build"))
        self.assertEqual(one.steps[0], ("ENV", "A=b"))
        self.assertEqual(one.steps[1][1].split(), ["x", "&&", "y"])
        self.assertEqual(two.steps, [("COPY", "--from=build /a /b"), ("USER", "me")])
        self.assertEqual((two.volumes, two.health, two.command), (["/data"], ["ask", "it"], ["serve"]))
        self.assertEqual(two.health_options, {"interval": "30s", "timeout": "5s"})

    def test_what_it_does_not_know_is_an_error(self):
        for text in ("FROM a\nADD x y\n", "RUN x\n", "FROM a\nCMD serve\n", "FROM a AS b c\n"):
            with self.assertRaises(ValueError, msg=text):
                dockerfile.parse(text)


class RecipeTest(unittest.TestCase):
    def setUp(self):
        self.stages = dockerfile.parse((ROOT / "docker/Dockerfile").read_text(encoding="utf-8"))

    def test_the_server_has_no_rights_and_is_asked_for_its_health_where_it_listens(self):
        image = self.stages[-1]
        users = [arguments for word, arguments in image.steps if word == "USER"]
        self.assertTrue(users and users[-1] not in ("root", "0"))
        listens = image.command[image.command.index("--listen") + 1]
        self.assertEqual(image.health[image.health.index("--server") + 1], listens)
        self.assertEqual(image.command[image.command.index("--data") + 1], image.volumes[0])

    def test_the_list_of_packages_is_sorted_and_says_each_once(self):
        lines = (ROOT / "docker/packages.txt").read_text(encoding="utf-8").splitlines()
        packages = [line for line in lines if not line.startswith("#")]
        self.assertEqual(packages, sorted(set(packages)))
        self.assertTrue(all(re.fullmatch(r"[a-z0-9+.-]+", package) for package in packages))

    def test_the_image_installs_by_name_and_without_what_is_only_recommended(self):
        for stage in self.stages:
            for word, arguments in stage.steps:
                if word == "RUN" and "apt-get install" in arguments:
                    self.assertIn("--no-install-recommends", arguments)


if __name__ == "__main__":
    unittest.main()
