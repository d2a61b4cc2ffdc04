#!/usr/bin/python3
"""Writes a software bill of materials of Debian packages as CycloneDX 1.5 (JSON).

  packaging/sbom.py BUILD_FOLDER PACKAGE.deb... -o FILE

It lists the packages with their SHA-256, and every Debian package that they depend on, that is linked into their
programs, or whose headers are compiled in. Versions are those that dpkg has installed on this computer.
"""

import hashlib
import json
import os
import re
import subprocess
import sys
import uuid
from datetime import datetime, timezone
from pathlib import Path

USES = ("depends", "static", "headers")


def output_of(*command, status=(0,)):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in status:
        sys.exit(f"error: {command[0]}: {done.stderr.strip()}")
    return done.stdout


def field(package, name):
    return output_of("dpkg-deb", "--field", package, name).strip()


def dependencies(package):
    """Names of the packages that a .deb depends on, the first of alternatives."""
    wanted = ", ".join(filter(None, (field(package, "Pre-Depends"), field(package, "Depends"))))
    names = [re.match(r"[a-z0-9][a-z0-9+.-]*", each.strip()) for each in wanted.split(",")]
    return {name.group() for name in names if name}


def owners_of(files):
    """Names of the Debian packages that have these files."""
    # Where /lib is a link to /usr/lib, dpkg knows a file by either name.
    known = {name for each in files for name in (each, each.removeprefix("/usr"))}
    found = output_of("dpkg-query", "--search", *sorted(known), status=(0, 1)) if known else ""
    lines = [line for line in found.splitlines() if not line.startswith("diversion ")]
    return {re.split(r"[:,]", line)[0] for line in lines}


def compiled_in(build):
    """Debian packages of the static libraries that are linked in, and of the headers."""
    programs = ["vantage-rig", "vantage", "vantage-calib"]
    words = output_of("ninja", "-C", build, "-t", "commands", *programs).split()
    archives = {os.path.realpath(each) for each in words if each.startswith("/usr/") and each.endswith(".a")}
    objects = {each for each in words if each.endswith((".o", ".gch"))}
    headers, is_ours = set(), False
    for line in output_of("ninja", "-C", build, "-t", "deps").splitlines():
        if line and not line.startswith(" "):
            is_ours = line.split(":")[0] in objects
        elif is_ours and line.strip().startswith("/usr/"):
            headers.add(os.path.normpath(line.strip()))
    return owners_of(archives), owners_of(headers)


def installed(names):
    """Version, architecture and source of installed packages by name."""
    form = "${Package}\\t${Version}\\t${Architecture}\\t${source:Package}\\t${source:Version}\\t${db:Status-Status}\\n"
    lines = output_of("dpkg-query", "--show", "--showformat", form, *sorted(names), status=(0, 1)).splitlines()
    rows = [line.split("\t") for line in lines]
    return {name: more for name, *more, status in rows if status == "installed"}


def release():
    with open("/etc/os-release", encoding="utf8") as file:
        facts = dict(line.rstrip().split("=", 1) for line in file if "=" in line)
    return f"{facts['ID'].strip(chr(34))}-{facts.get('VERSION_ID', '').strip(chr(34))}"


def library(name, uses, facts, distribution):
    purl = f"pkg:deb/debian/{name}"
    component = {"type": "library", "bom-ref": purl, "name": name}
    properties = [{"name": "vantage:use", "value": use} for use in USES if name in uses[use]]
    if name in facts:
        version, architecture, source, source_version = facts[name]
        purl += f"@{version.replace('+', '%2B').replace(':', '%3A').replace('~', '%7E')}"
        component["version"] = version
        component["purl"] = f"{purl}?arch={architecture}&distro={distribution}"
        properties.append({"name": "debian:source", "value": f"{source} {source_version}"})
    return {**component, "properties": properties}


def bill(build, packages):
    static, headers = compiled_in(build)
    own = {field(package, "Package"): package for package in packages}
    needed = {name: dependencies(package) for name, package in own.items()}
    uses = {"depends": set().union(*needed.values()) - own.keys(), "static": static, "headers": headers}
    names = set().union(*uses.values())
    facts = installed(names)
    components, relations = [], []
    for name, package in sorted(own.items()):
        digest = hashlib.sha256(Path(package).read_bytes()).hexdigest()
        components.append(
            {
                "type": "application",
                "bom-ref": name,
                "name": name,
                "version": field(package, "Version"),
                "description": field(package, "Description").splitlines()[0],
                "hashes": [{"alg": "SHA-256", "content": digest}],
            }
        )
        # What is compiled in is listed for all packages together.
        more = set() if field(package, "Architecture") == "all" else static | headers
        refs = [each if each in own else f"pkg:deb/debian/{each}" for each in sorted(needed[name] | more)]
        relations.append({"ref": name, "dependsOn": refs})
    main = components[[each["name"] for each in components].index("vantage")] if "vantage" in own else components[0]
    components += [library(name, uses, facts, release()) for name in sorted(names)]
    contents = json.dumps([components, relations], sort_keys=True)
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH") or os.stat(packages[0]).st_mtime)
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        # The same packages give the same number.
        "serialNumber": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, contents)}",
        "version": 1,
        "metadata": {
            "timestamp": datetime.fromtimestamp(epoch, timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
            "component": {"type": "application", "bom-ref": "release", "name": "vantage", "version": main["version"]},
        },
        "components": components,
        "dependencies": [{"ref": "release", "dependsOn": sorted(own)}, *relations],
    }


def main():
    arguments = sys.argv[1:]
    if len(arguments) < 4 or arguments[-2] != "-o":
        sys.exit(__doc__)
    build, *packages, _, target = arguments
    text = json.dumps(bill(build, packages), indent=1) + "\n"
    partial = Path(target + ".part")
    partial.write_text(text, encoding="utf8")
    partial.rename(target)


if __name__ == "__main__":
    main()
