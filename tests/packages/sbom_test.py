"""packaging/sbom.py over a small package, and over what is built here (BUILD)."""

import hashlib
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

SBOM = Path(__file__).resolve().parents[2] / "packaging" / "sbom.py"
CONTROL = """Package: vantage
Version: 1.2.3
Architecture: amd64
Maintainer: Test <test@localhost>
Depends: libc6 (>= 2.36), libnosuch9 | libc6
Description: a camera
 More about it.
"""


def installed_version(name):
    return subprocess.run(
        ["dpkg-query", "--show", "--showformat", "${Version}", name], capture_output=True, text=True, check=True
    ).stdout


class SbomTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        control = self.folder / "vantage" / "DEBIAN" / "control"
        control.parent.mkdir(parents=True)
        control.write_text(CONTROL)
        self.package = self.folder / "vantage.deb"
        subprocess.run(
            ["dpkg-deb", "--root-owner-group", "--build", control.parents[1], self.package],
            check=True,
            capture_output=True,
        )

    def run_tool(self, *packages):
        target = self.folder / "bill.json"
        command = [SBOM, os.environ["BUILD"], *packages, "-o", target]
        return subprocess.run(command, capture_output=True, text=True, check=False), target

    def test_lists_the_package_and_what_is_in_it(self):
        done, target = self.run_tool(self.package)
        self.assertEqual(done.returncode, 0, done.stderr)
        bill = json.loads(target.read_text())
        self.assertEqual((bill["bomFormat"], bill["specVersion"]), ("CycloneDX", "1.5"))
        components = {each["name"]: each for each in bill["components"]}
        self.assertEqual(len(components), len(bill["components"]))

        own = components["vantage"]
        self.assertEqual((own["type"], own["version"]), ("application", "1.2.3"))
        self.assertEqual(own["hashes"][0]["content"], hashlib.sha256(self.package.read_bytes()).hexdigest())

        def uses(name):
            return [each["value"] for each in components[name]["properties"] if each["name"] == "vantage:use"]

        self.assertEqual(components["libc6"]["version"], installed_version("libc6"))
        self.assertTrue(components["libc6"]["purl"].startswith("pkg:deb/debian/libc6@"))
        self.assertIn("depends", uses("libc6"))
        self.assertNotIn("version", components["libnosuch9"], "it is not installed here")
        self.assertEqual(uses("libeigen3-dev"), ["headers"])
        self.assertIn("static", uses("libimgui-dev"))

        refs = {each["bom-ref"] for each in bill["components"]}
        needed = {each["ref"]: each["dependsOn"] for each in bill["dependencies"]}
        self.assertEqual(needed["release"], ["vantage"])
        self.assertLessEqual(set(needed["vantage"]), refs)
        self.assertIn(components["libimgui-dev"]["bom-ref"], needed["vantage"])

        self.run_tool(self.package)
        self.assertEqual(json.loads(target.read_text()), bill, "the same packages give the same bill")

    def test_a_file_that_is_no_package_is_an_error(self):
        (self.folder / "other.deb").write_text("no package")
        done, target = self.run_tool(self.folder / "other.deb")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("other.deb", done.stderr)
        self.assertFalse(target.exists())


if __name__ == "__main__":
    unittest.main()
