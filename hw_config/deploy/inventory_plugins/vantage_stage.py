"""Rigs of a stage.toml as Ansible's inventory: -i stage.toml.

Every rig is a host of the group `rigs` by its name, reached at the host of its endpoint. group_vars/ and host_vars/
beside the stage file are read as beside any inventory.
"""
import os
import tomllib
from urllib.parse import urlsplit

from ansible.errors import AnsibleParserError
from ansible.plugins.inventory import BaseInventoryPlugin

DOCUMENTATION = """
name: vantage_stage
plugin_type: inventory
short_description: The rigs of a stage.toml
description: Reads rigs, their addresses, keys and the stage's rate from a stage.toml of Vantage.
options: {}
"""


class InventoryModule(BaseInventoryPlugin):
    NAME = "vantage_stage"

    def verify_file(self, path):
        return super().verify_file(path) and path.endswith(".toml")

    def parse(self, inventory, loader, path, cache=True):
        super().parse(inventory, loader, path, cache)
        try:
            with open(path, "rb") as file:
                stage = tomllib.load(file)
        except tomllib.TOMLDecodeError as error:
            raise AnsibleParserError(f"{path}: {error}") from error
        rigs = stage.get("rigs", [])
        if not rigs:
            raise AnsibleParserError(f"{path} has no [[rigs]], so there is no rig to deploy to")

        inventory.add_group("rigs")
        inventory.set_variable("rigs", "vantage_rate_hz", float(stage.get("rate_hz", 30.0)))
        folder = os.path.dirname(os.path.abspath(path))
        inventory.set_variable("rigs", "vantage_stage_folder", folder)
        if "key_file" in stage:
            inventory.set_variable("rigs", "vantage_host_key_file", os.path.join(folder, stage["key_file"]))
        names = [rig.get("name") for rig in rigs]
        for number, name in enumerate(names, 1):
            if not name:
                raise AnsibleParserError(f"{path}: rig {number} has no name")
            if name in names[number:]:
                raise AnsibleParserError(f"{path}: two rigs are named '{name}'; give each its own name")
        for rig in rigs:
            self._add(inventory, path, folder, rig)

    def _add(self, inventory, path, folder, rig):
        name = rig["name"]
        try:
            endpoint = urlsplit(rig.get("endpoint", ""))
            host, port = endpoint.hostname, endpoint.port
        except ValueError:
            host, port = None, None
        if endpoint.scheme != "tcp" or not host or not port:
            raise AnsibleParserError(f"{path}: the endpoint of '{name}' must be tcp://HOST:PORT")
        inventory.add_host(name, group="rigs")
        inventory.set_variable(name, "ansible_host", host)
        inventory.set_variable(name, "vantage_port", port)
        if "public_key_file" in rig:
            inventory.set_variable(name, "vantage_public_key_file", os.path.join(folder, rig["public_key_file"]))
